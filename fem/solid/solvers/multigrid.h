// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/sparse_matrix.h>
#include <deal.II/lac/sparsity_pattern.h>
#include <deal.II/lac/vector.h>

#include <memory>
#include <vector>

#include "fem/parallel.h"
#include "fem/solid/discretisation/space.h"
#include "fem/solid/solvers/block_csr.h"
#include "fem/solid/solvers/direct_solver.h"
#include "fem/solid/solvers/vertex_patch_schwarz.h"

namespace ciliaval::fem::solid::solvers {

/// Two levels: a Chebyshev iteration over vertex-patch Schwarz on the Q2 space, before and after;
/// the factorised Galerkin matrix PᵀAP on the trilinear functions of the same mesh, P the
/// inclusion.
class Multigrid {
 public:
  /// The pattern of the coarse matrix follows from the cells. `rows` are this rank's. The matrix,
  /// whose present values the smoother takes, must outlive it.
  Multigrid(const discretisation::SolidSpace& space,
            const dealii::AffineConstraints<double>& constraints, const BlockCsr& matrix,
            RowRange rows, MPI_Comm communicator);

  /// The patches and the coarse matrix of the present values. Throws SolverError.
  void update();

  /// One cycle from zero. Collective.
  void vmult(dealii::Vector<double>& x, const dealii::Vector<double>& b) const;

 private:
  struct Weight {
    dealii::types::global_dof_index column = 0;
    double value = 0;
  };
  void make_prolongation(const discretisation::SolidSpace& space,
                         const dealii::AffineConstraints<double>& constraints);
  /// The coarse rows that this rank adds to; on rank 0 also the constrained ones.
  RowRange own_coarse_rows() const;
  void add_coarse_rows(BlockCsr::Node node);
  void smooth(dealii::Vector<double>& x, const dealii::Vector<double>& b, bool from_zero) const;
  void correct(dealii::Vector<double>& x, const dealii::Vector<double>& b) const;
  void residual(dealii::Vector<double>& r, const dealii::Vector<double>& x,
                const dealii::Vector<double>& b) const;

  const BlockCsr& matrix_;
  RowRange rows_;
  MPI_Comm communicator_;
  VertexPatchSchwarz schwarz_;
  std::vector<std::size_t> prolongation_starts_;
  std::vector<Weight> prolongation_;  ///< row by row
  std::vector<Row> fixed_;            ///< coarse degrees of freedom that are constrained
  dealii::SparsityPattern coarse_pattern_;
  dealii::SparseMatrix<double> coarse_matrix_;
  std::unique_ptr<DirectSolver> coarse_solver_;
  std::vector<double> work_;  ///< a row of A P
};

}  // namespace ciliaval::fem::solid::solvers
