// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/newton.h"

#include <deal.II/dofs/dof_tools.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "fem/solid/assembly.h"
#include "problem/error.h"

namespace ciliaval::fem {
namespace {

using dealii::Vector;

/// Residual beyond which an iteration is given up, relative to the force scale.
constexpr double divergence = 1e12;
/// Residual below which the increment decides. u carries ε|u|, which the stiffness K/h of the
/// volume change turns into nodal forces of up to ε|u|Kh: 1e-9 of the load of a cilium with ν =
/// 0.49, 1e-7 of one with ν = 0.4999, so that a residual of 1e-9 cannot always be had.
constexpr double rounding_level = 1e-6;

/// What is left at the free degrees of freedom, and the scale that it is measured by.
double relative_residual(const InternalForces& internal, const Vector<double>& external,
                         const dealii::AffineConstraints<double>& constraints,
                         const NewtonOptions& options, Vector<double>& residual,
                         Vector<double>& reactions) {
  reactions = internal.forces;
  reactions -= external;
  double reaction_norm = 0;
  for (const auto& line : constraints.get_lines())
    reaction_norm = std::hypot(reaction_norm, reactions[line.index]);
  residual = external;
  residual -= internal.condensed;
  constraints.set_zero(residual);
  const double external_norm = external.l2_norm();
  const double scale =
      std::max(external_norm > 0 ? external_norm : reaction_norm, options.least_force);
  const double norm = residual.l2_norm();
  return norm > 0 ? norm / scale : 0;
}

}  // namespace

Newton::Newton(const SolidSpace& space, dealii::AffineConstraints<double> constraints)
    : space_(space),
      constraints_(std::move(constraints)),
      size_(dealii::GridTools::diameter(space.dof_handler().get_triangulation())) {
  dealii::DynamicSparsityPattern pattern(space.unknowns());
  dealii::DoFTools::make_sparsity_pattern(space.dof_handler(), pattern, constraints_, true);
  sparsity_.copy_from(pattern);
  matrix_.reinit(sparsity_);
}

NewtonResult Newton::solve(const ExternalForces& external, SolidState& state,
                           const NewtonOptions& options, const NewtonProgress& progress) {
  NewtonResult result;
  Vector<double> residual;
  Vector<double> increment;
  dealii::SparseDirectUMFPACK factorisation;
  const auto fail = [&result](const std::string& reason) {
    result.reason = reason;
    return result;
  };
  for (int iteration = 0;; ++iteration) {
    const auto internal = internal_forces(space_, state);
    result.overshot = !internal && iteration == 1;
    if (!internal) return fail("det F is not positive at a quadrature point");
    result.external.reinit(space_.unknowns());
    external(state.displacement, result.external, constraints_, nullptr);
    const double norm = relative_residual(*internal, result.external, constraints_, options,
                                          residual, result.reactions);
    result.residuals.push_back(norm);
    if (progress) progress(iteration, norm);
    if (!std::isfinite(norm) || norm > divergence) return fail("the residual grows without bound");
    if (iteration > 0 && norm <= std::max(options.tolerance, rounding_level)) {
      // The last factorisation is good enough to tell the size of the step that is left.
      increment = residual;
      factorisation.solve(increment);
      constraints_.distribute(increment);
      const double scale = std::max(state.displacement.linfty_norm(), 1e-6 * size_);
      if (increment.linfty_norm() <= options.tolerance * scale) {
        result.converged = true;
        return result;
      }
    }
    if (norm == 0) {
      result.converged = true;
      return result;
    }
    if (iteration == static_cast<int>(options.max_iterations))
      return fail("no convergence in " + std::to_string(iteration) + " iterations");

    matrix_ = 0;
    add_stiffness(space_, state, *internal, constraints_, matrix_);
    Vector<double> unused(space_.unknowns());
    external(state.displacement, unused, constraints_, &matrix_);
    try {
      factorisation.initialize(matrix_);
    } catch (const dealii::ExceptionBase&) {
      return fail("the stiffness matrix is singular");
    }
    increment = residual;
    factorisation.solve(increment);
    constraints_.distribute(increment);
    if (!std::isfinite(increment.l2_norm())) return fail("the stiffness matrix is singular");
    result.increments.push_back(increment.linfty_norm());
    advance(space_, *internal, increment, state);
  }
}

}  // namespace ciliaval::fem
