// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/solvers/vertex_patch_schwarz.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstdlib>
#include <span>
#include <tuple>

#include "fem/solid/discretisation/row_range.h"
#include "fem/solid/solvers/symmetric_inverse.h"

namespace ciliaval::fem::solid::solvers {
using namespace discretisation;
namespace {

/// Lexicographic coordinates 0 … 2 of a node of the element.
std::array<int, 3> coordinates(std::size_t node) {
  const int i = static_cast<int>(node);
  return {i % 3, i / 3 % 3, i / 9};
}

/// Edges shorter than this part of the cell's longest direction join the vertices at their ends.
constexpr double thin = 0.25;
/// Vertices of a patch at most: 567 unknowns, if they stand in a line.
constexpr std::size_t most_vertices = 10;

/// An edge between two vertices that this rank owns.
struct Edge {
  double thinness = 0;  ///< its length over that of the cell's longest direction
  Node a = 0;
  Node b = 0;
};

/// The thin edges of all cells, the thinnest first.
std::vector<Edge> thin_edges(const SolidSpace& space, const CellNodes& cells, Node own_nodes) {
  std::vector<Edge> result;
  for (std::size_t cell = 0; cell < cells.cells(); ++cell) {
    const auto position = [&](std::size_t corner) -> Vector3 {
      return space.elements()[cell].nodes.row(static_cast<Eigen::Index>(corner_node(corner)));
    };
    std::array<double, 3> lengths{};  // of a direction the mean of its four edges
    const auto for_edges = [](std::size_t direction, const auto& visit) {
      for (std::size_t c = 0; c < corners; ++c)
        if (const std::size_t step = std::size_t{1} << direction; (c & step) == 0)
          visit(c, c + step);
    };
    for (std::size_t d = 0; d < lengths.size(); ++d)
      for_edges(d, [&](std::size_t c, std::size_t e) {
        lengths.at(d) += 0.25 * (position(e) - position(c)).norm();
      });
    for (std::size_t d = 0; d < lengths.size(); ++d) {
      const double thinness = lengths.at(d) / std::ranges::max(lengths);
      if (thinness >= thin) continue;
      for_edges(d, [&](std::size_t c, std::size_t e) {
        const Node a = cells.of(cell)[corner_node(c)];
        const Node b = cells.of(cell)[corner_node(e)];
        if (a < own_nodes && b < own_nodes) result.push_back({thinness, a, b});
      });
    }
  }
  std::ranges::sort(result, {}, [](const Edge& e) { return std::tuple(e.thinness, e.a, e.b); });
  return result;
}

/// Representative of each vertex's group: the vertices joined by edges.
std::vector<Node> group_of_vertices(const std::vector<Edge>& edges, Node vertices) {
  std::vector<Node> group(vertices);
  std::vector<std::vector<Node>> members(vertices);
  for (Node vertex = 0; vertex < vertices; ++vertex) {
    group[vertex] = vertex;
    members[vertex] = {vertex};
  }
  for (const Edge& edge : edges) {
    const Node a = group[edge.a];
    const Node b = group[edge.b];
    if (a == b || members[a].size() + members[b].size() > most_vertices) continue;
    for (const Node vertex : members[b]) {
      group[vertex] = a;
      members[a].push_back(vertex);
    }
    members[b].clear();
  }
  return group;
}

/// A corner of a cell, of which the patch of its vertex has the nodes inside the cell.
struct PatchCell {
  Node group = 0;
  std::uint32_t cell = 0;
  std::uint32_t corner = 0;
};

/// In the order of their groups; of the vertices that have one.
std::vector<PatchCell> cells_of_patches(const CellNodes& cells, const std::vector<Node>& group) {
  std::vector<PatchCell> result;
  for (std::uint32_t cell = 0; cell < cells.cells(); ++cell)
    for (std::uint32_t corner = 0; corner < corners; ++corner)
      if (const Node vertex = cells.of(cell)[corner_node(corner)]; vertex < group.size())
        result.push_back({group[vertex], cell, corner});
  std::ranges::sort(result, {}, &PatchCell::group);
  return result;
}

}  // namespace

std::size_t corner_node(std::size_t corner) {
  return 2 * (corner & 1) + 6 * (corner >> 1 & 1) + 18 * (corner >> 2);
}

double trilinear(std::size_t corner, std::size_t node) {
  const auto at = coordinates(node);
  const auto of = coordinates(corner_node(corner));
  double value = 1;
  for (std::size_t d = 0; d < 3; ++d) value *= 1 - 0.5 * std::abs(at[d] - of[d]);
  return value;
}

VertexPatchSchwarz::VertexPatchSchwarz(const SolidSpace& space, const CellNodes& cells,
                                       const BlockCsr& matrix, Node own_nodes) {
  const std::vector<Node> group = group_of_vertices(thin_edges(space, cells, own_nodes), own_nodes);
  const std::vector<PatchCell> patch_cells = cells_of_patches(cells, group);
  starts_.push_back(0);
  matrix_starts_.push_back(0);
  std::vector<Index> uses(node_unknowns * matrix.nodes() + 1);
  std::vector<Index> patch;
  for (auto next = patch_cells.begin(); next != patch_cells.end();) {
    patch.clear();
    for (const Node group_of_patch = next->group;
         next != patch_cells.end() && next->group == group_of_patch; ++next)
      for (std::size_t a = 0; a < element_nodes; ++a)
        for (Index k = 0; k < node_unknowns && trilinear(next->corner, a) > 0; ++k) {
          const Index dof = static_cast<Index>(node_unknowns) * cells.of(next->cell)[a] + k;
          if (!matrix.is_constrained(dof)) patch.push_back(dof);
        }
    std::ranges::sort(patch);
    patch.erase(std::unique(patch.begin(), patch.end()), patch.end());
    dofs_.insert(dofs_.end(), patch.begin(), patch.end());
    starts_.push_back(dofs_.size());
    matrix_starts_.push_back(matrix_starts_.back() + patch.size() * (patch.size() + 1) / 2);
    for (const Index dof : patch) ++uses[dof + 1];
  }
  for (std::size_t i = 1; i < uses.size(); ++i) uses[i] += uses[i - 1];
  user_starts_ = uses;
  users_.resize(dofs_.size());
  for (std::size_t i = 0; i < dofs_.size(); ++i) users_[uses[dofs_[i]]++] = static_cast<Index>(i);
  inverses_.resize(matrix_starts_.back());
  corrections_.resize(dofs_.size());
}

void VertexPatchSchwarz::update(const BlockCsr& matrix) {
  for_each(starts_.size() - 1, 16, [&](std::size_t patch) {
    const std::span dofs =
        std::span(dofs_).subspan(starts_[patch], starts_[patch + 1] - starts_[patch]);
    const auto size = static_cast<Eigen::Index>(dofs.size());
    Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(size, size);
    for (std::size_t row = 0; row < dofs.size(); ++row) {
      const Node node = dofs[row] / node_unknowns;
      const std::span columns = matrix.columns(node);
      std::size_t column = 0;  // both are sorted
      for (std::size_t position = 0; position < columns.size(); ++position) {
        while (column < dofs.size() && dofs[column] / node_unknowns < columns[position]) ++column;
        if (column == dofs.size()) break;
        if (dofs[column] / node_unknowns != columns[position]) continue;
        const Matrix3 block = matrix.block(node, position);
        for (; column < dofs.size() && dofs[column] / node_unknowns == columns[position]; ++column)
          dense(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column)) =
              block(dofs[row] % node_unknowns, dofs[column] % node_unknowns);
      }
    }
    const Eigen::MatrixXd inverse = symmetric_inverse(0.5 * (dense + dense.transpose()));
    float* at = inverses_.data() + matrix_starts_[patch];
    for (Eigen::Index j = 0; j < size; ++j)
      for (Eigen::Index i = j; i < size; ++i) *at++ = static_cast<float>(inverse(i, j));
  });
}

