// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/sparse_matrix.h>
#include <deal.II/lac/sparsity_pattern.h>
#include <deal.II/lac/vector.h>

#include <memory>
#include <optional>

#include "fem/parallel.h"
#include "fem/solid/discretisation/space.h"
#include "fem/solid/solvers/direct_solver.h"
#include "fem/solid/solvers/multigrid.h"
#include "fem/solid/solvers/solver_kind.h"

namespace ciliaval::fem::solid::solvers {

/// Solves systems with the solid's unsymmetric tangent: by sparse LU (MUMPS), or by GMRES
/// preconditioned from the right by one multigrid cycle. Vectors are whole on every rank; the ranks
/// share the work by rows. All functions are collective and throw SolverError on all ranks.
class LinearSolver {
 public:
  /// The pattern must outlive it. The constraints may only set unknowns to zero.
  LinearSolver(const discretisation::SolidSpace& space,
               const dealii::AffineConstraints<double>& constraints,
               const dealii::SparsityPattern& pattern, SolverKind kind, MPI_Comm communicator);

  /// This rank's rows: the only ones in which the matrix must be complete. The cells that have a
  /// degree of freedom among them must be assembled.
  const RowRange& rows() const { return rows_; }
  bool is_direct() const { return direct_ != nullptr; }

  /// Factorises, or prepares the multigrid. The matrix must stay as it is until the next call.
  void prepare(const dealii::SparseMatrix<double>& matrix);
  /// For a matrix near the last one, as in an iteration of Newton's method: its factors or its
  /// multigrid precondition GMRES, as long as that converges fast.
  void prepare_near_last(const dealii::SparseMatrix<double>& matrix);

  /// Any number of right-hand sides with the matrix last prepared. GMRES ends with
  /// ‖b − Ax‖₂ ≤ reduction ‖b‖₂. Returns the number of iterations; 1 for the matrix's own LU.
  int solve(const dealii::Vector<double>& rhs, dealii::Vector<double>& solution, double reduction);

 private:
  void take(const dealii::SparseMatrix<double>& matrix);
  void update();
  /// Empty if GMRES does not get there in max_iterations.
  std::optional<int> gmres(const dealii::Vector<double>& rhs, dealii::Vector<double>& solution,
                           double reduction, unsigned int max_iterations) const;

  MPI_Comm communicator_;
  RowRange rows_;
  const dealii::SparseMatrix<double>* matrix_ = nullptr;
  BlockCsr<double> own_;  ///< this rank's rows of the matrix, on several ranks
  std::unique_ptr<DirectSolver> direct_;
  std::unique_ptr<Multigrid> multigrid_;
  bool current_ = false;    ///< factors or multigrid belong to the matrix
  unsigned int usual_ = 0;  ///< iterations that the multigrid took with its own matrix
};

}  // namespace ciliaval::fem::solid::solvers
