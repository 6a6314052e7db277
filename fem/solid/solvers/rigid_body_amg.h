// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <deal.II/base/index_set.h>
#include <deal.II/lac/trilinos_precondition.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <span>
#include <vector>

#include "fem/solid/discretisation/vector.h"
#include "problem/types.h"

namespace ciliaval::fem::solid::solvers {

/// A few iterations of the conjugate gradient method with smoothed aggregation (Trilinos's ML) for
/// an elastic solid's matrix, whose near null space are the six rigid motions. Iterations, for the
/// aggregates damp the change of volume of near-incompressible material slowly; conjugate
/// gradients, for they minimise the energy, where GMRES's residual is that of the change of volume
/// alone and takes the solver around it twice the iterations. That solver must be flexible.
class RigidBodyAmg {
 public:
  /// `own` are this rank's rows, three for each of its nodes, which lie at `positions`; `fixed`
  /// says which of the rows are constrained.
  RigidBodyAmg(const dealii::IndexSet& own, std::span<const Vector3> positions,
               const std::vector<bool>& fixed, MPI_Comm communicator);

  /// The matrix, to be given its pattern once and its values before each update().
  dealii::TrilinosWrappers::SparseMatrix& matrix() { return matrix_; }
  /// After compress(): makes the aggregates' matrices. Throws SolverError.
  void update();
  /// x ≈ A⁻¹ b. Collective.
  void vmult(discretisation::Vector& x, const discretisation::Vector& b) const;

 private:
  dealii::TrilinosWrappers::SparseMatrix matrix_;
  std::vector<double> motions_;  ///< six vectors of the own rows, one after the other
  dealii::TrilinosWrappers::PreconditionAMG amg_;
};

}  // namespace ciliaval::fem::solid::solvers
