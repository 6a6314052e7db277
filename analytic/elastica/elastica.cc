// SPDX-License-Identifier: LGPL-2.1-or-later
#include "analytic/elastica/elastica.h"

#include <algorithm>
#include <chrono>
#include <iomanip>
#include <limits>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "analytic/elastica/arclength.h"
#include "analytic/elastica/environment/step.h"
#include "analytic/elastica/height.h"
#include "analytic/elastica/planar.h"
#include "analytic/elastica/probe.h"
#include "analytic/elastica/sweep_path.h"
#include "analytic/elastica/touch/pinned_rod.h"
#include "problem/error.h"
#include "problem/error_estimate.h"
#include "problem/joints/companions.h"

namespace ciliaval::analytic::elastica {
namespace {

struct SlipOff {
  double force = 0;                    ///< N
  std::optional<double> displacement;  ///< m, for a probe
};

/// True if the equations are those with an environment: the environment of an EnvironmentLoad may
/// be empty.
bool has_environment(const Load& load) {
  return load.is<EnvironmentLoad>() || !surroundings::is_empty(load.environment());
}

bool has_height_form(const ElasticaOptions& options) {
  return options.form == ElasticaOptions::Form::height;
}

PlanarSolver solver(const ElasticaOptions& options) {
  if (has_height_form(options)) return [](const PlanarProblem& p) { return solve_height(p); };
  return [options](const PlanarProblem& p) { return solve_arclength(p, options.tolerance); };
}

/// Tolerance of a probe's displacement found by its force, relative to max(δ, h); the height form's
/// quadrature holds 1e-9 near 90°.
double probe_tolerance(const ElasticaOptions& options) {
  return has_height_form(options) ? 1e-9 : 1e-12;
}

using joints::Corrections;

SlipOff slip_off(const Cilium& cilium, const Load& load, const ElasticaOptions& options,
                 const Corrections& corrections) {
  PlanarProblem problem = planar_problem(
      cilium, ContactLoad{1, contact_height(load).value(), azimuth(load)}, corrections);
  const double of_one_newton = problem.load;
  problem.load = has_height_form(options) ? slip_off_height(problem)
                                          : slip_off_arclength(problem, options.tolerance);
  SlipOff result{problem.load / of_one_newton, {}};
  if (!load.is<ProbeLoad>()) return result;
  const auto deflection = slip_off_deflection(problem, solver(options), !has_height_form(options),
                                              probe_tolerance(options));
  if (deflection) result.displacement = cilium.length() * *deflection;
  return result;
}

/// The contact force (N) that a probe's displacement takes, and the shape under it.
struct ProbeForce {
  double force = 0;
  std::optional<PlanarShape> shape;
};

ProbeForce probe_force(const Cilium& cilium, const ProbeLoad& load, double slip_off_force,
                       const ElasticaOptions& options, const Corrections& corrections) {
  PlanarProblem problem = planar_problem(cilium, load, corrections);
  const double of_one_newton = problem.load;
  if (load.displacement == 0) {
    problem.load = 0;
    return {0, solver(options)(problem)};
  }
  const double deflection = load.displacement / cilium.length();
  const double limit = slip_off_force * of_one_newton;
  auto probe = probe_by_load(problem, deflection, limit, solver(options), probe_tolerance(options));
  if (!probe && has_height_form(options))
    throw SolverError(
        "elastica, height form: theta at the contact is so near to 90 deg that the last bits of "
        "the force move the contact point by more than 1e-9; use form = \"arclength\"");
  if (!probe) probe = probe_by_arclength(problem, deflection, limit, solver(options));
  return {probe->load / of_one_newton, std::move(probe->shape)};
}

/// The horizontal force along e: F, q z_tip or q L.
double applied_force(const Load& load, const PlanarUnits& units, const Deformation& deformation) {
  const Centreline& centreline = deformation.centreline;
  if (load.is<MomentLoad>()) return 0;
  if (const auto flow = load.as<FlowLoad>())
    return flow->force_per_height * centreline.at(centreline.length()).position.z();
  if (const auto dead = load.as<DeadLoad>()) return dead->force_per_length * centreline.length();
  return units.force;
}

std::string slipped_off(const Load& load, double force, std::optional<double> displacement) {
  std::ostringstream message;
  message << std::setprecision(8) << "the contact slips off: ";
  if (load.is<ProbeLoad>())
    message << "the largest displacement in an equilibrium, at which the tip sinks to the contact "
               "height, is "
            << 1e3 * displacement.value_or(0) << " mm, under " << 1e3 * force << " mN";
  else
    message << "the largest force an equilibrium bears, at which the tip sinks to the contact "
               "height, is "
            << 1e3 * force << " mN";
  return message.str();
}

void say_slipped_off(MechanicsStep& step) {
  step.status = Status::slipped_off;
  step.message =
      slipped_off(step.load, step.slip_off_force.value_or(0), step.slip_off_displacement);
}

void solve_step(const Cilium& cilium, const ElasticaOptions& options,
                const Corrections& corrections, MechanicsStep& step) {
  const PlanarProblem problem = planar_problem(cilium, step.load, corrections);
  PlanarUnits units = planar_units(cilium, step.load);
  const bool height_form = has_height_form(options);
  std::optional<PlanarShape> shape;
  const std::optional<double> limit = slip_off_limit(step);
  if (!limit || magnitude(step.load) <= *limit) {
    if (const auto probe = step.load.as<ProbeLoad>()) {
      ProbeForce found =
          probe_force(cilium, *probe, step.slip_off_force.value(), options, corrections);
      units.force = found.force;
      shape = std::move(found.shape);
    } else {
      shape = solver(options)(problem);
    }
  }
  if (!shape) return say_slipped_off(step);
  // Near 90° the height form has noise of some 1e-11, which finer pieces would resolve.
  const double resolution = std::max(options.tolerance / 10, height_form ? 1e-11 : 1e-13);
  step.deformation =
      Deformation{planar_centreline(*shape, units, direction(step.load), resolution), nullptr};
  step.status = Status::converged;
  step.applied_force = applied_force(step.load, units, *step.deformation);
  if (shape->contact) step.contact_arclength = *shape->contact * units.length;
  // The difference of two integrations may be small by chance; the tolerance is what they keep.
  const double error = std::max(shape->error, options.tolerance);
  step.tip_uncertainty = units.length * error;
  step.tip_angle_uncertainty = error * step.deformation->centreline.at(units.length).theta();
  if (step.load.is<FlowLoad>())
    step.applied_force_uncertainty = magnitude(step.load) * *step.tip_uncertainty;
  else if (!step.load.is<ProbeLoad>())
    step.applied_force_uncertainty = std::numeric_limits<double>::epsilon() * step.applied_force;
  step.unknowns = 1;
  step.iterations = shape->iterations;
}

/// The errors of a touch, which are the tolerance.
void state_tolerance(const Cilium& cilium, double tolerance, MechanicsStep& step) {
  if (const auto largest = slip_off_limit(step)) step.slip_off_uncertainty = tolerance * *largest;
  if (step.status != Status::converged) return;
  step.tip_uncertainty = cilium.length() * tolerance;
  step.tip_angle_uncertainty = tolerance;
  step.applied_force_uncertainty = tolerance * std::abs(step.applied_force);
}

std::vector<MechanicsStep> solve_path(const Cilium& cilium, const LoadPath& path,
                                      const ElasticaOptions& options,
                                      const Corrections& corrections, const Progress& progress) {
  std::vector<MechanicsStep> steps;
  pin::PathSolver touching(
      [&](const Load& load) { return touch::pinned_rod(cilium, load, options.tolerance); },
      options.slip_off);
  for (const Load& load : path) {
    const auto begin = std::chrono::steady_clock::now();
    MechanicsStep step;
    step.load = load;
    try {
      if (!load.touch().is_plain()) {
        touching.solve(step);
        state_tolerance(cilium, options.tolerance, step);
      } else if (has_environment(load)) {
        environment::solve_step(cilium, options.tolerance, step);
        if (step.status == Status::slipped_off) say_slipped_off(step);
      } else if (contact_height(load) && (options.slip_off || load.is<ProbeLoad>())) {
        const SlipOff limit = slip_off(cilium, load, options, corrections);
        step.slip_off_force = limit.force;
        step.slip_off_displacement = limit.displacement;
        if (const auto largest = slip_off_limit(step))
          step.slip_off_uncertainty = options.tolerance * *largest;
        solve_step(cilium, options, corrections, step);
      } else {
        solve_step(cilium, options, corrections, step);
      }
    } catch (const SolverError& error) {
      step.status = Status::failed;
      step.message = error.what();
    }
    step.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    steps.push_back(std::move(step));
    report_step(progress, steps, path.size());
  }
  return steps;
}

/// Refuses loads and options that the equations of the joints do not cover.
void require_correctable(const LoadPath& path, const ElasticaOptions& options) {
  if (has_height_form(options))
    throw InputError(
        "elastica: the height form takes no joints = \"corrected\"; use form = \"arclength\"");
  for (const Load& load : path) {
    if (load.is<SweepLoad>())
      throw InputError("elastica: joints = \"corrected\" takes no sweep: take joints = \"none\"");
    if (!load.touch().is_plain())
      throw InputError("elastica: joints = \"corrected\" takes no 'touch': take joints = \"none\"");
    if (has_environment(load))
      throw InputError(
          "elastica: joints = \"corrected\" takes no environment: take the beam, or joints = "
          "\"none\"");
  }
}

}  // namespace

MechanicsResult Elastica::solve(const Cilium& cilium, const LoadPath& path,
                                const Progress& progress) const {
  if (!(options_.tolerance > 0 && options_.tolerance <= 1e-3))
    throw InputError("elastica: the tolerance must lie between 0 and 1e-3");
  require_valid(cilium);
  for (const Load& load : path) {
    require_valid(load, cilium);
    if (has_environment(load) && has_height_form(options_))
      throw InputError("elastica: the height form takes no environment");
    if (!load.environment().magnets.empty())
      throw InputError(
          "the elastica takes no magnets beside the cilium: it is integrated from the tip, whose "
          "place it does not know before; use the beam");
    if (!load.touch().is_plain() && (has_environment(load) || has_height_form(options_)))
      throw InputError(
          "the elastica takes a 'touch' in its arc-length form, without an environment");
    if (has_environment(load)) environment::rod_of(cilium, load);  // refuses what is not planar
    if (has_environment(load) && load.is<SweepLoad>())
      throw InputError("the elastica takes a sweep without an environment only");
  }
  if (options_.joints == joints::Correction::corrected) require_correctable(path, options_);
  if (!path.empty() && path.front().is<SweepLoad>()) {
    if (has_height_form(options_)) refuse_type(path.front(), "elastica's height form");
    return solve_sweep(cilium, path, options_.tip, options_.tolerance, progress);
  }

  MechanicsResult result;
  result.undeformed.centreline = straight_centreline(cilium.interfaces());
  if (options_.joints == joints::Correction::none) {
    result.steps = solve_path(cilium, path, options_, {}, progress);
    return result;
  }
  const Corrections corrections = joints::corrections(cilium);
  result.steps = solve_path(cilium, path, options_, corrections, progress);
  joints::remark_on_strains(cilium, result.steps);
  if (!options_.error_estimate) return result;
  result.algebraic_error = options_.tolerance;
  for (MechanicsStep& step : result.steps) {
    if (step.tip_uncertainty)
      result.algebraic_error =
          std::max(result.algebraic_error, *step.tip_uncertainty / cilium.length());
    step.slip_off_uncertainty.reset();  // of the integration alone
  }
  joints::add_companion(result, cilium, corrections,
                        [&](const LoadPath& loads, const Corrections& changed) {
                          return solve_path(cilium, loads, options_, changed, {});
                        });
  estimate_errors(result);
  return result;
}

}  // namespace ciliaval::analytic::elastica
