// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <deal.II/lac/sparse_matrix.h>
#include <deal.II/lac/sparsity_pattern.h>

#include <memory>

#include "fem/solid/discretisation/row_range.h"
#include "fem/solid/discretisation/vector.h"

namespace ciliaval::fem::solid::solvers {

/// Sparse LU, or LDLᵀ of the symmetric part, by MUMPS, on all ranks of the communicator. The
/// symbolic factorisation is made once. Vectors are whole on every rank. All functions are
/// collective, and throw SolverError on all ranks or on none.
class DirectSolver {
 public:
  enum class Kind {
    general,        ///< A = LU
    symmetric_part  ///< (A + Aᵀ)/2 = LDLᵀ: half the work and memory
  };
  /// Each rank gives the rows `rows` of its matrix; equal rows add up. The pattern must be
  /// symmetric and couple whole nodes (node_unknowns). Starts MPI if need be.
  DirectSolver(const dealii::SparsityPattern& pattern, Kind kind, discretisation::RowRange rows,
               MPI_Comm communicator);
  ~DirectSolver();
  DirectSolver(const DirectSolver&) = delete;
  DirectSolver& operator=(const DirectSolver&) = delete;

  /// Throws if the matrix is singular or the memory does not suffice.
  void factorize(const dealii::SparseMatrix<double>& matrix);

  /// Number of negative eigenvalues of the symmetric part (Sylvester's law of inertia).
  int negative_eigenvalues() const;

  /// Throws if the solution is not finite.
  void solve(const discretisation::Vector& rhs, discretisation::Vector& solution) const;

 private:
  struct Mumps;
  void analyse(const dealii::SparsityPattern& pattern);

  Kind kind_;
  discretisation::RowRange rows_;
  MPI_Comm communicator_;
  std::unique_ptr<Mumps> mumps_;
};

}  // namespace ciliaval::fem::solid::solvers
