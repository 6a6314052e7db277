// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/sparse_matrix.h>
#include <deal.II/lac/sparsity_pattern.h>
#include <deal.II/lac/vector.h>

#include <cstdint>
#include <memory>
#include <vector>

#include "fem/parallel.h"
#include "fem/solid/solvers/direct_solver.h"
#include "fem/solid/discretisation/space.h"

namespace ciliaval::fem {

/// A copy of this rank's own rows of a matrix, in blocks of 3 × 3: the unknowns of a node stand
/// together and are coupled with those of the same nodes, so that one column is kept for nine
/// values. In single precision, for a preconditioner, that is 4.4 bytes a value to read, of the
/// matrix itself 12.
template <typename Number>
class OwnRows {
 public:
  /// The rows of whole nodes.
  explicit OwnRows(RowRange rows) : rows_(rows) {}
  /// The matrix must be complete in the own rows, and its pattern always the same. Throws
  /// SolverError if the pattern is not one of nodes.
  void update(const dealii::SparseMatrix<double>& matrix);
  /// y = A x; vectors whole on every rank. Collective.
  void vmult(dealii::Vector<double>& y, const dealii::Vector<double>& x) const;

 private:
  void make_pattern(const dealii::SparsityPattern& pattern);

  RowRange rows_;
  std::vector<std::size_t> starts_;   ///< of the nodes' blocks
  std::vector<std::uint32_t> nodes_;  ///< of the blocks' columns, ascending for each node
  std::vector<Number> values_;        ///< of the blocks, each row by row
};

extern template class OwnRows<float>;
extern template class OwnRows<double>;

/// The additive Schwarz method on vertex stars. The star of a vertex holds the nodes inside the
/// cells around it (27 for an inner vertex of Q2: its own, those of its edges, faces and cells),
/// and there the matrix is inverted exactly. A star is large enough to hold displacements that keep
/// the volume, so that the method does not slow down with K/μ (Schöberl, Numer. Math. 84, 1999).
/// Every cell meets eight stars: the preconditioned matrix, if it is positive definite, has no
/// eigenvalue beyond 8.
class VertexStars {
 public:
  static constexpr double largest_eigenvalue = 8;

  VertexStars(const SolidSpace& space, const dealii::AffineConstraints<double>& constraints,
              RowRange rows);
  /// Inverts the matrix on the stars of the vertices whose first row is own; single precision.
  void update(const dealii::SparseMatrix<double>& matrix);
  /// z = Σ Rᵀ A⁻¹ R r over the stars of all ranks. Collective.
  void vmult(dealii::Vector<double>& z, const dealii::Vector<double>& r) const;

 private:
  using Index = std::uint32_t;
  std::vector<std::size_t> starts_;         ///< of the stars' entries in dofs_
  std::vector<Index> dofs_;                 ///< of all stars, one after the other
  std::vector<std::size_t> matrix_starts_;  ///< of the stars' matrices in inverses_
  std::vector<float> inverses_;             ///< column by column
  std::vector<std::size_t> user_starts_;    ///< for each degree of freedom: its entries in users_
  std::vector<std::size_t> users_;          ///< positions in dofs_
  mutable std::vector<float> corrections_;  ///< of all stars
};

/// Two levels: on the Q2 space a Chebyshev iteration over the vertex stars before and after, on the
/// trilinear functions of the same mesh the Galerkin matrix PᵀAP, factorised. P is the inclusion.
class Multigrid {
 public:
  /// The pattern of the coarse matrix follows from the cells. `rows` are this rank's.
  Multigrid(const SolidSpace& space, const dealii::AffineConstraints<double>& constraints,
            RowRange rows);

  /// For a matrix that is complete in the own rows. Throws SolverError.
  void update(const dealii::SparseMatrix<double>& matrix);

  /// One cycle from zero. Collective.
  void vmult(dealii::Vector<double>& x, const dealii::Vector<double>& b) const;

 private:
  struct Weight {
    dealii::types::global_dof_index column = 0;
    double value = 0;
  };
  void make_prolongation(const SolidSpace& space,
                         const dealii::AffineConstraints<double>& constraints);
  /// Those that the own rows of the matrix add to, and on rank 0 the fixed ones.
  RowRange own_coarse_rows() const;
  void add_coarse_row(const dealii::SparseMatrix<double>& matrix, Row row);
  void smooth(dealii::Vector<double>& x, const dealii::Vector<double>& b, bool from_zero) const;
  void correct(dealii::Vector<double>& x, const dealii::Vector<double>& b) const;
  void residual(dealii::Vector<double>& r, const dealii::Vector<double>& x,
                const dealii::Vector<double>& b) const;

  RowRange rows_;
  VertexStars stars_;
  OwnRows<float> matrix_;
  std::vector<std::size_t> prolongation_starts_;
  std::vector<Weight> prolongation_;  ///< row by row
  std::vector<Row> fixed_;            ///< coarse degrees of freedom that are constrained
  dealii::SparsityPattern coarse_pattern_;
  dealii::SparseMatrix<double> coarse_matrix_;
  std::unique_ptr<DirectSolver> coarse_solver_;
  std::vector<double> work_;  ///< a row of A P
};

}  // namespace ciliaval::fem
