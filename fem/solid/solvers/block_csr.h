// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <deal.II/base/parallel.h>
#include <deal.II/lac/sparse_matrix.h>
#include <deal.II/lac/sparsity_pattern.h>
#include <deal.II/lac/vector.h>

#include <cstdint>
#include <vector>

#include "fem/parallel.h"

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

/// Block CSR of this rank's rows of a matrix, with blocks of 3 × 3, the unknowns of a node: one
/// column index serves nine values. Single precision reads 4.4 bytes a value, the matrix itself 12.
template <typename Number>
class BlockCsr {
 public:
  /// The rows of whole nodes.
  BlockCsr(RowRange rows, MPI_Comm communicator) : rows_(rows), communicator_(communicator) {}
  /// The matrix must be complete in these rows, its pattern always the same. Throws SolverError if
  /// the pattern does not couple whole nodes.
  void update(const dealii::SparseMatrix<double>& matrix);
  /// y = A x; vectors whole on every rank. Collective.
  void vmult(dealii::Vector<double>& y, const dealii::Vector<double>& x) const;

 private:
  void make_pattern(const dealii::SparsityPattern& pattern);

  RowRange rows_;
  MPI_Comm communicator_;
  std::vector<std::size_t> starts_;   ///< of the nodes' blocks
  std::vector<std::uint32_t> nodes_;  ///< of the blocks' columns, ascending for each node
  std::vector<Number> values_;        ///< of the blocks, each row by row
};

extern template class BlockCsr<float>;
extern template class BlockCsr<double>;

}  // namespace ciliaval::fem::solid::solvers
