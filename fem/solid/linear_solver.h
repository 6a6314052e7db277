// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/sparse_matrix.h>
#include <deal.II/lac/sparsity_pattern.h>
#include <deal.II/lac/vector.h>

#include <memory>

#include "fem/parallel.h"
#include "fem/solid/direct_solver.h"
#include "fem/solid/multigrid.h"
#include "fem/solid/solver_kind.h"
#include "fem/solid/space.h"

namespace ciliaval::fem {

/// Unknowns beyond which `automatic` is `iterative` (measured: docs/solid.md).
inline constexpr dealii::types::global_dof_index direct_unknowns = 30000;

/// Solves systems with the solid's tangent, which may be unsymmetric: by sparse LU (MUMPS), or by
/// GMRES preconditioned from the right by one multigrid cycle. Vectors are whole on every rank, the
/// work is shared by rows. All functions are collective and throw SolverError on failure, the same
/// on all ranks.
class LinearSolver {
 public:
  /// The pattern must outlive it. The constraints may only set unknowns to zero.
  LinearSolver(const SolidSpace& space, const dealii::AffineConstraints<double>& constraints,
               const dealii::SparsityPattern& pattern, SolverKind kind);

  bool iterative() const { return multigrid_ != nullptr; }

  /// This rank's rows: the only ones in which the matrix must be complete. The cells that have a
  /// degree of freedom among them are those that it needs.
  const RowRange& rows() const { return rows_; }

  /// Factorises, or prepares the preconditioner. The matrix must stay as it is until the next call.
  void prepare(const dealii::SparseMatrix<double>& matrix);

  /// Any number of right-hand sides with the matrix last prepared. `reduction` is what GMRES
  /// reduces the residual by (‖b − Ax‖₂ ≤ reduction ‖b‖₂); the direct solver ignores it. Returns
  /// the number of iterations.
  int solve(const dealii::Vector<double>& rhs, dealii::Vector<double>& solution,
            double reduction) const;

 private:
  RowRange rows_;
  const dealii::SparseMatrix<double>* matrix_ = nullptr;
  std::unique_ptr<DirectSolver> direct_;
  std::unique_ptr<Multigrid> multigrid_;
};

}  // namespace ciliaval::fem
