// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <deal.II/base/partitioner.h>
#include <deal.II/lac/sparse_matrix.h>
#include <deal.II/lac/sparsity_pattern.h>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "fem/solid/discretisation/space.h"
#include "fem/solid/discretisation/vector.h"
#include "fem/solid/solvers/block_csr.h"
#include "fem/solid/solvers/direct_solver.h"
#include "fem/solid/solvers/rigid_body_amg.h"
#include "fem/solid/solvers/vertex_patch_schwarz.h"

namespace ciliaval::fem::solid::solvers {

/// Two levels: a Chebyshev iteration over vertex-patch Schwarz on the Q2 space, before and after;
/// the Galerkin matrix PᵀAP on the trilinear functions of the same mesh, P the inclusion, up to
/// 100,000 unknowns factorised, beyond solved roughly by RigidBodyAmg.
class Multigrid {
 public:
  /// The matrix, whose present values the smoother takes, must outlive it. Collective, as all its
  /// functions.
  Multigrid(const discretisation::SolidSpace& space, const CellNodes& cells,
            const BlockCsr& matrix);

  /// The patches and the coarse matrix of the present values. Throws SolverError.
  void update();

  /// One cycle from zero.
  void vmult(discretisation::Vector& x, const discretisation::Vector& b) const;

 private:
  /// A vertex, by this rank's numbers of the vertices, and the value of its function at a node.
  struct Weight {
    Node vertex = 0;
    float value = 0;
  };
  std::span<const Weight> weights(Node node) const {
    return std::span(weights_).subspan(weight_starts_[node],
                                       weight_starts_[node + 1] - weight_starts_[node]);
  }
  /// Vertex at each node, or `none`. First come those whose nodes this rank owns.
  std::vector<Node> number_vertices(const discretisation::SolidSpace& space,
                                    const CellNodes& cells);
  void make_weights(const CellNodes& cells, std::span<const Node> vertex_at);
  void make_coarse_level(const discretisation::SolidSpace& space, const CellNodes& cells,
                         std::span<const Node> vertex_at);
  void make_coarse_direct(MPI_Comm communicator);
  void make_coarse_amg(const discretisation::SolidSpace& space, const CellNodes& coarse_cells);
  void add_galerkin_rows(Node node);
  /// Calls visit(row, columns) for each row of the vertices that this rank has.
  void for_coarse_rows(const auto& visit) const;
  /// Calls add(row, columns, values) with this rank's share of each row.
  void for_coarse_values(const auto& add) const;
  void solve_coarse(discretisation::Vector& x, const discretisation::Vector& b) const;
  void smooth(discretisation::Vector& x, const discretisation::Vector& b, bool from_zero) const;
  void correct(discretisation::Vector& x, const discretisation::Vector& b) const;
  void residual(discretisation::Vector& r, const discretisation::Vector& x,
                const discretisation::Vector& b) const;

  const BlockCsr& matrix_;
  Node own_nodes_;
  VertexPatchSchwarz schwarz_;
  std::vector<std::uint32_t> weight_starts_;
  std::vector<Weight> weights_;  ///< of P, node by node
  std::shared_ptr<const dealii::Utilities::MPI::Partitioner> coarse_unknowns_;
  std::unique_ptr<BlockCsr> coarse_blocks_;  ///< this rank's share of PᵀAP
  std::unique_ptr<RigidBodyAmg> coarse_amg_;
  // Or, whole on every rank:
  dealii::SparsityPattern coarse_pattern_;
  dealii::SparseMatrix<double> coarse_matrix_;
  std::unique_ptr<DirectSolver> coarse_direct_;
  std::vector<Matrix3> sums_;  ///< a row of A P, by vertices
  std::vector<Node> touched_;  ///< those that are in it
  std::vector<bool> is_touched_;
};

}  // namespace ciliaval::fem::solid::solvers
