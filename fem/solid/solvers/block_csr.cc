// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/solvers/block_csr.h"

#include <deal.II/base/exceptions.h>

#include <algorithm>
#include <array>
#include <utility>

#include "fem/solid/discretisation/row_range.h"
#include "problem/error.h"

namespace ciliaval::fem::solid::solvers {
using namespace discretisation;
namespace {

constexpr std::size_t n = node_unknowns;

/// The nodes of unknowns, each once, and which of them each belongs to.
struct Nodes {
  std::vector<Node> nodes{};
  std::vector<std::size_t> of{};

  explicit Nodes(Dofs dofs) {
    for (const auto dof : dofs) nodes.push_back(static_cast<Node>(dof / n));
    std::ranges::sort(nodes);
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    for (const auto dof : dofs)
      of.push_back(
          static_cast<std::size_t>(std::ranges::lower_bound(nodes, dof / n) - nodes.begin()));
  }
};

}  // namespace

CellNodes element_cell_nodes(const SolidSpace& space) {
  CellNodes result{element_nodes};
  for (const SolidElement& element : space.elements())
    for (std::size_t a = 0; a < element_nodes; ++a) {
      const auto dof = element.dofs[a];
      if (dof % n != 0 || element.dofs[element_nodes + a] != dof + 1 ||
          element.dofs[2 * element_nodes + a] != dof + 2)
        throw SolverError("the unknowns of the solid's nodes do not stand together");
      result.nodes.push_back(static_cast<Node>(dof / n));
    }
  return result;
}

std::vector<bool> constrained_unknowns(const SolidSpace& space,
                                       const dealii::AffineConstraints<double>& constraints) {
  const auto& partitioner = space.partitioner();
  std::vector<bool> result(partitioner.locally_owned_size() + partitioner.n_ghost_indices());
  for (std::size_t i = 0; i < result.size(); ++i)
    result[i] =
        constraints.is_constrained(partitioner.local_to_global(static_cast<unsigned int>(i)));
  return result;
}

BlockCsr::BlockCsr(const CellNodes& cells, std::vector<bool> constrained)
    : constrained_(std::move(constrained)) {
  const std::size_t count = constrained_.size() / n;
  std::vector<std::size_t> ends(count + 1);
  for (const Node node : cells.nodes) ends[node + 1] += cells.nodes_per_cell;
  for (std::size_t i = 0; i < count; ++i) ends[i + 1] += ends[i];
  std::vector<Node> neighbours(ends.back());
  std::vector<std::size_t> next(ends.begin(), ends.end() - 1);
  for (std::size_t cell = 0; cell < cells.cells(); ++cell)
    for (const Node node : cells.of(cell))
      for (const Node other : cells.of(cell)) neighbours[next[node]++] = other;
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
  for (std::size_t row = 0; row < constrained_.size(); ++row) {
    if (!constrained_[row]) continue;
    const auto node = static_cast<Node>(row / n);
    const auto place = std::ranges::lower_bound(columns(node), node) - columns(node).begin();
    values_[n * n * (starts_[node] + static_cast<std::size_t>(place)) + (n + 1) * (row % n)] = 1;
  }
}

void BlockCsr::add(const dealii::FullMatrix<double>& local, Dofs rows, Dofs columns) {
  const Nodes row_nodes(rows);
  const Nodes column_nodes(columns);
  // Index of the block for each pair of nodes.
  std::vector<std::size_t> blocks(row_nodes.nodes.size() * column_nodes.nodes.size());
  for (std::size_t i = 0; i < row_nodes.nodes.size(); ++i) {
    std::size_t block = starts_[row_nodes.nodes[i]];
    for (std::size_t j = 0; j < column_nodes.nodes.size(); ++j) {
      while (nodes_[block] < column_nodes.nodes[j]) ++block;
      Assert(nodes_[block] == column_nodes.nodes[j], dealii::ExcInternalError());
      blocks[i * column_nodes.nodes.size() + j] = block;
    }
  }
  std::vector<bool> is_free;
  for (const auto dof : columns) is_free.push_back(!constrained_[dof]);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (constrained_[rows[i]]) continue;
    const std::size_t k = rows[i] % n;
    const std::size_t* const row = blocks.data() + row_nodes.of[i] * column_nodes.nodes.size();
    for (std::size_t j = 0; j < columns.size(); ++j) {
      if (!is_free[j]) continue;
      values_[n * (n * row[column_nodes.of[j]] + k) + columns[j] % n] +=
          local(static_cast<unsigned int>(i), static_cast<unsigned int>(j));
    }
  }
}

void BlockCsr::add(Node node, std::size_t position, const Matrix3& block) {
  Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(
      values_.data() + n * n * (starts_[node] + position)) += block;
}

Matrix3 BlockCsr::block(Node node, std::size_t position) const {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(
      values_.data() + n * n * (starts_[node] + position));
}

void BlockCsr::vmult(Vector& y, const Vector& x) const {
  x.update_ghost_values();
  const double* const X = x.begin();
  double* const Y = y.begin();
  for_each(y.locally_owned_size() / n, 64, [&](std::size_t node) {
    // Nine sums, so that no addition waits for another.
    std::array<double, n * n> sums{};
    for (std::size_t block = starts_[node]; block < starts_[node + 1]; ++block) {
      const double* const value = values_.data() + n * n * block;
      const double* const at = X + n * std::size_t{nodes_[block]};
      for (std::size_t k = 0; k < n; ++k)
        for (std::size_t l = 0; l < n; ++l) sums[n * k + l] += value[n * k + l] * at[l];
    }
    for (std::size_t k = 0; k < n; ++k)
      Y[n * node + k] = sums[n * k] + sums[n * k + 1] + sums[n * k + 2];
  });
  x.zero_out_ghost_values();
}

}  // namespace ciliaval::fem::solid::solvers
