// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/contact_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fem/solid/archive.h"
#include "fem/solid/checkpoint.h"
#include "problem/error.h"
#include "problem/error_estimate.h"

namespace ciliaval::fem::solid {
using namespace contact;
using namespace discretisation;
namespace {

using Clock = std::chrono::steady_clock;

constexpr double remarkable_penetration = 0.01;  ///< between nodes, in d
constexpr unsigned int most_iterations = 10;     ///< of Newton's method: more is a step to be cut

/// Name of a checkpoint's entry with the levels' states.
constexpr const char* sweep_state_name = "sweep";

/// 3EI/L³ of a slender cilium of the softest segment.
double tip_stiffness(const Cilium& cilium) {
  double softest = cilium.segments.front().young_modulus;
  for (const Segment& segment : cilium.segments) softest = std::min(softest, segment.young_modulus);
  return 3 * softest * cilium.second_moment() / std::pow(cilium.length(), 3);
}

FollowerOptions follower_options(const Level& level) {
  const Cilium& cilium = level.cilium();
  equilibrium::NewtonOptions newton = level.options().path.newton;
  newton.max_iterations = std::min(newton.max_iterations, most_iterations);
  return {newton, cilium.segments.back().young_modulus, cilium.diameter, cilium.length(),
          tip_stiffness(cilium)};
}

/// The loads but for the place or the force.
void require_one_pin(const LoadPath& path) {
  for (const Load& load : path)
    if (with_magnitude(load, 0) != with_magnitude(path.front(), 0))
      throw InputError("the solid takes a path with one touch: one height, azimuth and law");
}

SweepPlace place_of(const Load& load) {
  const SweepLoad sweep = load.as<SweepLoad>().value();
  return {sweep.interference, sweep.travel, 0};
}

SurfaceContact contact_of(const Follower& follower, const FollowerOutcome& outcome,
                          double mesh_azimuth) {
  const ContactState& state = follower.current();
  SurfaceContact contact;
  contact.where = SurfaceContact::Where::surface;
  contact.elastic_energy = state.energy;
  contact.surface_work = outcome.surface_work;
  contact.friction_work = outcome.friction_work;
  contact.energy_lost = outcome.energy_lost;
  double largest = 0;
  for (const NodeForce& force : state.forces) largest = std::max(largest, force.normal);
  if (largest == 0) return contact;
  contact.state = SurfaceContact::State::slip;
  for (std::size_t i = 0; i < state.forces.size(); ++i) {
    const NodeForce& force = state.forces[i];
    contact.normal_force += follower.copies() * force.normal;
    contact.friction_force += follower.copies() * force.friction[0];
    contact.point +=
        follower.copies() * force.normal * follower.nodes()[i].position(state.solid.displacement);
    if (force.normal > 1e-3 * largest && !force.slides)
      contact.state = SurfaceContact::State::stick;
  }
  contact.point /= contact.normal_force;
  if (follower.copies() == 2) contact.point.y() = 0;
  contact.point =
      Eigen::AngleAxisd(mesh_azimuth, Vector3::UnitZ()).toRotationMatrix() * contact.point;
  return contact;
}

/// Remark on a state: folds of the mantle, and penetration between the nodes.
std::string remark(double penetration, const Cilium& cilium,
                   const std::optional<std::string>& fold) {
  std::string text = fold.value_or("");
  if (penetration > remarkable_penetration * cilium.diameter)
    text += fmt::format(
        "{}between its nodes the solid's surface penetrates the surface by up to {:.3g} mm: the "
        "mesh "
        "is coarse beside the surface's edges",
        text.empty() ? "" : "; ", penetration * 1e3);
  return text;
}

}  // namespace

ContactRun::ContactRun(Levels levels, const LoadPath& path, const SolidOptions& options,
                       const Checkpoint& checkpoint, const Progress& progress,
                       MPI_Comm communicator)
    : levels_(std::move(levels)),
      path_(path),
      checkpoint_(checkpoint),
      progress_(progress),
      communicator_(communicator),
      turn_(options.mesh.empty() ? azimuth(path.front()) : 0),
      in_mesh_(with_azimuth(path.front(), azimuth(path.front()) - turn_)),
      result_{} {
  if (path.front().is<SweepLoad>())
    require_one_surface(path);
  else
    require_one_pin(path);
  std::map<std::size_t, std::size_t> way_of;  // by level
  const auto way = [&](std::size_t index) {
    const auto [found, is_new] = way_of.try_emplace(index, ways_.size());
    if (is_new) add_way(index);
    return found->second;
  };
  way(levels_.finest);
  for (const std::size_t level : levels_.companions) companions_.push_back(way(level));
  result_.undeformed = ways_.front().level->undeformed(turn_);
  for (const std::size_t companion : companions_)
    result_.companions.push_back({ways_[companion].level->undeformed(turn_), {}});
  result_.error_parts = levels_.error_parts;
  result_.algebraic_error = options.newton_tolerance;
}

void ContactRun::add_way(std::size_t index) {
  Level& level = *levels_.all[index];
  RigidSurface surface;
  if (in_mesh_.is<SweepLoad>()) {
    const surroundings::Surface& profile = *path_.front().surface();
    surface = {.profile = &profile,
               .friction = profile.friction,
               .direction = direction(in_mesh_),
               .height = level.cilium().length()};
  } else {
    surface = untouched_pin(level.space(), in_mesh_);
  }
  ways_.push_back(
      {&level, std::make_unique<Follower>(level.space(), level.quadrature(), level.newton(),
                                          surface, follower_options(level))});
}

MechanicsResult ContactRun::follow() {
  go_on_from_checkpoint();
  bool failed = false;
  while (result_.steps.size() < path_.size()) {
    solve(result_.steps.size());
    failed = failed || result_.steps.back().status == Status::failed;
    if (!failed) save();
  }
  estimate_errors(result_);
  return std::move(result_);
}

void ContactRun::solve(std::size_t i) {
  const auto began = Clock::now();
  const std::string label =
      "step " + std::to_string(i + 1) + "/" + std::to_string(path_.size()) + ", ";
  const Progress shown = with_prefix(progress_, label);
  const Progress of_companions = with_prefix(shown, "error estimate, ");
  std::vector<MechanicsStep> steps(ways_.size());
  for (std::size_t w = 0; w < ways_.size(); ++w) {
    Way& way = ways_[w];
    const auto solve_level = [&] { steps[w] = go(way, i, w == 0 ? shown : of_companions); };
    if (w == 0) {
      solve_level();
      continue;
    }
    if (way.failure.empty()) {
      way.failure = failure_of(solve_level);
      if (way.failure.empty() && steps[w].status == Status::failed) way.failure = steps[w].message;
      if (!way.failure.empty())
        way.failure = fmt::format("{}on the mesh of {} unknowns: {}", label, way.level->unknowns(),
                                  way.failure);
    }
    if (way.failure.empty()) continue;
    steps[w] = {};
    steps[w].load = path_[i];
    steps[w].message = way.failure;
  }
  for (std::size_t c = 0; c < companions_.size(); ++c)
    result_.companions[c].steps.push_back(steps[companions_[c]]);
  MechanicsStep& step = steps.front();
  const Way& finest = ways_.front();
  if (step.status == Status::failed) {
    step.message = label + step.message;
  } else if (step.status == Status::slipped_off) {
    const auto own = slip_off_limit(step);
    const auto other = companions_.empty() ? std::nullopt : slip_off_limit(steps[companions_[0]]);
    if (step.slip_off_uncertainty && own && other)
      *step.slip_off_uncertainty += std::abs(*own - *other);
    else
      step.slip_off_uncertainty.reset();
  } else {
    const auto fold =
        fold_remark(finest.level->mantle_compression(finest.follower->current().solid));
    step.message = remark(finest.follower->penetration(), finest.level->cilium(), fold);
    // Without companions there is no estimate.
    if (fold)
      for (MechanicsResult& companion : result_.companions) {
        companion.steps.back().status = Status::failed;
        companion.steps.back().deformation.reset();
      }
  }
  step.seconds = std::chrono::duration<double>(Clock::now() - began).count();
  result_.steps.push_back(std::move(step));
  report_step(progress_, result_.steps, path_.size());
}

MechanicsStep ContactRun::go(const Way& way, std::size_t i, const Progress& progress) const {
  const bool is_first = i == 0 || result_.steps.back().status == Status::slipped_off;
  if (!path_[i].is<SweepLoad>()) {
    if (is_first) way.follower->start(before_touch(way.level->cilium().diameter));
    const double length = way.level->cilium().length();
    return step_of(way, i, move_pin(*way.follower, path_[i], length, progress));
  }
  if (is_first) way.follower->start(place_of(path_[0]));
  return step_of(way, i, way.follower->go(place_of(path_[i]), progress));
}

MechanicsStep ContactRun::step_of(const Way& way, std::size_t i, const PinOutcome& outcome) const {
  MechanicsStep step;
  step.load = path_[i];
  step.unknowns = way.level->unknowns();
  step.iterations = outcome.iterations;
  step.message = outcome.message;
  step.status = outcome.status;
  if (step.status == Status::slipped_off) {
    const bool is_probe = step.load.is<ProbeLoad>();
    step.slip_off_force = outcome.largest_force;
    if (is_probe) step.slip_off_displacement = outcome.largest_displacement;
    step.slip_off_uncertainty =
        is_probe ? outcome.bracket
                 : outcome.bracket / outcome.largest_displacement * outcome.largest_force;
  }
  if (step.status != Status::converged) return step;
  const PinContact contact = pin_contact(*way.follower);
  step.touch = contact.probe;
  step.applied_force = contact.force;
  step.contact_arclength = contact.arclength;
  step.deformation = way.level->deformation(way.follower->current().solid, turn_);
  return step;
}

MechanicsStep ContactRun::step_of(const Way& way, std::size_t i,
                                  const FollowerOutcome& outcome) const {
  MechanicsStep step;
  step.load = path_[i];
  step.unknowns = way.level->unknowns();
  step.iterations = outcome.iterations;
  step.message = outcome.trouble;
  if (!outcome.converged) return step;
  step.status = Status::converged;
  step.contact = contact_of(*way.follower, outcome, turn_);
  step.deformation = way.level->deformation(way.follower->current().solid, turn_);
  step.applied_force = way.follower->current().force.dot(direction(in_mesh_));
  return step;
}

void ContactRun::go_on_from_checkpoint() {
  const Checkpoint::Entries kept = kept_entries(checkpoint_, sweep_state_name, communicator_);
  if (kept.empty()) return;
  const auto restore = [this](const Way& way, MechanicsResult& result, MechanicsStep step,
                              const std::optional<SolidState>& state) {
    step.load = path_.at(result.steps.size());  // with its surface
    if (state) step.deformation = way.level->deformation(*state, turn_);
    result.steps.push_back(std::move(step));
  };
  for (std::size_t i = 1; kept.contains(std::to_string(i)); ++i) {
    std::vector<MechanicsStep> steps;
    std::vector<std::optional<SolidState>> states;
    support::deserialize(kept.at(std::to_string(i)), steps, states);
    restore(ways_.front(), result_, std::move(steps.at(0)), states.at(0));
    for (std::size_t c = 0; c < companions_.size(); ++c)
      restore(ways_[companions_[c]], result_.companions[c], std::move(steps.at(c + 1)),
              states.at(c + 1));
  }
  std::vector<std::pair<FollowerState, std::string>> states;
  support::deserialize(kept.at(sweep_state_name), states);
  for (std::size_t w = 0; w < ways_.size(); ++w) {
    auto& [state, failure] = states.at(w);
    ways_[w].level->require_own(state.now.solid);
    if (state.before) ways_[w].level->require_own(state.before->solid);
    ways_[w].follower->restore(std::move(state));
    ways_[w].failure = std::move(failure);
  }
}

void ContactRun::save() const {
  save_entries(checkpoint_, communicator_, [this] {
    std::vector<MechanicsStep> steps;
    std::vector<std::optional<SolidState>> states;
    const auto add = [&](const MechanicsStep& step, const Way& way) {
      steps.push_back(step);
      states.push_back(step.deformation ? std::optional(way.follower->current().solid)
                                        : std::nullopt);
    };
    add(result_.steps.back(), ways_.front());
    for (std::size_t c = 0; c < companions_.size(); ++c)
      add(result_.companions[c].steps.back(), ways_[companions_[c]]);
    std::vector<std::pair<FollowerState, std::string>> ways;
    for (const Way& way : ways_) ways.emplace_back(way.follower->state(), way.failure);
    return Checkpoint::Entries{
        {sweep_state_name, support::serialized(ways)},
        {std::to_string(result_.steps.size()), support::serialized(steps, states)}};
  });
}

}  // namespace ciliaval::fem::solid
