// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/sparse_matrix.h>
#include <deal.II/lac/sparsity_pattern.h>
#include <deal.II/lac/vector.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "fem/solid/discretisation/assembly.h"
#include "fem/solid/solvers/linear_solver.h"
#include "fem/solid/discretisation/space.h"

namespace ciliaval::fem {

/// External forces f(u): adds them to `forces` and, where `matrix` is not null, −∂f/∂u to it.
using ExternalForces = std::function<void(
    const dealii::Vector<double>& displacement, dealii::Vector<double>& forces,
    const dealii::AffineConstraints<double>& constraints, dealii::SparseMatrix<double>* matrix)>;

/// A force F f(u) whose amplitude F is one more unknown, and the condition g(u) = 0 that determines
/// it.
struct UnknownForce {
  std::function<ExternalForces(double amplitude)> forces;
  /// g; adds ∂g/∂u to `gradient` where that is not null.
  std::function<double(const dealii::Vector<double>& u, dealii::Vector<double>* gradient)>
      condition;
  double amplitude = 0;  ///< F: the guess, and the result
};

class Border;

struct NewtonOptions {
  double tolerance = 1e-9;  ///< of the remaining increment, relative to the displacement,
                            ///< and of the residual, relative to the force scale, as far as
                            ///< rounding errors let it fall
  unsigned int max_iterations = 25;  ///< increments
  double least_force = 0;            ///< lower bound of the force scale, N
};

struct NewtonResult {
  bool converged = false;
  std::string reason;                ///< why not
  bool overshot = false;             ///< det F was not positive after the very first iteration
  std::vector<double> residuals;     ///< relative, before each iteration and at the end
  std::vector<double> increments;    ///< ‖Δu‖_max of each iteration, m
  dealii::Vector<double> reactions;  ///< internal − external forces before the last increment, all
                                     ///< rows, N
  dealii::Vector<double> external;     ///< external forces at the end, N
  std::vector<int> linear_iterations;  ///< of GMRES in each iteration; 1: solved directly
  int iterations() const { return static_cast<int>(increments.size()); }
};

/// Called after each evaluation of the residual: iteration, relative residual.
using NewtonProgress = std::function<void(int, double)>;

/// Newton's method for internal(u, p) = external(u), p condensed, with a LinearSolver for the
/// unsymmetric tangent. It holds the matrix and its sparsity from one solution to the next. On
/// several ranks all functions are collective, and all ranks hold the same states, bit by bit.
///
/// The force scale of the residual is the l₂ norm of the nodal external forces or, if they vanish,
/// of the reactions at the constrained degrees of freedom. Once the residual is below the
/// tolerance, or below 1e-4, where rounding errors may keep it, the increment that the last
/// tangent gives for it estimates the error of the displacement that is left; when that is below
/// the tolerance, it is added, and the state has converged. An increment of the last tangent that
/// is a hundredth of the one before is taken in place of one of a new tangent. It is tried at
/// residuals below the same bound, and below 1e-2 where the last increment was at most a tenth of
/// the one before.
class Newton {
 public:
  Newton(const SolidSpace& space, dealii::AffineConstraints<double> constraints,
         SolverKind solver = SolverKind::automatic);
  Newton(const Newton&) = delete;
  Newton& operator=(const Newton&) = delete;

  /// Solves from the given state, which must satisfy the Dirichlet conditions; it holds the last
  /// iterate at the end, converged or not.
  NewtonResult solve(const ExternalForces& external, SolidState& state,
                     const NewtonOptions& options, const NewtonProgress& progress = {});

  /// Solves for the amplitude of the force too, by the bordered tangent (fem/solid/border.h).
  NewtonResult solve(UnknownForce& force, SolidState& state, const NewtonOptions& options,
                     const NewtonProgress& progress = {});

 private:
  struct Step {
    dealii::Vector<double> increment;
    double amplitude = 0;  ///< increment of the unknown force's, if there is one
    int linear_iterations = 0;
    double size() const { return increment.linfty_norm(); }
  };
  Step last_tangents_step(const SolidState& state, const dealii::Vector<double>& residual,
                          Border* border);
  Step own_tangents_step(const ExternalForces& external, const SolidState& state,
                         const InternalForces& internal, const dealii::Vector<double>& residual,
                         bool first, Border* border);
  NewtonResult iterate(const ExternalForces& external, Border* border, SolidState& state,
                       const NewtonOptions& options, const NewtonProgress& progress);

  const SolidSpace& space_;
  dealii::AffineConstraints<double> constraints_;
  dealii::SparsityPattern sparsity_;
  dealii::SparseMatrix<double> matrix_;
  std::unique_ptr<LinearSolver> solver_;
  std::vector<std::size_t> cells_;  ///< those that this rank assembles
  double size_;                     ///< diameter of the body, m
};

}  // namespace ciliaval::fem
