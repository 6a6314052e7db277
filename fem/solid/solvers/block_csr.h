// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <deal.II/base/parallel.h>
#include <deal.II/lac/affine_constraints.h>

#include <cstdint>
#include <span>
#include <vector>

#include "fem/solid/discretisation/space.h"
#include "fem/solid/discretisation/tangent_matrix.h"
#include "fem/solid/discretisation/vector.h"
#include "problem/types.h"

namespace ciliaval::fem::solid::solvers {

/// work(i) for i < count, in threads that take at least `grain` of them at once.
void for_each(std::size_t count, std::size_t grain, const auto& work) {
  dealii::parallel::apply_to_subranges(
      std::size_t{0}, count,
      [&work](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) work(i);
      },
      static_cast<unsigned int>(grain));
}

/// Nodes by this rank's numbers: its own ones, then those that other ranks own.
using Node = std::uint32_t;

/// The nodes of each of a list of cells.
struct CellNodes {
  std::size_t nodes_per_cell = 0;
  std::vector<Node> nodes{};  ///< cell after cell
  std::span<const Node> of(std::size_t cell) const {
    return std::span(nodes).subspan(cell * nodes_per_cell, nodes_per_cell);
  }
  std::size_t cells() const { return nodes.size() / nodes_per_cell; }
};

/// Nodes of a space's elements, in their order. Throws SolverError if the unknowns of a node do not
/// stand together.
CellNodes element_cell_nodes(const discretisation::SolidSpace& space);

/// True for each constrained one among this rank's unknowns and its ghosts.
std::vector<bool> constrained_unknowns(const discretisation::SolidSpace& space,
                                       const dealii::AffineConstraints<double>& constraints);

/// The rows of a rank's nodes in blocks of 3 × 3, the unknowns of a node: one column index serves
/// nine values. Constrained rows are those of the identity. The rows of nodes that other ranks own
/// are complete where all cells around the node are this rank's.
///
/// Single precision would halve its memory and take up to 1.3 times the iterations at ν = 0.49: it
/// rounds forces of K times the whole displacement, which bending balances.
class BlockCsr : public discretisation::TangentMatrix {
 public:
  /// Couples the nodes of each cell.
  BlockCsr(const CellNodes& cells, std::vector<bool> constrained);

  /// Zero; the identity in constrained rows.
  void clear();
  using TangentMatrix::add;
  void add(const dealii::FullMatrix<double>& local, discretisation::Dofs rows,
           discretisation::Dofs columns) override;
  /// Adds a block at a position of columns(node); constrained rows and columns must be zero in it.
  void add(Node node, std::size_t position, const Matrix3& block);

  /// y = A x. Collective.
  void vmult(discretisation::Vector& y, const discretisation::Vector& x) const;

  std::size_t nodes() const { return starts_.size() - 1; }
  bool is_constrained(std::size_t unknown) const { return constrained_[unknown]; }
  /// The nodes of the columns of a node's rows, ascending.
  std::span<const Node> columns(Node node) const {
    return std::span(nodes_).subspan(starts_[node], starts_[node + 1] - starts_[node]);
  }
  /// The block at a position of columns(node).
  Matrix3 block(Node node, std::size_t position) const;

 private:
  std::vector<bool> constrained_;
  std::vector<std::size_t> starts_;  ///< of the nodes' blocks
  std::vector<Node> nodes_;          ///< of the blocks' columns, ascending for each node
  std::vector<double> values_;       ///< of the blocks, each row by row
};

}  // namespace ciliaval::fem::solid::solvers
