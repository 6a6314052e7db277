// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/beam/contact.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <sstream>
#include <utility>
#include <vector>

#include "fem/beam/centreline.h"
#include "fem/beam/stability/pull_in.h"

namespace ciliaval::fem::beam {
namespace {

/// A contact this near to the end of a segment (relative to L) is at the end.
constexpr double at_end = 1e-12;

/// Tolerance of the increment where the force at the end of a segment is found. The error is its
/// square; the rounding of z − h moves a small force by much more than the usual tolerance.
constexpr double force_tolerance = 1e-8;

/// Iterations without any progress after which a load is given up.
constexpr int patience = 150;

/// Iterations after which the search for the force that sinks the tip is given up.
constexpr int search_limit = 250;

/// a + w (b − a); the rotations along the chord, which is the arc to second order in their angle.
State blend(const State& a, const State& b, double w) {
  State result = a;
  for (std::size_t j = 0; j < a.position.size(); ++j) {
    result.position[j] += w * (b.position[j] - a.position[j]);
    const double sign = a.rotation[j].dot(b.rotation[j]) < 0 ? -1 : 1;
    result.rotation[j].coeffs() += w * (sign * b.rotation[j].coeffs() - a.rotation[j].coeffs());
    result.rotation[j].normalize();
  }
  for (std::size_t k = 0; k < a.force.size(); ++k) {
    result.force[k] += w * (b.force[k] - a.force[k]);
    result.moment[k] += w * (b.moment[k] - a.moment[k]);
  }
  result.shift = std::lerp(a.shift, b.shift, w);
  return result;
}

/// The contact slides by an amount that goes with the square of a small force or displacement.
double magnitude_at(double shift, double a, double shift_a, double b, double shift_b) {
  const double w = (shift - shift_a) / (shift_b - shift_a);
  return std::sqrt(std::lerp(a * a, b * b, w));
}

std::string slipped_off(const Load& load, double force, double displacement) {
  std::ostringstream text;
  text << "the tip sinks to the contact height of " << contact_height(load).value() << " m ";
  if (load.is<ProbeLoad>())
    text << "at a displacement of " << displacement << " m under " << force
         << " N; no equilibrium has one of ";
  else
    text << "under " << force << " N; no equilibrium bears ";
  text << magnitude(load) << ' ' << magnitude_unit(load);
  return text.str();
}

/// A dead force on the tip, besides the environment of the load.
class TipForce {
 public:
  TipForce(const Cilium& cilium, const Load& load, const CiliumBeam& beam)
      : vertex_(beam.loaded),
        direction_(direction(load)),
        environment_(environment_loads(cilium, load, beam)) {}
  Loads operator()(double force) const {
    Loads loads = environment_;
    loads.points.push_back({vertex_, force * direction_, Vector3::Zero()});
    return loads;
  }
  const Vector3& direction_of_force() const { return direction_; }

