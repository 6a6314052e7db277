// SPDX-License-Identifier: LGPL-2.1-or-later
#include "analytic/elastica/sweep_path.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "analytic/elastica/planar.h"
#include "analytic/elastica/sweep.h"
#include "analytic/elastica/taylor.h"
#include "analytic/elastica/tip_contact.h"
#include "problem/error.h"

namespace ciliaval::analytic::elastica {
namespace {

/// The events of a path lie within this part of the length of where they are said to be; at a place
/// where the tip sticks the rest of the path depends on it.
constexpr double event_accuracy = 1e-8;
constexpr double force_accuracy = 1e-7;  ///< relative; near an event the forces are steep

PlanarUnits units_of(const Cilium& cilium) {
  double stiffest = 0;
  for (const Segment& segment : cilium.segments)
    stiffest = std::max(stiffest, segment.young_modulus);
  const double length = cilium.length();
  return {length, stiffest * cilium.second_moment() / (length * length)};
}

/// The shape under the forces of a contact, integrated from the base in the frame in which they
/// are horizontal.
PlanarShape shape_of(const TipProblem& problem, const TipContact& contact) {
  const double turn = std::atan2(-contact.force_z, contact.force_x);
  PlanarState state;
  state.theta = -turn;
  state.phi = std::numbers::pi / 2 + turn;
  state.moment = contact.base_moment;
  state.force = std::hypot(contact.force_x, contact.force_z);
  auto steps = std::make_shared<std::vector<TaylorStep>>();
  PlanarShape shape;
  shape.breaks.push_back(0);
  for (std::size_t i = 0; i < problem.compliance.size(); ++i)
    while (state.S < problem.ends[i + 1]) {
      steps->emplace_back(state, problem.compliance[i], ForceLaw::constant, problem.ends[i + 1],
                          1e-16, 1);
      state = steps->back().end_state();
      shape.breaks.push_back(state.S);
    }
  shape.state = [=, x = contact.force_x, z = contact.force_z](double S, std::size_t i) {
    const PlanarState turned = (*steps)[i].at(S);
    PlanarState result = turned;
    result.theta = turned.theta + turn;
    result.phi = std::numbers::pi / 2 - result.theta;
    result.w = std::cos(turn) * turned.w + std::sin(turn) * turned.z;
    result.z = std::cos(turn) * turned.z - std::sin(turn) * turned.w;
    result.force = x;
    result.vertical = z;
    return result;
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

SurfaceContact contact_of(const SweepSample& sample, const PlanarUnits& units, const Vector3& e) {
  const double energy = units.force * units.length;
  SurfaceContact result;
  result.state = state_of(sample.state);
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
  std::vector<SurfacePlace> places;
  for (const Load& load : path) {
    const auto sweep = load.as<SweepLoad>();
    if (!sweep || load.surface() != path.front().surface() ||
        azimuth(load) != azimuth(path.front()))
      throw InputError("the steps of a sweep have one surface and one azimuth");
    places.push_back({1 - sweep->interference / length, sweep->travel / length});
  }
  return places;
}

}  // namespace

MechanicsResult solve_sweep(const Cilium& cilium, const LoadPath& path, double tolerance,
                            const Progress& progress) {
  MechanicsResult result;
  result.undeformed.centreline = straight_centreline(cilium.interfaces());
  TipProblem problem = tip_problem(cilium);
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
            if (progress)
              progress("elastica: sample " + std::to_string(result.steps.size()) + "/" +
                       std::to_string(path.size()));
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