void VertexPatchSchwarz::vmult(Vector& z, const Vector& r) const {
  // Entries of r below the least float would count as zero.
  const double scale = r.linfty_norm();
  z = 0.;
  if (!(scale > 0)) return;
  r.update_ghost_values();
  const double* const R = r.begin();
  for_each(starts_.size() - 1, 64, [&](std::size_t patch) {
    const auto size = static_cast<Eigen::Index>(starts_[patch + 1] - starts_[patch]);
    Eigen::VectorXf local(size);
    for (Eigen::Index i = 0; i < size; ++i)
      local[i] = static_cast<float>(R[dofs_[starts_[patch] + static_cast<std::size_t>(i)]] / scale);
    Eigen::Map<Eigen::VectorXf> result(corrections_.data() + starts_[patch], size);
    result.setZero();
    const float* column = inverses_.data() + matrix_starts_[patch];
    for (Eigen::Index j = 0; j < size; ++j) {
      const Eigen::Index below = size - j;  // the diagonal first
      const Eigen::Map<const Eigen::VectorXf> lower(column, below);
      result.tail(below) += local[j] * lower;
      result[j] += lower.tail(below - 1).dot(local.tail(below - 1));
      column += below;
    }
  });
  r.zero_out_ghost_values();
  double* const Z = z.begin();
  for_each(user_starts_.size() - 1, 1024, [&](std::size_t dof) {
    double sum = 0;
    for (std::size_t i = user_starts_[dof]; i < user_starts_[dof + 1]; ++i)
      sum += static_cast<double>(corrections_[users_[i]]);
    Z[dof] = scale * sum;
  });
  z.compress(dealii::VectorOperation::add);
}

}  // namespace ciliaval::fem::solid::solvers