 private:
  std::size_t vertex_;
  Vector3 direction_;
  Loads environment_;
};

/// A dead force at the tip and the equilibrium under it.
struct TipLoaded {
  double force = 0;
  State state;
};

std::optional<TipLoaded> tip_loaded(CiliumBeam& beam, const TipForce& tip_force,
                                    const TipLoaded& from, double force,
                                    const NewtonOptions& options, int& iterations) {
  TipLoaded to{force, from.state};
  const PathReport report =
      advance(beam.system, to.state, tip_force(from.force), tip_force(force), options);
  iterations += report.iterations;
  return report.converged ? std::optional(std::move(to)) : std::nullopt;
}

/// The dead force at the tip that brings it down to a height: bracketed and bisected until Newton's
/// method with the force for the unknown converges inside the bracket. Slow, but safe where θ comes
/// near 90° and the contact point runs away. None if a dead force does not converge.
struct SunkTip {
  double force = 0;       ///< N
  double deflection = 0;  ///< m
};
std::optional<SunkTip> force_that_sinks_the_tip(const Cilium& cilium, const BeamOptions& options,
                                                const joints::Corrections& corrections,
                                                const Load& load, int& iterations) {
  const double height = contact_height(load).value();
  CiliumBeam beam = cilium_beam(cilium, options, cilium.length(), corrections);
  const NewtonOptions newton_options{
      options.tolerance, options.max_iterations, options.max_cutbacks, {}, largest_turn(load)};
  const int last = iterations + search_limit;
  const std::size_t node = beam.system.vertex_node(beam.loaded);
  const auto above = [&](const TipLoaded& l) { return l.state.position[node][2] > height; };
  const TipForce tip_force(cilium, load, beam);
  TipLoaded low{0, beam.system.reference_state()};
  const PathReport hanging = advance(beam.system, low.state, {}, tip_force(0), newton_options);
  iterations += hanging.iterations;
  if (!hanging.converged) return std::nullopt;
  std::optional<TipLoaded> high =
      tip_loaded(beam, tip_force, low, beam.system.force_scale(), newton_options, iterations);
  // The height falls as sqrt(2EI/F) at worst: four times the force for half the height.
  while (high && above(*high)) {
    if (iterations > last) return std::nullopt;
    low = *std::move(high);
    high = tip_loaded(beam, tip_force, low, 2 * low.force, newton_options, iterations);
  }
  const std::array condition{at_height(beam.loaded, height, Condition::Unknown::load_factor)};
  while (high && iterations <= last) {
    State state = high->state;
    const NewtonReport report =
        newton(beam.system, state, tip_force(high->force), newton_options, condition);
    iterations += static_cast<int>(report.increments.size());
    const double force = state.load_factor * high->force;
    // At the bracket's upper end itself, rounding error may put the force just outside.
    if (report.converged && force >= low.force && force <= high->force * (1 + 1e-9))
      return SunkTip{force, state.position[node].dot(tip_force.direction_of_force())};
    std::optional<TipLoaded> middle =
        tip_loaded(beam, tip_force, low, (low.force + high->force) / 2, newton_options, iterations);
    if (!middle) return std::nullopt;
    (above(*middle) ? low : *high) = *std::move(middle);
  }
  return std::nullopt;
}

/// The force for the deflection δ at h of a uniform cilium of the softest material, 3 EI δ/h³.
double estimated_force(const System& system, double displacement, double height) {
  const double slenderness = system.length_scale() / height;
  return 3 * system.force_scale() * displacement / height * slenderness * slenderness;
}

}  // namespace

Loads ContactSolver::force_at_vertex(double force) const {
  return TipForce(cilium_, *last_, *beam_)(force);
}

double ContactSolver::displacement_of(const State& state) const {
  return direction(*last_).dot(state.position[beam_->system.vertex_node(beam_->loaded)]);
}

double ContactSolver::magnitude_of(const Loaded& trial) const {
  return last_->is<ProbeLoad>() ? displacement_of(trial.state) : trial.force;
}

std::optional<double> ContactSolver::untouched_arclength(const Load& load,
                                                         MechanicsStep& step) const {
  const double height = contact_height(load).value();
  CiliumBeam beam = cilium_beam(cilium_, options_, {}, corrections_);
  State state = beam.system.reference_state();
  const Loads loads = environment_loads(cilium_, load, beam);
  const NewtonOptions newton{
      options_.tolerance, options_.max_iterations, options_.max_cutbacks, {}, largest_turn(load)};
  const PathReport report = advance(beam.system, state, {}, loads, newton);
  step.iterations += report.iterations;
  if (!report.converged) {
    step.message = report.message;
    // The environment alone may pull it in.
    stability::judge_pull_in(cilium_, beam, {beam.system.reference_state(), {}, loads}, newton,
                             state, step);
    return std::nullopt;
  }
  const Centreline line = centreline(beam.system, state);
  double low = 0;
  double high = line.length();
  if (line.at(high).position.z() < height) {
    step.message = "the environment alone bends the cilium below the contact height";
    return std::nullopt;
  }
  while (true) {
    const double middle = std::midpoint(low, high);
    if (!(middle > low && middle < high)) return middle;
    (line.at(middle).position.z() < height ? low : high) = middle;
  }
}

bool ContactSolver::stand_untouched(const Load& load, MechanicsStep& step) {
  std::optional<double> arclength = contact_height(load);
  const bool is_bent = !surroundings::is_empty(acting_environment(load));
  if (is_bent) arclength = untouched_arclength(load, step);
  if (!arclength) return false;
  const std::vector<double> ends = cilium_.interfaces();
  const std::size_t last = cilium_.segments.size() - 1;
  for (host_ = 0; host_ < last && ends[host_ + 1] <= *arclength + at_end * ends.back();) ++host_;
  beam_ = cilium_beam_with_moving_vertex(cilium_, options_, host_, corrections_);
  current_ = {beam_->system.reference_state(std::max(*arclength - ends[host_], 0.0)), 0};
  last_ = with_magnitude(load, 0);
  if (!is_bent) return true;
  const PathReport report = advance(
      beam_->system, current_.state, {}, environment_loads(cilium_, load, *beam_),
      {options_.tolerance, options_.max_iterations, options_.max_cutbacks, {}, largest_turn(load)});
  step.iterations += report.iterations;
  step.message = report.message;
  if (load.is<ProbeLoad>()) last_ = with_magnitude(load, displacement_of(current_.state));
  return report.converged;
}

bool ContactSolver::find_arclength(Loaded& trial, double magnitude, MechanicsStep& step,
                                   const PathProgress& progress) {
  const double height = contact_height(*last_).value();
  std::vector<Condition> conditions{at_height(beam_->loaded, height, Condition::Unknown::shift)};
  double unit = magnitude;  // the force is load_factor · unit
  if (last_->is<ProbeLoad>()) {
    conditions.push_back(
        at_place(beam_->loaded, direction(*last_), magnitude, Condition::Unknown::load_factor));
    const double displacement = std::max(std::abs(magnitude), 1e-3 * height);
    unit = trial.force != 0 ? trial.force : estimated_force(beam_->system, displacement, height);
    trial.state.load_factor = trial.force / unit;
  }
  const NewtonReport report =
      newton(beam_->system, trial.state, force_at_vertex(unit),
             {options_.tolerance, options_.max_iterations, 0, {}}, conditions);
  step.iterations += static_cast<int>(report.increments.size());
  if (!report.converged) step.message = describe(report);
  if (progress) progress(magnitude, report);
  trial.force = unit * std::exchange(trial.state.load_factor, 1);
  // A large step may end where the contact lies below its segment, which is no state of the beam.
  const bool below = trial.state.shift < -at_end * cilium_.length();
  if (report.converged && below) step.message = "the contact went below its segment";
  return report.converged && !below;
}

bool ContactSolver::find_force(Loaded& trial, MechanicsStep& step) {
  const std::array condition{
      at_height(beam_->loaded, contact_height(*last_).value(), Condition::Unknown::load_factor)};
  trial.state.load_factor = 1;
  const NewtonReport report = newton(beam_->system, trial.state, force_at_vertex(trial.force),
                                     {options_.tolerance, options_.max_iterations, 0,
                                      std::max(options_.tolerance, force_tolerance)},
                                     condition);
  step.iterations += static_cast<int>(report.increments.size());
  if (!report.converged) step.message = describe(report);
  trial.force *= std::exchange(trial.state.load_factor, 1);
  return report.converged;
}

double ContactSolver::first_increment() const {
  const double height = contact_height(*last_).value();
  if (last_->is<ProbeLoad>()) return height / 2;
  // Twice the slip-off force of a uniform cilium of the softest material, sin θ = F h²/(2EI).
  return 4 * beam_->system.force_scale() * std::pow(cilium_.length() / height, 2);
}

bool ContactSolver::go_to_end(Loaded crossing, double from, double aim, MechanicsStep& step) {
  crossing.state.shift = host_length();
  if (!(crossing.force > 0) || !find_force(crossing, step)) return false;
  const double reached = magnitude_of(crossing);
  if (!(reached >= from && reached <= aim * (1 + 1e-9))) return false;
  current_ = std::move(crossing);
  last_ = with_magnitude(*last_, reached);
  return true;
}

ContactSolver::Leg ContactSolver::follow(const Load& load, MechanicsStep& step,
                                         const PathProgress& progress) {
  const double L = cilium_.length();
  const double end = host_length();
  const double target = magnitude(load);
  double increment = std::max(first_increment(), magnitude(*last_));
  unsigned int failures = 0;
  int progressed = step.iterations;
  for (int increments = 0; magnitude(*last_) != target; ++increments) {
    if (increments == most_increments) {
      step.message = too_many_increments(options_.max_iterations);
      return Leg::failed;
    }
    const double from = magnitude(*last_);
    const double aim = std::abs(target - from) <= increment
                           ? target
                           : from + std::copysign(increment, target - from);
    Loaded trial = current_;
    const bool found = find_arclength(trial, aim, step, progress);
    if (found && trial.state.shift <= end + at_end * L) {
      current_ = std::move(trial);
      last_ = with_magnitude(*last_, aim);
      increment = 2 * std::abs(aim - from);
      failures = failures > 0 ? failures - 1 : 0;
      progressed = step.iterations;
      continue;
    }
    if (found && end - current_.state.shift <= at_end * L) return Leg::end_reached;
    if (found) {
      // s_c lies beyond the segment as if its material went on: the end is between the two.
      const double at_crossing =
          magnitude_at(end, from, current_.state.shift, aim, trial.state.shift);
      const double w = (at_crossing - from) / (aim - from);
      Loaded crossing{blend(current_.state, trial.state, w),
                      std::lerp(current_.force, trial.force, w)};
      if (go_to_end(std::move(crossing), from, aim, step)) return Leg::end_reached;
    }
    if (++failures > options_.max_cutbacks || step.iterations - progressed >= patience)
      // Near 90 deg s_c runs away with the force; the force at a given s_c does not.
      return go_to_end(current_, from, aim, step) ? Leg::end_reached : Leg::failed;
    increment = std::abs(aim - from) / 2;
  }
  return Leg::load_reached;
}

bool ContactSolver::enter_next_segment(const Load& load, MechanicsStep& step) {
  // The elements of no length above the vertex become elements below it: same nodes, now loaded.
  const std::size_t p = options_.degree;
  const std::size_t contact = beam_->loaded * p;
  const std::size_t n = std::size_t{1} << options_.refinement;
  ++host_;
  beam_ = cilium_beam_with_moving_vertex(cilium_, options_, host_, corrections_);
  State& state = current_.state;
  const Vector3 force = state.rotation[contact].conjugate() * (current_.force * direction(*last_));
  const std::size_t loaded = corrections_.empty() ? n : n + 1;  // elements
  for (std::size_t k = contact; k < contact + loaded * p; ++k) {
    state.force[k] = force;
    state.moment[k].setZero();
  }
  state.shift = 0;
  if (!corrections_.empty()) {
    if (!find_force(current_, step)) return false;
    last_ = with_magnitude(*last_, magnitude_of(current_));
  }
  if (corrections_.empty() || magnitude(*last_) <= magnitude(load) * (1 + 1e-9)) return true;
  step.message = "the contact is at an interface of two segments, between the sides of its joint";
  return false;
}

MechanicsStep ContactSolver::solve(const Load& load, const PathProgress& progress) {
  MechanicsStep step;
  step.load = load;
  const bool probes = load.is<ProbeLoad>();
  const auto is_beyond = [&](const SlipOff& limit) {
    return magnitude(load) > (probes ? limit.displacement : limit.force);
  };
  const auto slip = [&](const SlipOff& limit) {
    step.status = Status::slipped_off;
    step.slip_off_force = limit.force;
    if (probes) step.slip_off_displacement = limit.displacement;
    step.message = slipped_off(load, limit.force, limit.displacement);
    return step;
  };
  if (!stand_untouched(load, step)) return step;
  Leg leg = follow(load, step, progress);
  while (leg == Leg::end_reached) {
    if (host_ + 1 == cilium_.segments.size())
      return slip({current_.force, displacement_of(current_.state)});
    leg = enter_next_segment(load, step) ? follow(load, step, progress) : Leg::failed;
  }
  if (leg == Leg::failed) {
    const auto sunk =
        force_that_sinks_the_tip(cilium_, options_, corrections_, load, step.iterations);
    if (sunk && is_beyond({sunk->force, sunk->deflection}))
      return slip({sunk->force, sunk->deflection});
    std::ostringstream text;
    text << "no equilibrium found under " << magnitude(load) << ' ' << magnitude_unit(load) << ": "
         << step.message << "; last converged under " << magnitude(*last_)
         << "; more cutbacks or elements may help";
    step.message = text.str();
    return step;
  }
  applied_ = force_at_vertex(current_.force);
  step.status = Status::converged;
  step.message.clear();
  const double begin = cilium_.interfaces()[host_];
  step.contact_arclength = std::min(begin + current_.state.shift, cilium_.length());
  return step;
}

}  // namespace ciliaval::fem::beam
