// SPDX-License-Identifier: LGPL-2.1-or-later
#include "analytic/elastica/sweep_path.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <numbers>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "analytic/elastica/outline.h"
#include "analytic/elastica/planar.h"
#include "analytic/elastica/point_forces/section.h"
#include "analytic/elastica/sweep.h"
#include "analytic/elastica/tip_contact.h"
#include "problem/error.h"

namespace ciliaval::analytic::elastica {
namespace {

/// The events of a path lie within this part of the length of where they are said to be; at a place
/// where the tip sticks the rest of the path depends on it.
constexpr double event_accuracy = 1e-8;
constexpr double force_accuracy = 1e-7;  ///< relative; near an event the forces are steep

PlanarUnits units_of(const Cilium& cilium) {
  const double length = cilium.length();
  return {length, tip_stiffness(cilium) / (length * length)};
}

/// The shape under the forces of a contact, step by step up from the base.
PlanarShape shape_of(const TipProblem& problem, const TipContact& contact) {
  auto steps =
      std::make_shared<const std::vector<point_forces::Step>>(steps_along(problem, contact));
  PlanarShape shape;
  shape.breaks.push_back(0);
  for (const point_forces::Step& step : *steps) shape.breaks.push_back(step.end());
  shape.state = [steps, problem, contact](double S, std::size_t i) {
    const point_forces::Step& step = (*steps)[i];
    const point_forces::Section at = step.at(S);
    const double middle = std::midpoint(step.start(), step.end());
    std::size_t segment = 0;
    while (problem.ends[segment + 1] < middle) ++segment;
    PlanarState state;
    state.S = S;
    state.theta = at.theta;
    state.phi = std::numbers::pi / 2 - at.theta;
    state.w = at.x;
    state.z = at.z;
    state.curvature = at.curvature;
    state.moment = at.curvature / problem.compliance[segment];
    state.force = contact.force_x;
    state.vertical = contact.force_z;
    for (const Touch& touch : contact.touches)
      if (touch.S < middle) {
        state.force -= touch.force_x;
        state.vertical -= touch.force_z;
      }
    return state;
  };
  return shape;
}

SurfaceContact::State state_of(TipState state) {
  switch (state) {
    case TipState::open:
      return SurfaceContact::State::open;
    case TipState::stick:
      return SurfaceContact::State::stick;
    case TipState::slip:
      break;
  }
  return SurfaceContact::State::slip;
}

SurfaceContact::Where where_of(const TipContact& contact) {
  const bool mantle =
      std::ranges::any_of(contact.touches, [](const Touch& touch) { return touch.S < 1; });
  return mantle ? SurfaceContact::Where::mantle : SurfaceContact::Where::rim;
}

SurfaceContact contact_of(const SweepSample& sample, const PlanarUnits& units, const Vector3& e) {
  const double energy = units.force * units.length;
  SurfaceContact result;
  result.state = state_of(sample.state);
  result.where = where_of(sample.contact);
  result.normal_force = units.force * sample.contact.normal_force;
  result.friction_force = units.force * sample.contact.friction_force;
  result.point =
      units.length * (sample.contact.contact_x * e + sample.contact.contact_z * Vector3::UnitZ());
  result.elastic_energy = energy * sample.contact.energy;
  result.surface_work = energy * sample.surface_work;
  result.friction_work = energy * sample.friction_work;
  for (const TipJump& jump : sample.jumps)
    result.energy_lost = result.energy_lost.value_or(0) + energy * jump.energy_lost;
  return result;
}

MechanicsStep step_of(const TipProblem& problem, const SweepSample& sample, const Load& load,
                      const Cilium& cilium, double tolerance) {
  const PlanarUnits units = units_of(cilium);
  MechanicsStep step;
  step.load = load;
  step.status = Status::converged;
  step.contact = contact_of(sample, units, direction(load));
  if (std::ranges::any_of(sample.jumps, [](const TipJump& jump) { return !jump.is_followed; }))
    step.message =
        "the way to the next equilibrium after a jump was not found: the state is that which a "
        "long "
        "sweep in this direction leaves";
  const bool open = sample.state == TipState::open;
  step.deformation =
      Deformation{open ? straight_centreline(cilium.interfaces())
                       : planar_centreline(shape_of(problem, sample.contact), units,
                                           direction(load), std::max(tolerance / 10, 1e-13)),
                  nullptr};
  step.applied_force = units.force * sample.contact.force_x;
  const double error = open ? 0 : std::max(tolerance, event_accuracy);
  step.tip_uncertainty = units.length * error;
  step.tip_angle_uncertainty = error;
  step.applied_force_uncertainty = force_accuracy * std::abs(step.applied_force);
  step.unknowns = 3;
  step.iterations = sample.contact.iterations;
  return step;
}

std::vector<SurfacePlace> places_of(const LoadPath& path, double length) {
  require_one_surface(path);
  std::vector<SurfacePlace> places;
  for (const Load& load : path) {
    const SweepLoad sweep = load.as<SweepLoad>().value();
    places.push_back({1 - sweep.interference / length, sweep.travel / length});
  }
  return places;
}

}  // namespace

MechanicsResult solve_sweep(const Cilium& cilium, const LoadPath& path, CiliumEnd end,
                            double tolerance, const Progress& progress) {
  MechanicsResult result;
  result.undeformed.centreline = straight_centreline(cilium.interfaces());
  TipProblem problem = tip_problem(cilium, end);
  problem.tolerance = tolerance;
  auto begin = std::chrono::steady_clock::now();
  std::string failure;
  try {
    sweep(problem, *path.front().surface(), places_of(path, cilium.length()),
          [&](const SweepSample& sample) {
            result.steps.push_back(
                step_of(problem, sample, path[result.steps.size()], cilium, tolerance));
            const auto now = std::chrono::steady_clock::now();
            result.steps.back().seconds = std::chrono::duration<double>(now - begin).count();
            begin = now;
            report_step(progress, result.steps, path.size());
          });
  } catch (const SolverError& error) {
    failure = error.what();
  } catch (const InputError& error) {
    if (result.steps.empty()) throw;
    failure = error.what();
  }
  while (result.steps.size() < path.size()) {
    MechanicsStep step;
    step.load = path[result.steps.size()];
    step.message = failure;
    result.steps.push_back(std::move(step));
  }
  return result;
}

}  // namespace ciliaval::analytic::elastica
