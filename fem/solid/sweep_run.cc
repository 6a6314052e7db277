// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/sweep_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "fem/beam/beam.h"
#include "fem/solid/contact/follower.h"
#include "fem/solid/path_run.h"
#include "problem/error.h"

namespace ciliaval::fem::solid {
using namespace contact;
namespace {

using Clock = std::chrono::steady_clock;

constexpr double bent_height = 0.6;   ///< of the tip that is bent aside, in L
constexpr double force_ratio = 1.25;  ///< of the holding forces, from one to the next
constexpr double first_force = 0.01;  ///< in the tip's stiffness times L
constexpr int most_forces = 80;
constexpr double remarkable_penetration = 0.01;  ///< between nodes, in d
constexpr unsigned int most_iterations = 10;     ///< of Newton's method: more is a step to be cut

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

SweepPlace place_of(const Load& load) {
  const SweepLoad sweep = load.as<SweepLoad>().value();
  return {sweep.interference, sweep.travel, 0};
}

/// A state in which a horizontal force holds the tip.
struct Held {
  double force;  ///< N
  discretisation::SolidState state;
};

/// The beam's states, bent further and further aside, as states of the level.
std::vector<Held> bent_aside(const Level& level, double azimuth) {
  const Cilium& cilium = level.cilium();
  const beam::Beam beam({.degree = 4, .tolerance = 1e-6, .error_estimate = false});
  double force = first_force * tip_stiffness(cilium) * cilium.length();
  std::vector<Held> states;
  for (int i = 0; i < most_forces; ++i, force *= force_ratio) {
    const MechanicsResult solved =
        beam.solve(cilium, {SectionLoad{force, cilium.length(), azimuth}});
    const auto& deformation = solved.steps.front().deformation;
    if (!deformation) break;
    states.push_back({force, level.from_rod(deformation->centreline)});
    if (deformation->centreline.at(cilium.length()).position.z() < bent_height * cilium.length())
      break;
  }
  return states;
}

/// Brings the cilium back from far ahead to where the surface holds it.
FollowerOutcome press(const Level& level, Follower& follower, SweepPlace place, double azimuth,
                      const Progress& progress) {
  std::vector<Held> states = bent_aside(level, azimuth);
  const auto is_free = [&](const Held& held) {
    return smallest_gap(follower.nodes(), follower.surface_at(place), held.state.displacement) > 0;
  };
  // The last one that is met on the way back, and the free one before it.
  std::size_t first_free = states.size();
  while (first_free > 0 && is_free(states[first_free - 1])) --first_free;
  if (first_free == 0) {
    follower.start_open(place);
    if (smallest_gap(follower.nodes(), follower.surface_at(place),
                     follower.current().solid.displacement) >= 0) {
      FollowerOutcome open;
      open.converged = true;
      return open;
    }
  }
  for (std::size_t i = first_free; i < states.size(); ++i) {
    place.hold = states[i].force;
    if (!follower.start_held(place, std::move(states[i].state))) continue;
    place.hold = 0;
    return follower.go(place, progress);
  }
  if (first_free == states.size())
    throw InputError(
        "the surface is pressed on too far: a cilium bent to 0.6 of its length must have room "
        "under it");
  throw SolverError(
      "the body that a force holds aside under the surface was not found: from the beam's shape "
      "Newton's method does not converge on this mesh; a lower refinement may");
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

/// What is to be said of a state: folds of the mantle, and what lies between the nodes.
std::string remark(const Level& level, const Follower& follower) {
  std::string text = fold_remark(level.mantle_compression(follower.current().solid)).value_or("");
  const double depth = follower.penetration();
  if (depth > remarkable_penetration * level.cilium().diameter)
    text += fmt::format(
        "{}between its nodes the solid's surface penetrates the surface by up to {:.3g} mm: the "
        "mesh "
        "is coarse beside the surface's edges",
        text.empty() ? "" : "; ", depth * 1e3);
  return text;
}

}  // namespace

MechanicsResult follow_sweep(std::unique_ptr<Level> level, const LoadPath& path,
                             const SolidOptions& options, const Progress& progress) {
  require_one_surface(path);
  const double turn = options.mesh.empty() ? azimuth(path.front()) : 0;
  const Load in_mesh = with_azimuth(path.front(), azimuth(path.front()) - turn);
  Follower follower(level->space(), level->quadrature(), level->newton(), *path.front().surface(),
                    direction(in_mesh), follower_options(*level));
  MechanicsResult result;
  result.undeformed = level->undeformed(turn);
  result.algebraic_error = options.newton_tolerance;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const auto start = Clock::now();
    const std::string label =
        "step " + std::to_string(i + 1) + "/" + std::to_string(path.size()) + ", ";
    const Progress shown = with_prefix(progress, label);
    const FollowerOutcome outcome =
        i == 0 ? press(*level, follower, place_of(path[0]), azimuth(in_mesh), shown)
               : follower.go(place_of(path[i]), shown);
    MechanicsStep step;
    step.load = path[i];
    step.unknowns = level->unknowns();
    step.iterations = outcome.iterations;
    if (outcome.converged) {
      step.status = Status::converged;
      step.message = remark(*level, follower);
      step.contact = contact_of(follower, outcome, turn);
      step.deformation = level->deformation(follower.current().solid, turn);
      step.applied_force = follower.current().force.dot(follower.surface_at({}).direction);
    } else {
      step.message = label + outcome.trouble;
    }
    step.seconds = std::chrono::duration<double>(Clock::now() - start).count();
    result.steps.push_back(std::move(step));
    if (progress) progress(label + std::to_string(outcome.iterations) + " iterations");
  }
  return result;
}

}  // namespace ciliaval::fem::solid
