// SPDX-License-Identifier: LGPL-2.1-or-later
#include "analytic/elastica.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iomanip>
#include <limits>
#include <sstream>
#include <string>
#include <utility>

#include "analytic/elastica_arclength.h"
#include "analytic/elastica_height.h"
#include "analytic/elastica_planar.h"
#include "problem/error.h"

namespace ciliaval::analytic {
namespace {

/// Slip-off force of the last contact height asked for: the same all along most load paths.
struct SlipOff {
  double height = -1;  ///< h, m
  double force = 0;    ///< N
};

SlipOff slip_off(const Cilium& cilium, const ContactLoad& load, const ElasticaOptions& options,
                 const SlipOff& known) {
  if (known.height == load.height) return known;
  const Load unit = ContactLoad{1, load.height, load.azimuth};
  const PlanarProblem problem = planar_problem(cilium, unit);
  const double critical = options.form == ElasticaOptions::Form::height
                              ? slip_off_height(problem)
                              : slip_off_arclength(problem, options.tolerance);
  return {load.height, critical / problem.load};
}

/// The horizontal force along e: F, q z_tip or q L.
double applied_force(const Load& load, const Deformation& deformation) {
  const Centreline& centreline = deformation.centreline;
  if (const auto* flow = std::get_if<FlowLoad>(&load))
    return flow->force_per_height * centreline.at(centreline.length()).position.z();
  if (const auto* dead = std::get_if<DeadLoad>(&load))
    return dead->force_per_length * centreline.length();
  return magnitude(load);
}

void solve_step(const Cilium& cilium, const ElasticaOptions& options, MechanicsStep& step) {
  const PlanarProblem problem = planar_problem(cilium, step.load);
  const PlanarUnits units = planar_units(cilium, step.load);
  const bool height_form = options.form == ElasticaOptions::Form::height;
  const auto shape =
      height_form ? solve_height(problem) : solve_arclength(problem, options.tolerance);
  if (!shape || (step.slip_off_force && magnitude(step.load) > *step.slip_off_force)) {
    step.status = Status::slipped_off;
    std::ostringstream message;
    message
        << "the contact slips off: the largest force an equilibrium bears, at which the tip sinks "
           "to the contact height, is "
        << std::setprecision(8) << 1e3 * step.slip_off_force.value_or(0) << " mN";
    step.message = message.str();
    return;
  }
  // Near 90° the height form has noise of some 1e-11, which finer pieces would resolve.
  const double resolution = std::max(options.tolerance / 10, height_form ? 1e-11 : 1e-13);
  step.deformation =
      Deformation{planar_centreline(*shape, units, direction(step.load), resolution), nullptr};
  step.status = Status::converged;
  step.applied_force = applied_force(step.load, *step.deformation);
  if (shape->contact) step.contact_arclength = *shape->contact * units.length;
  step.tip_uncertainty =
      units.length * std::max(shape->error, std::numeric_limits<double>::epsilon());
  step.unknowns = 1;
  step.iterations = shape->iterations;
}

}  // namespace

MechanicsResult Elastica::solve(const Cilium& cilium, const LoadPath& path,
                                const Progress& progress) const {
  if (!(options_.tolerance > 0 && options_.tolerance <= 1e-3))
    throw InputError("elastica: the tolerance must lie between 0 and 1e-3");
  require_valid(cilium);
  for (const Load& load : path) require_valid(load, cilium);

  MechanicsResult result;
  result.undeformed.centreline = straight_centreline(cilium.interfaces());
  SlipOff known;
  for (const Load& load : path) {
    const auto begin = std::chrono::steady_clock::now();
    MechanicsStep step;
    step.load = load;
    try {
      if (const auto* contact = std::get_if<ContactLoad>(&load)) {
        known = slip_off(cilium, *contact, options_, known);
        step.slip_off_force = known.force;
      }
      solve_step(cilium, options_, step);
    } catch (const SolverError& error) {
      step.status = Status::failed;
      step.message = error.what();
    }
    step.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    result.steps.push_back(std::move(step));
    if (progress)
      progress("elastica: step " + std::to_string(result.steps.size()) + "/" +
               std::to_string(path.size()));
  }
  return result;
}

}  // namespace ciliaval::analytic
