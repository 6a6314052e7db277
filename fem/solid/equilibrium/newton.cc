// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/equilibrium/newton.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "fem/parallel.h"
#include "fem/solid/discretisation/assembly.h"
#include "fem/solid/equilibrium/bordered_system.h"
#include "problem/error.h"

namespace ciliaval::fem::solid::equilibrium {
using namespace discretisation;
using namespace loads;
using namespace solvers;
namespace {

/// Residual beyond which an iteration is given up, relative to the force scale.
constexpr double divergence = 1e12;
/// Residual below which the increment alone decides. u carries ε|u|, which the stiffness K/h of the
/// volume change turns into nodal forces: with ν = 0.4999 the residual stays at 1.5e-6 of the load.
constexpr double rounding_level = 1e-4;

/// The residual at the free degrees of freedom, relative to the force scale.
double relative_residual(const InternalForces& internal, const Vector& external,
                         const dealii::AffineConstraints<double>& constraints,
                         const NewtonOptions& options, Vector& residual, Vector& reactions) {
  reactions = internal.forces;
  reactions -= external;
  double reaction_norm = 0;
  for (const auto& line : constraints.get_lines())
    if (reactions.in_local_range(line.index))
      reaction_norm = std::hypot(reaction_norm, reactions[line.index]);
  const MPI_Comm communicator = reactions.get_mpi_communicator();
  if (rank_count(communicator) > 1)
    reaction_norm =
        std::sqrt(dealii::Utilities::MPI::sum(reaction_norm * reaction_norm, communicator));
  residual = external;
  residual -= internal.condensed;
  constraints.set_zero(residual);
  const double external_norm = external.l2_norm();
  const double scale =
      std::max(external_norm > 0 ? external_norm : reaction_norm, options.least_force);
  const double norm = residual.l2_norm();
  return norm > 0 ? norm / scale : 0;
}

/// Relative residual of the linear systems: Newton's quadratic convergence is kept down to there.
constexpr double step_reduction = 1e-6;
/// … where only the size of the solution is asked for.
constexpr double estimate_reduction = 1e-3;
/// Part of the last increment below which the next one is taken as the last tangent gives it.
constexpr double chord_reduction = 1e-2;
/// Residual up to which the last tangent is tried after increments that shrink fast. From a beam's
/// guess, which is far off in stiff directions, it would fail.
constexpr double chord_residual = 1e-2;
constexpr double fast_reduction = 0.1;

/// True if the residual is so small that the increment alone decides on convergence.
bool is_small(double residual, const NewtonOptions& options) {
  return residual <= std::max(options.tolerance, rounding_level);
}

/// True if an increment by the last tangent is worth its solution.
bool may_use_last_tangent(const NewtonResult& result, const NewtonOptions& options) {
  const double residual = result.residuals.back();
  const std::vector<double>& increments = result.increments;
  const std::size_t n = increments.size();
  if (n == 0) return false;
  return is_small(residual, options) || (residual <= chord_residual && n > 1 &&
                                         increments[n - 1] <= fast_reduction * increments[n - 2]);
}

/// Diagonal of the body's bounding box, m.
double diagonal(const SolidSpace& space) {
  std::array<double, 6> reach;  // −X and X at most
  reach.fill(-std::numeric_limits<double>::infinity());
  for (const SolidElement& element : space.own_elements())
    for (std::size_t k = 0; k < 3; ++k) {
      const auto X = element.nodes.col(static_cast<Eigen::Index>(k));
      reach.at(2 * k) = std::max(reach.at(2 * k), -X.minCoeff());
      reach.at(2 * k + 1) = std::max(reach.at(2 * k + 1), X.maxCoeff());
    }
  for (double& value : reach) value = dealii::Utilities::MPI::max(value, space.communicator());
  return std::hypot(reach[0] + reach[1], reach[2] + reach[3], reach[4] + reach[5]);
}

}  // namespace

Newton::Newton(const SolidSpace& space, dealii::AffineConstraints<double> constraints,
               SolverKind solver, MPI_Comm communicator)
    : space_(space),
      constraints_(std::move(constraints)),
      communicator_(communicator),
      size_(diagonal(space)) {
  solver_ = std::make_unique<LinearSolver>(space, constraints_, solver, communicator);
}

NewtonResult Newton::solve(const ExternalForces& external, SolidState& state,
                           const NewtonOptions& options, const NewtonProgress& progress) {
  return iterate(external, nullptr, state, options, progress);
}

NewtonResult Newton::solve(UnknownForce& force, SolidState& state, const NewtonOptions& options,
                           const NewtonProgress& progress) {
  BorderedSystem bordered(force, constraints_);
  const auto external = [&force](const auto& u, auto& forces, auto* tangent) {
    force.forces(force.amplitude)(u, forces, tangent);
    if (force.others) force.others(u, forces, tangent);
  };
  return iterate(external, &bordered, state, options, progress);
}

Newton::Step Newton::last_tangents_step(const SolidState& state, const Vector& residual,
                                        BorderedSystem* bordered) {
  Step step;
  step.linear_iterations = solver_->solve(residual, step.increment, estimate_reduction);
  if (bordered != nullptr) step.amplitude = bordered->complete(state.displacement, step.increment);
  constraints_.set_zero(step.increment);
  return step;
}

Newton::Use Newton::use_of(const Step& step, const SolidState& state, const NewtonResult& result,
                           const NewtonOptions& options) const {
  const double scale = std::max(state.displacement.linfty_norm(), 1e-6 * size_);
  if (is_small(result.residuals.back(), options) && step.size() <= options.tolerance * scale)
    return Use::last_increment;
  if (result.iterations() < static_cast<int>(options.max_iterations) &&
      step.size() <= chord_reduction * result.increments.back())
    return Use::increment;
  return Use::none;
}

void Newton::assemble_tangent(const ExternalForces& external, const SolidState& state,
                              const InternalForces& internal, TangentMatrix& tangent) {
  add_stiffness(space_, state, internal, tangent, solver_->cells());
  Vector unused = space_.vector();
  external(state.displacement, unused, &tangent);
}

std::optional<SecondVariation> Newton::second_variation(
    const ExternalForces& external, const SolidState& state,
    const dealii::AffineConstraints<double>& constraints) {
  if (!solver_->is_direct()) return std::nullopt;
  const auto internal = internal_forces(space_, state);
  if (!internal) throw SolverError("det F is not positive at a quadrature point");
  dealii::SparseMatrix<double> matrix(solver_->pattern());
  AssembledTangent tangent(constraints, matrix);
  assemble_tangent(external, state, *internal, tangent);
  return equilibrium::second_variation(space_, constraints, matrix, solver_->rows(), communicator_);
}

Vector Newton::response(const ExternalForces& external, const ExternalForces& rate,
                        const SolidState& state) {
  const auto internal = internal_forces(space_, state);
  if (!internal) throw SolverError("det F is not positive at a quadrature point");
  assemble_tangent(external, state, *internal, solver_->new_tangent());
  solver_->prepare();
  Vector forces = forces_at(state.displacement, space_, rate);
  constraints_.set_zero(forces);
  Vector result = space_.vector();
  solver_->solve(forces, result, step_reduction);
  constraints_.set_zero(result);
  return result;
}

Newton::Step Newton::own_tangents_step(const SolidState& state, const Vector& residual,
                                       BorderedSystem* bordered) {
  Step step;
  step.linear_iterations = solver_->solve(residual, step.increment, step_reduction);
  if (bordered != nullptr) {
    bordered->prepare(state.displacement, [this](const auto& rhs, auto& solution) {
      solver_->solve(rhs, solution, step_reduction);
    });
    step.amplitude = bordered->complete(state.displacement, step.increment);
  }
  constraints_.set_zero(step.increment);
  return step;
}

NewtonResult Newton::iterate(const ExternalForces& external, BorderedSystem* bordered,
                             SolidState& state, const NewtonOptions& options,
                             const NewtonProgress& progress) {
  NewtonResult result;
  Vector residual;
  const auto fail = [&result](const std::string& reason) {
    result.reason = reason;
    return result;
  };
  for (int iteration = 0;; ++iteration) {
    const auto internal = internal_forces(space_, state);
    result.overshot = !internal && iteration == 1;
    if (!internal) return fail("det F is not positive at a quadrature point");
    try {
      result.external = forces_at(state.displacement, space_, external);
    } catch (const SolverError& error) {  // inside a magnet
      return fail(error.what());
    }
    const double norm = relative_residual(*internal, result.external, constraints_, options,
                                          residual, result.reactions);
    result.residuals.push_back(norm);
    if (progress) progress(iteration, norm);
    if (!std::isfinite(norm) || norm > divergence) return fail("the residual grows without bound");
    try {
      Step step;
      Use use = Use::none;
      if (may_use_last_tangent(result, options)) {
        step = last_tangents_step(state, residual, bordered);
        use = use_of(step, state, result, options);
      }
      if (use == Use::none) {
        if (norm == 0 && (bordered == nullptr || bordered->gap(state.displacement) == 0)) {
          result.converged = true;
          return result;
        }
        if (iteration == static_cast<int>(options.max_iterations))
          return fail("no convergence in " + std::to_string(iteration) + " iterations");
        assemble_tangent(external, state, *internal, solver_->new_tangent());
        if (iteration == 0)
          solver_->prepare();
        else
          solver_->prepare_near_last();
        step = own_tangents_step(state, residual, bordered);
      }
      if (bordered != nullptr) bordered->advance(step.amplitude);
      advance(space_, *internal, step.increment, state);
      if (use == Use::last_increment) {
        result.converged = true;
        result.external = forces_at(state.displacement, space_, external);
        return result;
      }
      result.linear_iterations.push_back(step.linear_iterations);
      result.increments.push_back(step.size());
    } catch (const SolverError& error) {
      return fail(error.what());
    }
  }
}

}  // namespace ciliaval::fem::solid::equilibrium
