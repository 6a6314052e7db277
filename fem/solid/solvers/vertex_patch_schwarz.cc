// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/solvers/vertex_patch_schwarz.h"

#include <deal.II/base/mpi.h>

#include <Eigen/Core>
#include <Eigen/LU>
#include <array>
#include <cstdlib>
#include <map>
#include <set>
#include <span>

namespace ciliaval::fem::solid::solvers {
using namespace discretisation;
namespace {

using dealii::Vector;
using dealii::types::global_dof_index;

/// Lexicographic coordinates 0 … 2 of a node of the element.
std::array<int, 3> coordinates(int node) {
  return {node % 3, node / 3 % 3, node / 9};
}

}  // namespace

int corner_node(std::size_t corner) {
  const int c = static_cast<int>(corner);
  return 2 * (c & 1) + 6 * (c >> 1 & 1) + 18 * (c >> 2);
}

std::size_t element_dof(int component, int node) {
  return element_nodes * static_cast<std::size_t>(component) + static_cast<std::size_t>(node);
}

double trilinear(std::size_t corner, int node) {
  const auto at = coordinates(node);
  const auto of = coordinates(corner_node(corner));
  double value = 1;
  for (std::size_t d = 0; d < 3; ++d) value *= 1 - 0.5 * std::abs(at[d] - of[d]);
  return value;
}

VertexPatchSchwarz::VertexPatchSchwarz(const SolidSpace& space,
                                       const dealii::AffineConstraints<double>& constraints,
                                       RowRange rows, MPI_Comm communicator)
    : communicator_(communicator) {
  std::map<global_dof_index, std::set<Index>> patches;
  for (const SolidElement& element : space.elements())
    for (std::size_t c = 0; c < corners; ++c) {
      const global_dof_index vertex = element.dofs[element_dof(0, corner_node(c))];
      if (!rows.contains(vertex)) continue;
      for (int node = 0; node < element_nodes; ++node)
        for (int k = 0; k < 3; ++k) {
          const global_dof_index dof = element.dofs[element_dof(k, node)];
          if (trilinear(c, node) > 0 && !constraints.is_constrained(dof))
            patches[vertex].insert(static_cast<Index>(dof));
        }
    }
  starts_.push_back(0);
  matrix_starts_.push_back(0);
  std::vector<std::size_t> uses(space.unknowns() + 1);
  for (const auto& [vertex, patch] : patches) {
    dofs_.insert(dofs_.end(), patch.begin(), patch.end());
    starts_.push_back(dofs_.size());
    matrix_starts_.push_back(matrix_starts_.back() + patch.size() * (patch.size() + 1) / 2);
    for (const Index dof : patch) ++uses[dof + 1];
  }
  for (std::size_t i = 1; i < uses.size(); ++i) uses[i] += uses[i - 1];
  user_starts_ = uses;
  users_.resize(dofs_.size());
  for (std::size_t i = 0; i < dofs_.size(); ++i) users_[uses[dofs_[i]]++] = i;
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
      const BlockCsr::Node node = dofs[row] / node_unknowns;
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
    const Eigen::MatrixXd inverse = (0.5 * (dense + dense.transpose())).inverse();
    float* at = inverses_.data() + matrix_starts_[patch];
    for (Eigen::Index j = 0; j < size; ++j)
      for (Eigen::Index i = j; i < size; ++i) *at++ = static_cast<float>(inverse(i, j));
  });
}

void VertexPatchSchwarz::vmult(Vector<double>& z, const Vector<double>& r) const {
  // Entries of r below the least float would count as zero.
  const double scale = r.linfty_norm();
  z.reinit(r.size());
  if (scale > 0) {
    for_each(starts_.size() - 1, 64, [&](std::size_t patch) {
      const auto size = static_cast<Eigen::Index>(starts_[patch + 1] - starts_[patch]);
      Eigen::VectorXf local(size);
      for (Eigen::Index i = 0; i < size; ++i)
        local[i] =
            static_cast<float>(r[dofs_[starts_[patch] + static_cast<std::size_t>(i)]] / scale);
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
    for_each(r.size(), 1024, [&](std::size_t index) {
      const auto dof = static_cast<Row>(index);
      double sum = 0;
      for (std::size_t i = user_starts_[dof]; i < user_starts_[dof + 1]; ++i)
        sum += static_cast<double>(corrections_[users_[i]]);
      z[dof] = scale * sum;
    });
  }
  // MPI requires that a sum has the same bits on all ranks.
  const dealii::ArrayView<double> values(z.begin(), z.size());
  dealii::Utilities::MPI::sum(dealii::ArrayView<const double>(values), communicator_, values);
}

}  // namespace ciliaval::fem::solid::solvers
