// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/sparse_matrix.h>
#include <deal.II/lac/sparsity_pattern.h>
#include <deal.II/lac/vector.h>

#include <memory>
#include <optional>

#include "fem/parallel.h"
#include "fem/solid/solvers/direct_solver.h"
#include "fem/solid/multigrid.h"
#include "fem/solid/solvers/solver_kind.h"
#include "fem/solid/discretisation/space.h"

namespace ciliaval::fem {

/// Unknowns beyond which `automatic` is `iterative` (measured: docs/solid.md).
inline constexpr dealii::types::global_dof_index direct_unknowns = 100000;

/// What `automatic` is for this number of unknowns; any other kind as it is.
SolverKind chosen(SolverKind kind, dealii::types::global_dof_index unknowns);

/// Solves systems with the solid's tangent, which may be unsymmetric: by sparse LU (MUMPS), or by
/// GMRES preconditioned from the right by one multigrid cycle. Vectors are whole on every rank, the
/// work is shared by rows. All functions are collective and throw SolverError on failure, the same
/// on all ranks.
class LinearSolver {
 public:
  /// The pattern must outlive it. The constraints may only set unknowns to zero.
  LinearSolver(const SolidSpace& space, const dealii::AffineConstraints<double>& constraints,
               const dealii::SparsityPattern& pattern, SolverKind kind);

  /// This rank's rows: the only ones in which the matrix must be complete. The cells that have a
  /// degree of freedom among them are those that it needs.
  const RowRange& rows() const { return rows_; }

  /// Factorises, or prepares the multigrid. The matrix must stay as it is until the next call. One
  /// that is near the last, as in an iteration of Newton's method, is solved by GMRES with the
  /// factors or the multigrid of that one, as long as it converges fast.
  void prepare(const dealii::SparseMatrix<double>& matrix, bool near_last = false);

  /// Any number of right-hand sides with the matrix last prepared. `reduction` is what GMRES
  /// reduces the residual by (‖b − Ax‖₂ ≤ reduction ‖b‖₂). Returns the number of iterations; 1 for
  /// the matrix's own LU.
  int solve(const dealii::Vector<double>& rhs, dealii::Vector<double>& solution, double reduction);

 private:
  void update();
  /// Empty if GMRES does not get there in max_iterations.
  std::optional<int> gmres(const dealii::Vector<double>& rhs, dealii::Vector<double>& solution,
                           double reduction, unsigned int max_iterations) const;

  RowRange rows_;
  const dealii::SparseMatrix<double>* matrix_ = nullptr;
  OwnRows<double> own_;  ///< of the matrix, on several ranks
  std::unique_ptr<DirectSolver> direct_;
  std::unique_ptr<Multigrid> multigrid_;
  bool current_ = false;    ///< factors or multigrid are those of the matrix
  unsigned int usual_ = 0;  ///< iterations that the multigrid took with its own matrix
};

}  // namespace ciliaval::fem
