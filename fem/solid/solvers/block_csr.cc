// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/solvers/block_csr.h"

#include <algorithm>
#include <array>

#include "problem/error.h"

namespace ciliaval::fem::solid::solvers {

template <typename Number>
void BlockCsr<Number>::make_pattern(const dealii::SparsityPattern& pattern) {
  const auto require = [](bool holds) {
    if (!holds) throw SolverError("the unknowns of the solid's nodes do not stand together");
  };
  require(rows_.begin % node_unknowns == 0 && rows_.end % node_unknowns == 0);
  starts_.push_back(0);
  for (Row row = rows_.begin; row < rows_.end; row += node_unknowns) {
    for (auto entry = pattern.begin(row); entry != pattern.end(row); ++entry)
      if (entry->column() % node_unknowns == 0)
        nodes_.push_back(static_cast<std::uint32_t>(entry->column() / node_unknowns));
    std::sort(nodes_.begin() + static_cast<std::ptrdiff_t>(starts_.back()), nodes_.end());
    // All rows of the node have the columns of these nodes and no others.
    for (Row k = 0; k < node_unknowns; ++k) {
      require(pattern.row_length(row + k) == node_unknowns * (nodes_.size() - starts_.back()));
      std::size_t block = starts_.back();
      for (auto entry = pattern.begin(row + k); entry != pattern.end(row + k); ++entry) {
        if (entry->column() == row + k) continue;
        while (block < nodes_.size() && nodes_[block] < entry->column() / node_unknowns) ++block;
        require(block < nodes_.size() && nodes_[block] == entry->column() / node_unknowns);
      }
    }
    starts_.push_back(nodes_.size());
  }
  values_.resize(node_unknowns * node_unknowns * nodes_.size());
}

template <typename Number>
void BlockCsr<Number>::update(const dealii::SparseMatrix<double>& matrix) {
  if (starts_.empty()) make_pattern(matrix.get_sparsity_pattern());
  for_each(starts_.size() - 1, 64, [&](std::size_t i) {
    const Row first = rows_.begin + static_cast<Row>(node_unknowns * i);
    const auto own = static_cast<std::size_t>(
        std::lower_bound(nodes_.begin() + static_cast<std::ptrdiff_t>(starts_[i]),
                         nodes_.begin() + static_cast<std::ptrdiff_t>(starts_[i + 1]),
                         first / node_unknowns) -
        nodes_.begin());
    for (Row k = 0; k < node_unknowns; ++k) {
      // deal.II stores the diagonal first, then the columns in order.
      std::size_t block = starts_[i];
      for (auto entry = matrix.begin(first + k); entry != matrix.end(first + k); ++entry) {
        const bool diagonal = entry->column() == first + k;
        while (!diagonal && nodes_[block] != entry->column() / node_unknowns) ++block;
        const std::size_t at = diagonal ? own : block;
        values_[node_unknowns * (node_unknowns * at + k) + entry->column() % node_unknowns] =
            static_cast<Number>(entry->value());
      }
    }
  });
}

template <typename Number>
void BlockCsr<Number>::vmult(dealii::Vector<double>& y, const dealii::Vector<double>& x) const {
  const double* const X = x.begin();
  for_each(starts_.size() - 1, 64, [&](std::size_t i) {
    // Nine sums, so that no addition waits for another.
    std::array<double, node_unknowns * node_unknowns> sums{};
    for (std::size_t block = starts_[i]; block < starts_[i + 1]; ++block) {
      const Number* const value = values_.data() + node_unknowns * node_unknowns * block;
      const double* const at = X + std::size_t{node_unknowns} * nodes_[block];
      for (std::size_t k = 0; k < node_unknowns; ++k)
        for (std::size_t l = 0; l < node_unknowns; ++l)
          sums[node_unknowns * k + l] += static_cast<double>(value[node_unknowns * k + l]) * at[l];
    }
    for (std::size_t k = 0; k < node_unknowns; ++k)
      y[rows_.begin + static_cast<Row>(node_unknowns * i + k)] =
          sums[node_unknowns * k] + sums[node_unknowns * k + 1] + sums[node_unknowns * k + 2];
  });
  gather_over_ranks(communicator_, {y.begin(), y.size()});
}

template class BlockCsr<float>;
template class BlockCsr<double>;

}  // namespace ciliaval::fem::solid::solvers
