// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <deal.II/lac/sparse_matrix.h>
#include <deal.II/lac/sparsity_pattern.h>
#include <deal.II/lac/vector.h>

#include <memory>

#include "fem/parallel.h"

namespace ciliaval::fem {

/// Sparse LU, or LDLᵀ of the symmetric part, by MUMPS (through PETSc), on all ranks. The symbolic
/// factorisation is made once. Vectors are whole on every rank. All functions are collective.
class DirectSolver {
 public:
  enum class Kind {
    general,        ///< A = LU
    symmetric_part  ///< (A + Aᵀ)/2 = LDLᵀ: half the work and memory
  };
  /// The pattern must be symmetric. Starts MPI if need be.
  DirectSolver(const dealii::SparsityPattern& pattern, Kind kind);
  ~DirectSolver();
  DirectSolver(const DirectSolver&) = delete;
  DirectSolver& operator=(const DirectSolver&) = delete;

  /// Factorises the sum over the ranks of the rows `rows` of their matrices. Throws SolverError if
  /// it is singular or the memory does not suffice.
  void factorize(const dealii::SparseMatrix<double>& matrix, RowRange rows);

  /// Throws SolverError if the solution is not finite.
  void solve(const dealii::Vector<double>& rhs, dealii::Vector<double>& solution) const;

 private:
  struct Handles;
  Kind kind_;
  std::unique_ptr<Handles> handles_;
};

}  // namespace ciliaval::fem
