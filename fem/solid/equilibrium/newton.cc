// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/equilibrium/newton.h"

#include <deal.II/grid/grid_tools.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "fem/solid/discretisation/assembly.h"
#include "fem/solid/equilibrium/bordered_system.h"
#include "problem/error.h"

namespace ciliaval::fem {
namespace {

using dealii::Vector;

/// Residual beyond which an iteration is given up, relative to the force scale.
constexpr double divergence = 1e12;
/// Residual below which the increment alone decides. u carries ε|u|, which the stiffness K/h of the
/// volume change turns into nodal forces; thin layers make them large, and fine meshes spread the
/// load over many small nodal forces. For the paper's cilium on the default mesh the residual stays
/// at some 1e-9 of the load with ν = 0.49, but at 1.5e-6 with ν = 0.4999.
constexpr double rounding_level = 1e-4;

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

/// The pattern of the tangent: all unknowns of nodes that share a cell. Found by nodes, of which
/// there are a third of the rows and a ninth of the entries.
dealii::DynamicSparsityPattern coupled_nodes(const SolidSpace& space) {
  std::vector<std::vector<Row>> neighbours(space.unknowns() / node_unknowns);
  for (const SolidElement& element : space.elements()) {
    std::array<Row, element_nodes> nodes{};
    for (std::size_t a = 0; a < element_nodes; ++a) nodes[a] = element.dofs[a] / node_unknowns;
    for (const Row node : nodes)
      neighbours[node].insert(neighbours[node].end(), nodes.begin(), nodes.end());
  }
  dealii::DynamicSparsityPattern pattern(space.unknowns());
  std::vector<Row> columns;
  for (Row node = 0; node < neighbours.size(); ++node) {
    std::vector<Row>& own = neighbours[node];
    std::sort(own.begin(), own.end());
    own.erase(std::unique(own.begin(), own.end()), own.end());
    columns.clear();
    for (const Row neighbour : own)
      for (Row k = 0; k < node_unknowns; ++k) columns.push_back(node_unknowns * neighbour + k);
    for (Row k = 0; k < node_unknowns; ++k)
      pattern.add_entries(node_unknowns * node + k, columns.begin(), columns.end(), true);
  }
  return pattern;
}

/// Relative residual of the linear systems. An iteration of Newton's method then reduces the
/// residual by no more than this factor: its quadratic convergence is kept down to there, and one
/// or two iterations more reach the tolerance.
constexpr double step_reduction = 1e-6;
/// … where only the size of the solution is asked for.
constexpr double estimate_reduction = 1e-3;
/// Part of the last increment below which the next one is taken as the last tangent gives it.
constexpr double chord_reduction = 1e-2;
/// It is tried from larger residuals than the rounding level on, up to this one, where the last
/// increment was so much smaller than the one before: with quadratic convergence each ratio is the
/// square of the one before. From a beam's guess, which is far in stiff directions, it would fail.
constexpr double chord_residual = 1e-2;
constexpr double fast_reduction = 0.1;

bool converges_fast(double residual, const std::vector<double>& increments) {
  const std::size_t n = increments.size();
  return residual <= chord_residual && n > 1 &&
         increments[n - 1] <= fast_reduction * increments[n - 2];
}

}  // namespace

Newton::Newton(const SolidSpace& space, dealii::AffineConstraints<double> constraints,
               SolverKind solver)
    : space_(space),
      constraints_(std::move(constraints)),
      size_(dealii::GridTools::diameter(space.dof_handler().get_triangulation())) {
  sparsity_.copy_from(coupled_nodes(space));
  matrix_.reinit(sparsity_);
  solver_ = std::make_unique<LinearSolver>(space, constraints_, sparsity_, solver);
  for (std::size_t e = 0; e < space.elements().size(); ++e) {
    const auto& dofs = space.elements()[e].dofs;
    if (std::any_of(dofs.begin(), dofs.end(),
                    [this](auto dof) { return solver_->rows().contains(dof); }))
      cells_.push_back(e);
  }
}

NewtonResult Newton::solve(const ExternalForces& external, SolidState& state,
                           const NewtonOptions& options, const NewtonProgress& progress) {
  return iterate(external, nullptr, state, options, progress);
}

NewtonResult Newton::solve(UnknownForce& force, SolidState& state, const NewtonOptions& options,
                           const NewtonProgress& progress) {
  Border border(force, constraints_);
  const auto external = [&force](const auto& u, auto& forces, const auto& constraints,
                                 auto* matrix) {
    force.forces(force.amplitude)(u, forces, constraints, matrix);
  };
  return iterate(external, &border, state, options, progress);
}

Newton::Step Newton::last_tangents_step(const SolidState& state, const Vector<double>& residual,
                                        Border* border) {
  Step step;
  step.linear_iterations = solver_->solve(residual, step.increment, estimate_reduction);
  if (border != nullptr) step.amplitude = border->complete(state.displacement, step.increment);
  constraints_.distribute(step.increment);
  return step;
}

Newton::Step Newton::own_tangents_step(const ExternalForces& external, const SolidState& state,
                                       const InternalForces& internal,
                                       const Vector<double>& residual, bool first, Border* border) {
  matrix_ = 0;
  add_stiffness(space_, state, internal, constraints_, matrix_, cells_);
  Vector<double> unused(space_.unknowns());
  external(state.displacement, unused, constraints_, &matrix_);
  solver_->prepare(matrix_, !first);
  Step step;
  step.linear_iterations = solver_->solve(residual, step.increment, step_reduction);
  if (border != nullptr) {
    border->prepare(state.displacement, [this](const auto& rhs, auto& solution) {
      solver_->solve(rhs, solution, step_reduction);
    });
    step.amplitude = border->complete(state.displacement, step.increment);
  }
  constraints_.distribute(step.increment);
  return step;
}

NewtonResult Newton::iterate(const ExternalForces& external, Border* border, SolidState& state,
                             const NewtonOptions& options, const NewtonProgress& progress) {
  NewtonResult result;
  Vector<double> residual;
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
    const bool may_go_on = iteration < static_cast<int>(options.max_iterations);
    try {
      Step step;
      bool enough = false;  // the last tangent's step is the last one, or much smaller than that
      const bool is_small = norm <= std::max(options.tolerance, rounding_level);
      if (iteration > 0 && (is_small || converges_fast(norm, result.increments))) {
        step = last_tangents_step(state, residual, border);
        const double scale = std::max(state.displacement.linfty_norm(), 1e-6 * size_);
        result.converged = is_small && step.size() <= options.tolerance * scale;
        enough = result.converged ||
                 (may_go_on && step.size() <= chord_reduction * result.increments.back());
      }
      if (!enough && norm == 0 && (border == nullptr || border->gap(state.displacement) == 0)) {
        result.converged = true;
        return result;
      }
      if (!enough && !may_go_on)
        return fail("no convergence in " + std::to_string(iteration) + " iterations");
      if (!enough)
        step = own_tangents_step(external, state, *internal, residual, iteration == 0, border);
      if (border != nullptr) border->advance(step.amplitude);
      advance(space_, *internal, step.increment, state);
      if (result.converged) {
        result.external = 0;
        external(state.displacement, result.external, constraints_, nullptr);
        return result;
      }
      result.linear_iterations.push_back(step.linear_iterations);
      result.increments.push_back(step.size());
    } catch (const SolverError& error) {
      return fail(error.what());
    }
  }
}

}  // namespace ciliaval::fem
