// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <deal.II/base/partitioner.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/la_parallel_vector.h>

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "fem/potential/octree.h"
#include "problem/lagrange.h"

namespace ciliaval::fem::potential {

/// A vector of nodal values over all ranks.
using PotentialVector = dealii::LinearAlgebra::distributed::Vector<double>;

/// Continuous Lagrange elements of a degree on an octree, nodes at Gauss–Lobatto points, first
/// index fastest in a cell. *Free* nodes neither hang nor lie on the outer boundary; a vector of
/// free nodes is zero at the others, a *complete* vector holds their values too.
class PotentialSpace {
 public:
  PotentialSpace(const Octree& octree, unsigned int degree);

  const Octree& octree() const { return octree_; }
  const LagrangeBasis& basis() const { return basis_; }  ///< on [0, 1]
  unsigned int degree() const { return degree_; }
  /// Nodes of a cell, (degree+1)³.
  Eigen::Index nodes() const { return nodes_; }
  std::size_t unknowns() const { return dofs_.n_dofs(); }
  const dealii::DoFHandler<3>& dofs() const { return dofs_; }
  /// Hanging nodes, and zero on the boundary.
  const dealii::AffineConstraints<double>& constraints() const { return constraints_; }

  /// Each own free node belongs to one of its leaves here.
  struct Assigned {
    unsigned int row;   ///< node of the leaf
    unsigned int node;  ///< local index in a vector
  };
  std::span<const Assigned> assigned(int cell) const {
    const auto c = static_cast<std::size_t>(cell);
    return std::span(assigned_).subspan(assigned_start_[c],
                                        assigned_start_[c + 1] - assigned_start_[c]);
  }

  /// A vector of zeros with room for the neighbours' values.
  PotentialVector vector() const;

  /// Values of a complete vector at the nodes of a cell.
  void read(int cell, const PotentialVector& complete, Eigen::Ref<Eigen::VectorXd> u) const;
  /// The same of a vector of free nodes.
  void read_free(int cell, const PotentialVector& free, Eigen::Ref<Eigen::VectorXd> u) const;
  /// The transpose: adds a cell's residuals to the free nodes'.
  void add_free(int cell, const Eigen::Ref<const Eigen::VectorXd>& r, PotentialVector& free) const;

  /// The function's values (A) on the outer boundary, zero at the nodes within; complete.
  PotentialVector boundary_values(const std::function<double(const Vector3&)>& psi) const;
  /// Sets the values of hanging nodes and of other ranks' nodes. Collective.
  void complete(PotentialVector& v) const;

  /// Adds each cell's share of the squares of the diagonal: Σ_i d_i |∂u_i/∂free|².
  void add_diagonal(int cell, const Eigen::Ref<const Eigen::VectorXd>& d,
                    PotentialVector& free) const;

  /// Sets a complete vector's values at the nodes of a cell, this rank's own.
  void write(int cell, const Eigen::Ref<const Eigen::VectorXd>& u, PotentialVector& complete) const;

 private:
  struct Entry {
    unsigned int node;  ///< local index in a vector
    unsigned int row;   ///< node of the cell
    double weight;
  };
  void assign_nodes();
  std::span<const unsigned int> own_nodes(int cell) const {
    return std::span(local_).subspan(static_cast<std::size_t>(cell * nodes_),
                                     static_cast<std::size_t>(nodes_));
  }

  const Octree& octree_;
  unsigned int degree_;
  Eigen::Index nodes_;
  LagrangeBasis basis_;
  dealii::DoFHandler<3> dofs_;
  dealii::AffineConstraints<double> hanging_;
  dealii::AffineConstraints<double> constraints_;
  std::shared_ptr<const dealii::Utilities::MPI::Partitioner> partitioner_;
  std::vector<unsigned int> local_;         ///< nodes of each cell
  std::vector<std::size_t> entries_start_;  ///< of each cell with constrained nodes
  std::vector<Entry> entries_;
  std::vector<std::size_t> assigned_start_;
  std::vector<Assigned> assigned_;
};

/// Values at a point of [0, 1]³ of the tensor-product basis, first index fastest.
Eigen::VectorXd shape_values(const LagrangeBasis& basis, const Vector3& unit);
/// Gradients there, one row for each node, per unit of the unit cell.
Eigen::Matrix<double, Eigen::Dynamic, 3> shape_gradients(const LagrangeBasis& basis,
                                                         const Vector3& unit);
/// Values of one basis' functions (columns) at the nodes of another (rows).
Eigen::MatrixXd interpolation(const LagrangeBasis& from, const LagrangeBasis& to);
/// ∫ ∇φ_i·∇φ_j on the unit cube.
Eigen::MatrixXd unit_stiffness(const LagrangeBasis& basis);

}  // namespace ciliaval::fem::potential
