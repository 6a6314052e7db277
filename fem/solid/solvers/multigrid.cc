// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/solvers/multigrid.h"

#include <deal.II/base/mpi.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/sparsity_tools.h>
#include <deal.II/lac/trilinos_sparsity_pattern.h>

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "fem/parallel.h"
#include "fem/solid/discretisation/row_range.h"
#include "problem/support/interruption.h"

namespace ciliaval::fem::solid::solvers {
using namespace discretisation;
namespace {

using dealii::types::global_dof_index;

/// Chebyshev iteration: polynomial degree, and the part of the spectrum that it damps, from the
/// largest eigenvalue down (docs/theory/solid.md).
constexpr int smoother_degree = 3;
constexpr double smoother_range = 25;
constexpr double safety = 1.05;  ///< tangents of compressed cells are not quite positive

/// Rows of the coarse matrix up to which it is factorised (docs/theory/solid.md).
constexpr global_dof_index direct_rows = 100000;

constexpr Node none = std::numeric_limits<Node>::max();

}  // namespace

Multigrid::Multigrid(const SolidSpace& space, const CellNodes& cells, const BlockCsr& matrix)
    : matrix_(matrix),
      own_nodes_(space.partitioner().locally_owned_size() / static_cast<Node>(node_unknowns)),
      schwarz_(space, cells, matrix, own_nodes_) {
  const std::vector<Node> vertex_at = number_vertices(space, cells);
  make_weights(cells, vertex_at);
  make_coarse_level(space, cells, vertex_at);
}

std::vector<Node> Multigrid::number_vertices(const SolidSpace& space, const CellNodes& cells) {
  std::vector<Node> vertex_at(matrix_.nodes(), none);
  for (std::size_t cell = 0; cell < cells.cells(); ++cell)
    for (std::size_t c = 0; c < corners; ++c) vertex_at[cells.of(cell)[corner_node(c)]] = 0;
  Node count = 0;
  Node own = 0;
  for (Node node = 0; node < vertex_at.size(); ++node) {
    if (vertex_at[node] != none) vertex_at[node] = count++;
    if (node + 1 == own_nodes_) own = count;
  }
  // Their unknowns' numbers on all ranks: each rank tells the others by a vector of the nodes.
  const auto unknowns = static_cast<global_dof_index>(node_unknowns);
  global_dof_index before = 0;
  global_dof_index size = 0;
  const auto counts =
      dealii::Utilities::MPI::all_gather(space.communicator(), unknowns * global_dof_index{own});
  for (std::size_t r = 0; r < counts.size(); ++r) {
    if (r == static_cast<std::size_t>(rank(space.communicator()))) before = size;
    size += counts[r];
  }
  Vector numbers = space.vector();
  for (Node node = 0; node < own_nodes_; ++node)
    if (vertex_at[node] != none)
      numbers.local_element(static_cast<unsigned int>(unknowns * node)) =
          before + unknowns * vertex_at[node];
  numbers.update_ghost_values();
  std::vector<std::pair<global_dof_index, Node>> of_others;
  for (Node node = own_nodes_; node < vertex_at.size(); ++node)
    if (vertex_at[node] != none)
      of_others.emplace_back(static_cast<global_dof_index>(
                                 numbers.local_element(static_cast<unsigned int>(unknowns * node))),
                             node);
  std::ranges::sort(of_others);
  dealii::IndexSet owned(size);
  owned.add_range(before, before + unknowns * own);
  dealii::IndexSet ghosts(size);
  Node next = own;
  for (const auto& [first, node] : of_others) {
    ghosts.add_range(first, first + unknowns);
    vertex_at[node] = next++;
  }
  coarse_unknowns_ = std::make_shared<const dealii::Utilities::MPI::Partitioner>(
      owned, ghosts, space.communicator());
  return vertex_at;
}

void Multigrid::make_weights(const CellNodes& cells, std::span<const Node> vertex_at) {
  std::vector<std::array<std::uint32_t, 2>> from(matrix_.nodes());  // a cell, and the place in it
  for (std::uint32_t cell = 0; cell < cells.cells(); ++cell)
    for (std::uint32_t a = 0; a < element_nodes; ++a) from[cells.of(cell)[a]] = {cell, a};
  weight_starts_.push_back(0);
  for (const auto& [cell, a] : from) {
    for (std::size_t c = 0; c < corners; ++c)
      if (const double value = trilinear(c, a); value > 0)
        weights_.push_back({vertex_at[cells.of(cell)[corner_node(c)]], static_cast<float>(value)});
    weight_starts_.push_back(static_cast<std::uint32_t>(weights_.size()));
  }
}

void Multigrid::make_coarse_level(const SolidSpace& space, const CellNodes& cells,
                                  std::span<const Node> vertex_at) {
  const std::size_t n = node_unknowns;
  const std::size_t vertices =
      (coarse_unknowns_->locally_owned_size() + coarse_unknowns_->n_ghost_indices()) / n;
  CellNodes coarse_cells{corners};
  for (std::size_t cell = 0; cell < cells.cells(); ++cell)
    for (std::size_t c = 0; c < corners; ++c)
      coarse_cells.nodes.push_back(vertex_at[cells.of(cell)[corner_node(c)]]);
  std::vector<bool> constrained(n * vertices);
  for (Node node = 0; node < vertex_at.size(); ++node)
    for (std::size_t k = 0; k < n && vertex_at[node] != none; ++k)
      constrained[n * vertex_at[node] + k] = matrix_.is_constrained(n * node + k);
  coarse_blocks_ = std::make_unique<BlockCsr>(coarse_cells, std::move(constrained));
  sums_.assign(vertices, Matrix3::Zero());
  is_touched_.assign(vertices, false);

  if (coarse_unknowns_->size() <= direct_rows)
    make_coarse_direct(space.communicator());
  else
    make_coarse_amg(space, coarse_cells);
}

void Multigrid::for_coarse_rows(const auto& visit) const {
  const auto n = static_cast<unsigned int>(node_unknowns);
  std::vector<global_dof_index> columns;
  for (Node vertex = 0; vertex < coarse_blocks_->nodes(); ++vertex) {
    columns.clear();
    for (const Node other : coarse_blocks_->columns(vertex))
      for (unsigned int k = 0; k < n; ++k)
        columns.push_back(coarse_unknowns_->local_to_global(n * other + k));
    for (unsigned int k = 0; k < n; ++k) visit(n * vertex + k, columns);
  }
}

void Multigrid::for_coarse_values(const auto& add) const {
  std::vector<double> values;
  for_coarse_rows([&](unsigned int row, const std::vector<global_dof_index>& columns) {
    // The identity of a constrained row is its owner's.
    if (row >= coarse_unknowns_->locally_owned_size() && coarse_blocks_->is_constrained(row))
      return;
    const auto vertex = static_cast<Node>(row / node_unknowns);
    const auto k = static_cast<Eigen::Index>(row % node_unknowns);
    values.clear();
    for (std::size_t i = 0; i < columns.size() / node_unknowns; ++i) {
      const Matrix3 block = coarse_blocks_->block(vertex, i);
      values.insert(values.end(), {block(k, 0), block(k, 1), block(k, 2)});
    }
    add(coarse_unknowns_->local_to_global(row), columns, values);
  });
}

void Multigrid::make_coarse_direct(MPI_Comm communicator) {
  dealii::DynamicSparsityPattern pattern(coarse_unknowns_->size());
  RowRange rows{coarse_unknowns_->size(), 0};
  for_coarse_rows([&](unsigned int local, const std::vector<global_dof_index>& columns) {
    const global_dof_index row = coarse_unknowns_->local_to_global(local);
    pattern.add_entries(row, columns.begin(), columns.end());
    rows = {std::min(rows.begin, row), std::max(rows.end, row + 1)};
  });
  dealii::SparsityTools::gather_sparsity_pattern(
      pattern, coarse_unknowns_->locally_owned_range(), communicator,
      dealii::complete_index_set(coarse_unknowns_->size()));
  coarse_pattern_.copy_from(pattern);
  coarse_matrix_.reinit(coarse_pattern_);
  coarse_direct_ = std::make_unique<DirectSolver>(
      coarse_pattern_, DirectSolver::Kind::symmetric_part, rows, communicator);
}

void Multigrid::make_coarse_amg(const SolidSpace& space, const CellNodes& coarse_cells) {
  const std::size_t rows = coarse_unknowns_->locally_owned_size();
  std::vector<Vector3> positions(rows / node_unknowns);
  for (std::size_t e = 0; e < coarse_cells.cells(); ++e)
    for (std::size_t c = 0; c < corners; ++c)
      if (const Node vertex = coarse_cells.of(e)[c]; vertex < positions.size())
        positions[vertex] =
            space.elements()[e].nodes.row(static_cast<Eigen::Index>(corner_node(c))).transpose();
  std::vector<bool> fixed(rows);
  for (std::size_t i = 0; i < rows; ++i) fixed[i] = coarse_blocks_->is_constrained(i);
  coarse_amg_ = std::make_unique<RigidBodyAmg>(coarse_unknowns_->locally_owned_range(), positions,
                                               fixed, space.communicator());
  dealii::TrilinosWrappers::SparsityPattern pattern(coarse_unknowns_->locally_owned_range(),
                                                    space.communicator());
  for_coarse_rows([&](unsigned int row, const std::vector<global_dof_index>& columns) {
    pattern.add_entries(coarse_unknowns_->local_to_global(row), columns.begin(), columns.end());
  });
  pattern.compress();
  coarse_amg_->matrix().reinit(pattern);
}

void Multigrid::add_galerkin_rows(Node node) {
  const auto free_part = [](const BlockCsr& matrix, Node row, Node column, Matrix3 block) {
    for (std::size_t k = 0; k < node_unknowns; ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      if (matrix.is_constrained(node_unknowns * row + k)) block.row(i).setZero();
      if (matrix.is_constrained(node_unknowns * column + k)) block.col(i).setZero();
    }
    return block;
  };
  touched_.clear();
  const std::span neighbours = matrix_.columns(node);
  for (std::size_t position = 0; position < neighbours.size(); ++position) {
    const Matrix3 block =
        free_part(matrix_, node, neighbours[position], matrix_.block(node, position));
    for (const auto& [vertex, value] : weights(neighbours[position])) {
      if (!is_touched_[vertex]) {
        is_touched_[vertex] = true;
        touched_.push_back(vertex);
        sums_[vertex].setZero();
      }
      sums_[vertex] += static_cast<double>(value) * block;
    }
  }
  std::ranges::sort(touched_);
  for (const auto& [row, value] : weights(node)) {
    const std::span columns = coarse_blocks_->columns(row);
    std::size_t position = 0;
    for (const Node column : touched_) {
      while (columns[position] < column) ++position;
      coarse_blocks_->add(
          row, position,
          free_part(*coarse_blocks_, row, column, static_cast<double>(value) * sums_[column]));
    }
  }
  for (const Node vertex : touched_) is_touched_[vertex] = false;
}

void Multigrid::update() {
  support::check_interruption();
  schwarz_.update(matrix_);
  support::check_interruption();
  coarse_blocks_->clear();
  for (Node node = 0; node < own_nodes_; ++node) add_galerkin_rows(node);
  const auto fill = [this](auto& matrix) {
    matrix = 0.;
    for_coarse_values([&matrix](global_dof_index row, const auto& columns, const auto& values) {
      matrix.add(row, static_cast<global_dof_index>(columns.size()), columns.data(), values.data(),
                 false);
    });
  };
  if (coarse_direct_) {
    fill(coarse_matrix_);
    coarse_direct_->factorize(coarse_matrix_);
  } else {
    fill(coarse_amg_->matrix());
    coarse_amg_->matrix().compress(dealii::VectorOperation::add);
    coarse_amg_->update();
  }
}

void Multigrid::solve_coarse(Vector& x, const Vector& b) const {
  if (coarse_amg_) return coarse_amg_->vmult(x, b);
  const auto first = static_cast<std::ptrdiff_t>(coarse_unknowns_->local_range().first);
  Vector whole(coarse_unknowns_->size());
  std::copy(b.begin(), b.end(), whole.begin() + first);
  sum_over_ranks(x.get_mpi_communicator(), {whole.begin(), whole.locally_owned_size()});
  Vector solution;
  coarse_direct_->solve(whole, solution);
  std::copy_n(solution.begin() + first, x.locally_owned_size(), x.begin());
}

void Multigrid::residual(Vector& r, const Vector& x, const Vector& b) const {
  support::check_interruption();
  matrix_.vmult(r, x);
  r.sadd(-1, 1, b);
}

void Multigrid::smooth(Vector& x, const Vector& b, bool from_zero) const {
  // Chebyshev iteration on [lower, upper]: Saad, Iterative Methods for Sparse Linear Systems, 2nd
  // ed., algorithm 12.1.
  constexpr double upper = safety * VertexPatchSchwarz::largest_eigenvalue;
  constexpr double lower = upper / smoother_range;
  constexpr double centre = (upper + lower) / 2;
  constexpr double half_width = (upper - lower) / 2;
  constexpr double sigma = centre / half_width;
  Vector r(b);
  Vector z;
  z.reinit(b, true);
  if (!from_zero) residual(r, x, b);
  schwarz_.vmult(z, r);
  Vector step(z);
  step /= centre;
  x += step;
  double rho = 1 / sigma;
  for (int k = 1; k < smoother_degree; ++k) {
    residual(r, x, b);
    schwarz_.vmult(z, r);
    const double next = 1 / (2 * sigma - rho);
    step.sadd(rho * next, 2 * next / half_width, z);
    rho = next;
    x += step;
  }
}

void Multigrid::correct(Vector& x, const Vector& b) const {
  Vector r;
  r.reinit(b, true);
  residual(r, x, b);
  Vector coarse_residual(coarse_unknowns_);
  Vector correction(coarse_unknowns_);
  const auto for_weights = [this](const auto& visit) {
    const auto n = static_cast<unsigned int>(node_unknowns);
    for (Node node = 0; node < own_nodes_; ++node)
      for (unsigned int k = 0; k < n; ++k) {
        if (matrix_.is_constrained(n * node + k)) continue;
        for (const auto& [vertex, value] : weights(node))
          if (!coarse_blocks_->is_constrained(n * vertex + k))
            visit(n * node + k, n * vertex + k, static_cast<double>(value));
      }
  };
  for_weights([&](unsigned int fine, unsigned int coarse, double weight) {
    coarse_residual.local_element(coarse) += weight * r.local_element(fine);
  });
  coarse_residual.compress(dealii::VectorOperation::add);
  solve_coarse(correction, coarse_residual);
  correction.update_ghost_values();
  for_weights([&](unsigned int fine, unsigned int coarse, double weight) {
    x.local_element(fine) += weight * correction.local_element(coarse);
  });
}

void Multigrid::vmult(Vector& x, const Vector& b) const {
  x = 0.;
  smooth(x, b, true);
  correct(x, b);
  smooth(x, b, false);
}

}  // namespace ciliaval::fem::solid::solvers
