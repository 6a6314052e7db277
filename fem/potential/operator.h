// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <deal.II/base/subscriptor.h>
#include <deal.II/lac/diagonal_matrix.h>
#include <deal.II/lac/precondition.h>
#include <deal.II/lac/trilinos_precondition.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <Eigen/Core>
#include <unordered_map>

#include "fem/potential/cut_cells.h"
#include "fem/potential/space.h"

namespace ciliaval::fem::potential {

/// a(ψ, φ) = ∫ μ_r ∇ψ·∇φ of the free nodes, without a matrix: in vacuum a leaf's matrix is its edge
/// times the unit cube's; a leaf that a permeable body meets has a matrix of its own in addition.
class PotentialOperator : public dealii::Subscriptor {
 public:
  using value_type = double;
  using size_type = dealii::types::global_dof_index;

  PotentialOperator(const PotentialSpace& space, const CutCells& bodies);

  const PotentialSpace& space() const { return space_; }
  size_type m() const { return space_.dofs().n_dofs(); }
  /// Not there: there is no matrix. deal.II's Chebyshev iteration names it without calling it.
  static double el(size_type i, size_type j);

  void vmult(PotentialVector& result, const PotentialVector& free) const;
  void Tvmult(PotentialVector& result, const PotentialVector& free) const { vmult(result, free); }
  /// a(ψ, φ_i) of a complete ψ for the free nodes i.
  PotentialVector apply_complete(const PotentialVector& complete) const;
  /// 1/d with the diagonal d, up to the couplings between hanging nodes; 0 where no node is free.
  PotentialVector inverse_diagonal() const;
  /// A leaf's matrix, m.
  Eigen::MatrixXd cell_matrix(int cell) const;
  /// S u of a leaf with its bodies' part S of the matrix alone; the leaf must have one.
  Eigen::VectorXd bodies_part(int cell, const Eigen::Ref<const Eigen::VectorXd>& u) const;
  /// uᵀ A u of a leaf for values u at its nodes, without the bodies' part.
  double energy(int cell, const Eigen::Ref<const Eigen::VectorXd>& u) const;

 private:
  template <typename Read>
  void apply(PotentialVector& result, const Read& read) const;

  const PotentialSpace& space_;
  Eigen::MatrixXd unit_;
  std::unordered_map<int, Eigen::MatrixXd> bodies_;  ///< of the leaves that a body meets
};

/// One V-cycle of two levels for a PotentialOperator: Chebyshev's iteration on its degree, and one
/// cycle of smoothed aggregation (ML) on the trilinear elements of the same octree. The transfer is
/// ours: MGTwoLevelTransfer of deal.II 9.4 refuses locally refined meshes.
class PotentialMultigrid {
 public:
  /// The algebraic multigrid of the trilinear elements, shared by the degrees above.
  class Coarse {
   public:
    Coarse(const Octree& octree, const CutCells& bodies);

   private:
    friend class PotentialMultigrid;
    PotentialSpace space_;
    dealii::TrilinosWrappers::SparseMatrix matrix_;
    dealii::TrilinosWrappers::PreconditionAMG amg_;
  };

  PotentialMultigrid(const PotentialOperator& fine, const Coarse& coarse);
  void vmult(PotentialVector& x, const PotentialVector& b) const;

 private:
  void add_prolonged(PotentialVector& fine, const PotentialVector& coarse) const;
  void add_restricted(PotentialVector& coarse, const PotentialVector& fine) const;

  using Smoother = dealii::PreconditionChebyshev<PotentialOperator, PotentialVector,
                                                 dealii::DiagonalMatrix<PotentialVector>>;
  const PotentialOperator& fine_;
  const Coarse& coarse_;
  Smoother smoother_;
  Eigen::MatrixXd embedding_;  ///< of a leaf's trilinear functions
  mutable PotentialVector residual_;
  mutable PotentialVector coarse_residual_;
  mutable PotentialVector coarse_solution_;
};

/// Solves A x = b for the free nodes by conjugate gradients from the x given, to |b − A x| ≤
/// tolerance·|b|. Returns the number of iterations. Throws SolverError after 200.
unsigned int solve(const PotentialOperator& A, const PotentialMultigrid& preconditioner,
                   const PotentialVector& b, double tolerance, PotentialVector& x);

}  // namespace ciliaval::fem::potential
