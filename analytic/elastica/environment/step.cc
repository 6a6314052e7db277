// SPDX-License-Identifier: LGPL-2.1-or-later
#include "analytic/elastica/environment/step.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>
#include <sstream>
#include <string>

#include "problem/cilium.h"
#include "problem/error.h"
#include "problem/surroundings/plane.h"

namespace ciliaval::analytic::elastica::environment {
namespace {

PlanarForce in_plane(const Vector3& force, const Vector3& e) {
  return {force.dot(e), force.z()};
}

/// Equilibrium of a cilium that the environment alone bends, with its point at the contact height.
Equilibrium untouched(const Rod& rod, double height, double tolerance) {
  const auto path = [&](double t) {
    return std::pair(scaled(rod, t), Conditions{.height = height, .force = 0});
  };
  try {
    return follow(path, {0, 0, height}, tolerance);
  } catch (const SolverError& error) {
    throw SolverError("the environment alone bends the cilium below the contact height: " +
                      std::string(error.what()));
  }
}

/// The equilibrium in which the tip has sunk to the contact height: under a force on the tip, which
/// grows until the tip is below, and then is bisected until Newton's method converges inside.
Equilibrium at_slip_off(const Rod& rod, double height, double tolerance) {
  constexpr int most_forces = 100;
  int attempts = most_attempts;
  const auto on_tip = [&](double from, double to, const Unknowns& start) {
    const auto path = [&](double t) {
      return std::pair(rod, Conditions{.at = 1, .force = std::lerp(from, to, t)});
    };
    Equilibrium result = follow(path, start, tolerance, attempts);
    attempts -= result.attempts;
    return result;
  };
  const auto hanging = [&](double t) {
    return std::pair(scaled(rod, t), Conditions{.at = 1, .force = 0});
  };
  Equilibrium above = follow(hanging, {}, tolerance);
  if (above.height < height)
    throw SolverError("the environment alone bends the cilium's tip below the contact height");
  std::optional<Equilibrium> below;
  double force = 0.5 / *std::ranges::max_element(rod.compliance);
  for (int k = 0; k < most_forces; ++k) {
    Equilibrium next = on_tip(above.unknowns.force, force, above.unknowns);
    if (next.height > height)
      above = std::move(next);
    else
      below = std::move(next);
    if (!below) {
      force *= 1.5;
      continue;
    }
    const double low = above.unknowns.force;
    const double high = below->unknowns.force;
    const double part = (above.height - height) / (above.height - below->height);
    const auto found = solve(rod, {.height = height, .at = 1},
                             interpolate(above.unknowns, below->unknowns, part), tolerance);
    // At the bracket's upper end itself, rounding error may put the force just outside.
    if (found && found->unknowns.force >= low && found->unknowns.force <= high * (1 + 1e-9))
      return *found;
    force = std::midpoint(low, high);
  }
  throw SolverError("elastica: no slip-off force found");
}

/// Contact and probe. None if the cilium has slipped off.
std::optional<Equilibrium> pushed(const Rod& rod, const PlanarUnits& units, double tolerance,
                                  MechanicsStep& step) {
  const double height = contact_height(step.load).value() / units.length;
  const Equilibrium start = untouched(rod, height, tolerance);
  const Equilibrium last = at_slip_off(rod, height, tolerance);
  step.slip_off_force = units.force * last.unknowns.force;
  const bool probes = step.load.is<ProbeLoad>();
  if (probes) step.slip_off_displacement = units.length * last.deflection;
  const double limit = slip_off_limit(step).value();
  step.slip_off_uncertainty = tolerance * std::abs(limit);
  if (magnitude(step.load) > limit) return std::nullopt;
  const auto path = [&](double t) {
    Conditions conditions{.height = height};
    const double target = magnitude(step.load);
    if (probes)
      conditions.deflection = std::lerp(start.deflection, target / units.length, t);
    else
      conditions.force = t * target / units.force;
    return std::pair(rod, conditions);
  };
  return follow(path, start.unknowns, tolerance);
}

/// Loads that stay on their sections, or none.
Equilibrium pulled(const Rod& rod, const PlanarUnits& units, double tolerance, const Load& load) {
  const auto section = load.as<SectionLoad>();
  const double force = section ? section->force / units.force : 0;
  const double at = section ? section->arclength / units.length : 1;
  const auto path = [&](double t) {
    return std::pair(scaled(rod, t), Conditions{.at = at, .force = t * force});
  };
  return follow(path, {0, 0, at}, tolerance);
}

/// Throws SolverError where a bend would take too little of the length.
void require_resolvable(const Rod& rod, double force) {
  constexpr double most_foldings = 1000;
  const double foldings = e_foldings(rod, force);
  if (foldings <= most_foldings) return;
  std::ostringstream text;
  text << "elastica: weight, field and load are so strong that the cilium bends within "
       << 1 / foldings << " of its length; the elastica goes down to " << 1 / most_foldings
       << ": check the units of density, field, magnetisation and Young's modulus, or state less";
  throw SolverError(text.str());
}

/// The horizontal force of the load, N: the environment's is not counted.
double applied_force(const Load& load, const PlanarUnits& units, const Equilibrium& equilibrium,
                     double tip_height) {
  if (load.is<FlowLoad>()) return magnitude(load) * tip_height;
  if (load.is<DeadLoad>()) return magnitude(load) * units.length;
  return units.force * equilibrium.unknowns.force;
}

}  // namespace

PlanarUnits units_of(const Cilium& cilium, double azimuth) {
  double stiffest = 0;
  for (const Segment& segment : cilium.segments)
    stiffest = std::max(stiffest, segment.young_modulus * cilium.second_moment(azimuth));
  const double L = cilium.length();
  return {L, stiffest / (L * L)};
}

Rod rod_of(const Cilium& cilium, const Load& load) {
  const PlanarUnits units = units_of(cilium, azimuth(load));
  const Vector3 e = direction(load);
  const surroundings::Environment environment = acting_environment(load);
  if (!surroundings::lies_in_plane(environment, cilium, e))
    throw InputError(
        "the elastica is planar: gravity, field and magnetisation must lie in the plane of the "
        "load's azimuth; the beam and the solid take any");
  const double B = units.force * units.length * units.length;
  Rod rod;
  for (const double end : cilium.interfaces()) rod.ends.push_back(end / units.length);
  rod.ends.back() = 1;
  const auto dead = load.as<DeadLoad>();
  for (const Segment& segment : cilium.segments) {
    Vector3 force = cilium.area() * surroundings::weight_per_volume(environment, segment);
    if (dead) force += dead->force_per_length * e;
    rod.per_length.push_back(in_plane(force * units.length / units.force, e));
    rod.compliance.push_back(B / (segment.young_modulus * cilium.second_moment(azimuth(load))));
  }
  std::vector<Vector3> at_ends = surroundings::pole_forces(environment, cilium);
  for (std::size_t i = 0; i < cilium.segments.size(); ++i) {
    // M·e across the axis is turned as M₃ would be by the field turned by 90°.
    const Vector3 force = cilium.area() * magnetization(cilium.segments[i]).dot(e) *
                          e.cross(Vector3::UnitZ()).cross(environment.uniform_field);
    at_ends[i] -= force;
    at_ends[i + 1] += force;
  }
  for (const Vector3& force : at_ends) rod.at_ends.push_back(in_plane(force / units.force, e));
  if (const auto flow = load.as<FlowLoad>())
    rod.per_height = flow->force_per_height * units.length / units.force;
  if (const auto couple = load.as<MomentLoad>())
    rod.tip_moment = couple->moment / (units.force * units.length);
  return rod;
}

std::optional<double> critical_factor(const Cilium& cilium,
                                      const surroundings::Environment& environment, double most) {
  if (!environment.gravity.head<2>().isZero() || !environment.uniform_field.head<2>().isZero() ||
      !environment.magnets.empty())
    throw InputError("the critical load is that of gravity and field along the axis");
  if (!environment.uniform_field.isZero(0) && has_transverse_magnetization(cilium))
    throw InputError(
        "a cilium that is magnetised across its axis is bent by a field along it and does not "
        "buckle");
  const CrossSection& section = cilium.section;
  const double across = cilium.is_rectangular() && section.width > section.height
                            ? section.orientation + std::numbers::pi / 2
                            : section.orientation;
  const Rod rod = rod_of(cilium, with_environment(EnvironmentLoad{1, across}, environment));
  // By decades, so that the steps in each are small against the distance of two critical loads.
  for (const double part : {1e-4, 1e-3, 1e-2, 0.1, 1.0})
    if (const auto factor = critical_scale(rod, part * most)) return factor;
  return std::nullopt;
}

void solve_step(const Cilium& cilium, double tolerance, MechanicsStep& step) {
  const PlanarUnits units = units_of(cilium, azimuth(step.load));
  const Rod rod = rod_of(cilium, step.load);
  require_resolvable(rod, step.load.is<SectionLoad>() ? magnitude(step.load) / units.force : 0);
  std::optional<Equilibrium> equilibrium;
  if (contact_height(step.load))
    equilibrium = pushed(rod, units, tolerance, step);
  else
    equilibrium = pulled(rod, units, tolerance, step.load);
  if (!equilibrium) {
    step.status = Status::slipped_off;
    return;
  }
  const PlanarShape found = shape(rod, *equilibrium, tolerance);
  step.deformation = Deformation{
      planar_centreline(found, units, direction(step.load), std::max(tolerance / 10, 1e-13)),
      nullptr};
  step.status = Status::converged;
  step.unstable_modes = equilibrium->unstable_modes;
  if (equilibrium->unstable_modes > 0) step.message = not_stable(equilibrium->unstable_modes);
  const CentrelinePoint tip = step.deformation->centreline.at(units.length);
  step.applied_force = applied_force(step.load, units, *equilibrium, tip.position.z());
  if (contact_height(step.load)) step.contact_arclength = units.length * equilibrium->unknowns.at;
  const double error = std::max(found.error, tolerance);
  step.tip_uncertainty = units.length * error;
  step.tip_angle_uncertainty = error * std::max(1.0, std::abs(equilibrium->unknowns.tip_angle));
  step.applied_force_uncertainty =
      std::max(error, std::numeric_limits<double>::epsilon()) * std::abs(step.applied_force);
  step.unknowns = 3;
  step.iterations = equilibrium->iterations;
}

}  // namespace ciliaval::analytic::elastica::environment
