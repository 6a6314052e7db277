// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <deal.II/base/parallel.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/vector.h>

#include <cstdint>
#include <span>
#include <vector>

#include "fem/parallel.h"
#include "fem/solid/discretisation/space.h"
#include "fem/solid/discretisation/tangent_matrix.h"
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

/// This rank's rows of the tangent, in blocks of 3 × 3, the unknowns of a node: one column index
/// serves nine values. Constrained rows are those of the identity.
///
/// The rows of all nodes of the cells at the rank's rows are kept, complete in the rank's own ones,
/// so that VertexPatchSchwarz has its patches.
///
/// Single precision would halve its memory and take up to 1.3 times the iterations at ν = 0.49: it
/// rounds forces of K times the whole displacement, which bending balances.
class BlockCsr : public discretisation::TangentMatrix {
 public:
  using Node = std::uint32_t;

  /// The rows of whole nodes. The constraints, which may only set unknowns to zero, must outlive
  /// it. Throws SolverError if the unknowns of a node do not stand together.
  BlockCsr(const discretisation::SolidSpace& space,
           const dealii::AffineConstraints<double>& constraints, RowRange rows,
           MPI_Comm communicator);

  void clear();
  using TangentMatrix::add;
  void add(const dealii::FullMatrix<double>& local, discretisation::Dofs rows,
           discretisation::Dofs columns) override;

  /// y = A x; vectors whole on every rank. Collective.
  void vmult(dealii::Vector<double>& y, const dealii::Vector<double>& x) const;

  /// The nodes of the columns of a kept node's rows, ascending.
  std::span<const Node> columns(Node node) const;
  /// The block at a position of columns(node).
  Matrix3 block(Node node, std::size_t position) const;

 private:
  std::size_t index(Node node) const { return node - kept_.begin / node_unknowns; }
  void make_pattern(const discretisation::SolidSpace& space);

  const dealii::AffineConstraints<double>& constraints_;
  RowRange rows_;
  RowRange kept_;
  MPI_Comm communicator_;
  std::vector<std::size_t> starts_;  ///< of the nodes' blocks
  std::vector<Node> nodes_;          ///< of the blocks' columns, ascending for each node
  std::vector<double> values_;       ///< of the blocks, each row by row
};

}  // namespace ciliaval::fem::solid::solvers
