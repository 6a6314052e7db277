// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/solvers/block_csr.h"

#include <deal.II/base/exceptions.h>

#include <algorithm>
#include <array>

#include "problem/error.h"

namespace ciliaval::fem::solid::solvers {
using namespace discretisation;
namespace {

constexpr std::size_t n = node_unknowns;

/// The nodes of degrees of freedom, each once, and which of them each belongs to.
struct Nodes {
  std::vector<BlockCsr::Node> nodes{};
  std::vector<std::size_t> of{};

  explicit Nodes(Dofs dofs) {
    for (const auto dof : dofs) nodes.push_back(static_cast<BlockCsr::Node>(dof / n));
    std::ranges::sort(nodes);
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    for (const auto dof : dofs)
      of.push_back(
          static_cast<std::size_t>(std::ranges::lower_bound(nodes, dof / n) - nodes.begin()));
  }
};

}  // namespace

BlockCsr::BlockCsr(const SolidSpace& space, const dealii::AffineConstraints<double>& constraints,
                   RowRange rows, MPI_Comm communicator)
    : constraints_(constraints), rows_(rows), kept_(rows), communicator_(communicator) {
  make_pattern(space);
}

void BlockCsr::make_pattern(const SolidSpace& space) {
  const auto require = [](bool holds) {
    if (!holds) throw SolverError("the unknowns of the solid's nodes do not stand together");
  };
  require(rows_.begin % n == 0 && rows_.end % n == 0);
  for (const SolidElement& element : space.elements()) {
    const auto [first, last] = std::ranges::minmax(element.dofs);
    if (!std::ranges::any_of(element.dofs, [this](Row dof) { return rows_.contains(dof); }))
      continue;
    kept_.begin = std::min(kept_.begin, first);
    kept_.end = std::max(kept_.end, last + 1);
  }
  const std::size_t count = (kept_.end - kept_.begin) / n;
  const auto for_kept_nodes = [&](const auto& visit) {
    for (const SolidElement& element : space.elements())
      for (std::size_t a = 0; a < element_nodes; ++a) {
        const auto dof = element.dofs[a];
        require(dof % n == 0 && element.dofs[element_nodes + a] == dof + 1 &&
                element.dofs[2 * element_nodes + a] == dof + 2);
        if (kept_.contains(dof)) visit(index(static_cast<Node>(dof / n)), element);
      }
  };
  std::vector<std::size_t> ends(count + 1);
  for_kept_nodes([&](std::size_t node, const SolidElement&) { ends[node + 1] += element_nodes; });
  for (std::size_t i = 0; i < count; ++i) ends[i + 1] += ends[i];
  std::vector<Node> neighbours(ends.back());
  std::vector<std::size_t> next(ends.begin(), ends.end() - 1);
  for_kept_nodes([&](std::size_t node, const SolidElement& element) {
    for (std::size_t b = 0; b < element_nodes; ++b)
      neighbours[next[node]++] = static_cast<Node>(element.dofs[b] / n);
  });
  starts_.push_back(0);
  for (std::size_t i = 0; i < count; ++i) {
    const auto begin = neighbours.begin() + static_cast<std::ptrdiff_t>(ends[i]);
    const auto end = neighbours.begin() + static_cast<std::ptrdiff_t>(ends[i + 1]);
    std::sort(begin, end);
    starts_.push_back(starts_.back() + static_cast<std::size_t>(std::unique(begin, end) - begin));
  }
  nodes_.reserve(starts_.back());
  for (std::size_t i = 0; i < count; ++i) {
    const auto begin = neighbours.begin() + static_cast<std::ptrdiff_t>(ends[i]);
    nodes_.insert(nodes_.end(), begin,
                  begin + static_cast<std::ptrdiff_t>(starts_[i + 1] - starts_[i]));
  }
  values_.resize(n * n * nodes_.size());
}

void BlockCsr::clear() {
  std::ranges::fill(values_, 0.0);
  for (Row row = kept_.begin; row < kept_.end; ++row) {
    if (!constraints_.is_constrained(row)) continue;
    const auto node = static_cast<Node>(row / n);
    const auto place = std::ranges::lower_bound(columns(node), node) - columns(node).begin();
    values_[n * n * (starts_[index(node)] + static_cast<std::size_t>(place)) +
            (n + 1) * (row % n)] = 1;
  }
}

void BlockCsr::add(const dealii::FullMatrix<double>& local, Dofs rows, Dofs columns) {
  const Nodes row_nodes(rows);
  const Nodes column_nodes(columns);
  std::vector<bool> is_free;
  for (const auto dof : columns) is_free.push_back(!constraints_.is_constrained(dof));
  // Of each pair of nodes the block.
  std::vector<std::size_t> blocks(row_nodes.nodes.size() * column_nodes.nodes.size());
  for (std::size_t i = 0; i < row_nodes.nodes.size(); ++i) {
    const Node node = row_nodes.nodes[i];
    if (!kept_.contains(n * Row{node})) continue;
    std::size_t block = starts_[index(node)];
    for (std::size_t j = 0; j < column_nodes.nodes.size(); ++j) {
      while (nodes_[block] < column_nodes.nodes[j]) ++block;
      Assert(nodes_[block] == column_nodes.nodes[j], dealii::ExcInternalError());
      blocks[i * column_nodes.nodes.size() + j] = block;
    }
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!kept_.contains(rows[i]) || constraints_.is_constrained(rows[i])) continue;
    const std::size_t k = rows[i] % n;
    const std::size_t* const row = blocks.data() + row_nodes.of[i] * column_nodes.nodes.size();
    for (std::size_t j = 0; j < columns.size(); ++j) {
      if (!is_free[j]) continue;
      values_[n * (n * row[column_nodes.of[j]] + k) + columns[j] % n] +=
          local(static_cast<unsigned int>(i), static_cast<unsigned int>(j));
    }
  }
}

std::span<const BlockCsr::Node> BlockCsr::columns(Node node) const {
  return std::span(nodes_).subspan(starts_[index(node)],
                                   starts_[index(node) + 1] - starts_[index(node)]);
}

Matrix3 BlockCsr::block(Node node, std::size_t position) const {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(
      values_.data() + n * n * (starts_[index(node)] + position));
}

void BlockCsr::vmult(dealii::Vector<double>& y, const dealii::Vector<double>& x) const {
  const double* const X = x.begin();
  y.reinit(x.size(), true);
  const std::size_t before = (rows_.begin - kept_.begin) / n;
  for_each((rows_.end - rows_.begin) / n, 64, [&](std::size_t own) {
    const std::size_t i = before + own;
    // Nine sums, so that no addition waits for another.
    std::array<double, n * n> sums{};
    for (std::size_t block = starts_[i]; block < starts_[i + 1]; ++block) {
      const double* const value = values_.data() + n * n * block;
      const double* const at = X + n * std::size_t{nodes_[block]};
      for (std::size_t k = 0; k < n; ++k)
        for (std::size_t l = 0; l < n; ++l) sums[n * k + l] += value[n * k + l] * at[l];
    }
    for (std::size_t k = 0; k < n; ++k)
      y[rows_.begin + static_cast<Row>(n * own + k)] =
          sums[n * k] + sums[n * k + 1] + sums[n * k + 2];
  });
  gather_over_ranks(communicator_, {y.begin(), y.size()});
}

}  // namespace ciliaval::fem::solid::solvers
