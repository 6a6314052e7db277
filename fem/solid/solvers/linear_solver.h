// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/sparse_matrix.h>
#include <deal.II/lac/sparsity_pattern.h>

#include <memory>
#include <optional>
#include <vector>

#include "fem/solid/discretisation/row_range.h"
#include "fem/solid/discretisation/space.h"
#include "fem/solid/discretisation/tangent_matrix.h"
#include "fem/solid/solvers/block_csr.h"
#include "fem/solid/solvers/direct_solver.h"
#include "fem/solid/solvers/multigrid.h"
#include "fem/solid/solvers/solver_kind.h"

namespace ciliaval::fem::solid::solvers {

/// True if systems of so many unknowns are solved iteratively.
bool is_iterative(SolverKind kind, double unknowns);

/// Solves systems with the solid's unsymmetric tangent: by sparse LU (MUMPS), or by GMRES
/// preconditioned from the right by one multigrid cycle. It keeps the tangent as it needs it. The
/// direct one needs a space that is whole on every rank, and the ranks of the communicator share
/// its rows; the iterative one works on the space's parts. All functions are collective and throw
/// SolverError on all ranks.
class LinearSolver {
 public:
  /// The constraints may only set unknowns to zero; they and the space must outlive it.
  LinearSolver(const discretisation::SolidSpace& space,
               const dealii::AffineConstraints<double>& constraints, SolverKind kind,
               MPI_Comm communicator);

  LinearSolver(const LinearSolver&) = delete;
  LinearSolver& operator=(const LinearSolver&) = delete;

  bool is_direct() const { return direct_ != nullptr; }
  /// The elements that this rank has to assemble.
  const std::vector<std::size_t>& cells() const { return cells_; }

  /// Zeros, to be assembled.
  discretisation::TangentMatrix& new_tangent();
  /// After the assembly: factorises, or prepares the multigrid.
  void prepare();
  /// For a tangent near the last one, as in an iteration of Newton's method: its factors or its
  /// patches precondition GMRES, as long as that converges fast.
  void prepare_near_last();

  /// Any number of right-hand sides with the matrix last prepared. GMRES ends with
  /// ‖b − Ax‖₂ ≤ reduction ‖b‖₂. Returns the number of iterations, with those
  /// of patches that were given up; 1 for the matrix's own LU.
  int solve(const discretisation::Vector& rhs, discretisation::Vector& solution, double reduction);

  // Functions of the direct solver:
  /// Sparsity pattern of its matrix, and this rank's rows of it.
  const dealii::SparsityPattern& pattern() const { return pattern_; }
  const discretisation::RowRange& rows() const { return rows_; }

 private:
  /// From the solution given. Empty if GMRES does not get there in max_iterations; the solution is
  /// then what it came to.
  std::optional<int> gmres(const discretisation::Vector& rhs, discretisation::Vector& solution,
                           double reduction, unsigned int max_iterations) const;

  MPI_Comm communicator_;
  discretisation::RowRange rows_;
  std::vector<std::size_t> cells_;
  // The direct one's.
  dealii::SparsityPattern pattern_;
  dealii::SparseMatrix<double> matrix_;
  std::unique_ptr<discretisation::AssembledTangent> assembled_;
  std::unique_ptr<DirectSolver> direct_;
  // The iterative one's.
  std::unique_ptr<BlockCsr> blocks_;
  std::unique_ptr<Multigrid> multigrid_;
  bool is_prepared_ = false;
  bool current_ = false;    ///< factors or multigrid belong to the matrix
  unsigned int usual_ = 0;  ///< most iterations that the multigrid took with its own matrix
};

}  // namespace ciliaval::fem::solid::solvers
