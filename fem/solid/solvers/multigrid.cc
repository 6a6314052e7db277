// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/multigrid.h"

#include <deal.II/base/parallel.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cstdlib>
#include <limits>
#include <map>
#include <set>
#include <span>

#include "problem/error.h"

namespace ciliaval::fem {
namespace {

using dealii::SparseMatrix;
using dealii::Vector;
using dealii::types::global_dof_index;

/// Chebyshev iteration: polynomial degree, and the part of the spectrum that it damps, from the
/// largest eigenvalue down (docs/solid.md has the iterations of other values).
constexpr int smoother_degree = 2;
constexpr double smoother_range = 10;
constexpr double safety = 1.05;  ///< tangents of compressed cells are not quite positive

constexpr std::size_t corners = 8;

/// Lexicographic coordinates 0 … 2 of a node of the element.
std::array<int, 3> coordinates(int node) {
  return {node % 3, node / 3 % 3, node / 9};
}

/// Lexicographic node of a corner.
int corner_node(std::size_t corner) {
  const int c = static_cast<int>(corner);
  return 2 * (c & 1) + 6 * (c >> 1 & 1) + 18 * (c >> 2);
}

std::size_t element_dof(int component, int node) {
  return element_nodes * static_cast<std::size_t>(component) + static_cast<std::size_t>(node);
}

/// Trilinear shape function of a corner at a node of the element.
double trilinear(std::size_t corner, int node) {
  const auto at = coordinates(node);
  const auto of = coordinates(corner_node(corner));
  double value = 1;
  for (std::size_t d = 0; d < 3; ++d) value *= 1 - 0.5 * std::abs(at[d] - of[d]);
  return value;
}

/// Whether the star of a corner holds a node of the element.
bool in_star(std::size_t corner, int node) {
  return trilinear(corner, node) > 0;
}

/// The vertices' first degrees of freedom, numbered 0, 1, …
std::map<global_dof_index, global_dof_index> number_vertices(const SolidSpace& space) {
  std::map<global_dof_index, global_dof_index> numbers;
  for (const SolidElement& element : space.elements())
    for (std::size_t c = 0; c < corners; ++c)
      numbers.emplace(element.dofs[element_dof(0, corner_node(c))], 0);
  global_dof_index count = 0;
  for (auto& [dof, number] : numbers) number = count++;
  return numbers;
}

void for_each(std::size_t count, std::size_t grain, const auto& work) {
  dealii::parallel::apply_to_subranges(
      std::size_t{0}, count,
      [&work](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) work(i);
      },
      static_cast<unsigned int>(grain));
}

}  // namespace

template <typename Number>
void OwnRows<Number>::make_pattern(const dealii::SparsityPattern& pattern) {
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
void OwnRows<Number>::update(const SparseMatrix<double>& matrix) {
  if (starts_.empty()) make_pattern(matrix.get_sparsity_pattern());
  for_each(starts_.size() - 1, 64, [&](std::size_t i) {
    const Row first = rows_.begin + static_cast<Row>(node_unknowns * i);
    const auto own = static_cast<std::size_t>(
        std::lower_bound(nodes_.begin() + static_cast<std::ptrdiff_t>(starts_[i]),
                         nodes_.begin() + static_cast<std::ptrdiff_t>(starts_[i + 1]),
                         first / node_unknowns) -
        nodes_.begin());
    for (Row k = 0; k < node_unknowns; ++k) {
      // The columns are sorted, but for the diagonal, which deal.II stores first.
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
void OwnRows<Number>::vmult(Vector<double>& y, const Vector<double>& x) const {
  const double* const X = x.begin();
  for_each(starts_.size() - 1, 64, [&](std::size_t i) {
    // Nine sums, so that no addition waits for the one before.
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
  gather_over_ranks({y.begin(), y.size()});
}

template class OwnRows<float>;
template class OwnRows<double>;

VertexStars::VertexStars(const SolidSpace& space,
                         const dealii::AffineConstraints<double>& constraints, RowRange rows) {
  std::map<global_dof_index, std::set<Index>> stars;
  for (const SolidElement& element : space.elements())
    for (std::size_t c = 0; c < corners; ++c) {
      const global_dof_index vertex = element.dofs[element_dof(0, corner_node(c))];
      if (!rows.contains(vertex)) continue;
      for (int node = 0; node < element_nodes; ++node)
        for (int k = 0; k < 3; ++k) {
          const global_dof_index dof = element.dofs[element_dof(k, node)];
          if (in_star(c, node) && !constraints.is_constrained(dof))
            stars[vertex].insert(static_cast<Index>(dof));
        }
    }
  starts_.push_back(0);
  matrix_starts_.push_back(0);
  std::vector<std::size_t> uses(space.unknowns() + 1);
  for (const auto& [vertex, star] : stars) {
    dofs_.insert(dofs_.end(), star.begin(), star.end());
    starts_.push_back(dofs_.size());
    matrix_starts_.push_back(matrix_starts_.back() + star.size() * star.size());
    for (const Index dof : star) ++uses[dof + 1];
  }
  for (std::size_t i = 1; i < uses.size(); ++i) uses[i] += uses[i - 1];
  user_starts_ = uses;
  users_.resize(dofs_.size());
  for (std::size_t i = 0; i < dofs_.size(); ++i) users_[uses[dofs_[i]]++] = i;
  inverses_.resize(matrix_starts_.back());
  corrections_.resize(dofs_.size());
}

void VertexStars::update(const SparseMatrix<double>& matrix) {
  for_each(starts_.size() - 1, 16, [&](std::size_t star) {
    const auto first = dofs_.begin() + static_cast<std::ptrdiff_t>(starts_[star]);
    const auto last = dofs_.begin() + static_cast<std::ptrdiff_t>(starts_[star + 1]);
    const auto size = last - first;
    Eigen::MatrixXd block = Eigen::MatrixXd::Zero(size, size);
    for (auto row = first; row != last; ++row) {
      auto column = first;  // both are sorted, but for the diagonal, which deal.II stores first
      for (auto entry = matrix.begin(*row); entry != matrix.end(*row); ++entry) {
        if (entry->column() == *row) {
          block(row - first, row - first) = entry->value();
          continue;
        }
        while (column != last && *column < entry->column()) ++column;
        if (column == last) break;
        if (*column == entry->column()) block(row - first, column - first) = entry->value();
      }
    }
    Eigen::Map<Eigen::MatrixXf>(inverses_.data() + matrix_starts_[star], size, size) =
        block.inverse().cast<float>();
  });
}

void VertexStars::vmult(Vector<double>& z, const Vector<double>& r) const {
  // Entries of r below the least float would count as zero.
  const double scale = r.linfty_norm();
  z.reinit(r.size());
  if (scale > 0) {
    for_each(starts_.size() - 1, 64, [&](std::size_t star) {
      const auto size = static_cast<Eigen::Index>(starts_[star + 1] - starts_[star]);
      Eigen::VectorXf local(size);
      for (Eigen::Index i = 0; i < size; ++i)
        local[i] =
            static_cast<float>(r[dofs_[starts_[star] + static_cast<std::size_t>(i)]] / scale);
      Eigen::Map<Eigen::VectorXf>(corrections_.data() + starts_[star], size).noalias() =
          Eigen::Map<const Eigen::MatrixXf>(inverses_.data() + matrix_starts_[star], size, size) *
          local;
    });
    for_each(r.size(), 1024, [&](std::size_t index) {
      const auto dof = static_cast<Row>(index);
      double sum = 0;
      for (std::size_t i = user_starts_[dof]; i < user_starts_[dof + 1]; ++i)
        sum += static_cast<double>(corrections_[users_[i]]);
      z[dof] = scale * sum;
    });
  }
  sum_over_ranks({z.begin(), z.size()});
}

Multigrid::Multigrid(const SolidSpace& space, const dealii::AffineConstraints<double>& constraints,
                     RowRange rows)
    : rows_(rows), stars_(space, constraints, rows), matrix_(rows) {
  make_prolongation(space, constraints);
}

void Multigrid::make_prolongation(const SolidSpace& space,
                                  const dealii::AffineConstraints<double>& constraints) {
  const auto vertices = number_vertices(space);
  std::vector<std::vector<Weight>> rows(space.unknowns());
  const auto coarse_size = 3 * static_cast<global_dof_index>(vertices.size());
  dealii::DynamicSparsityPattern pattern(coarse_size);
  for (const SolidElement& element : space.elements()) {
    std::array<global_dof_index, 3 * corners> coarse{};
    for (std::size_t c = 0; c < corners; ++c)
      for (unsigned int k = 0; k < 3; ++k)
        coarse[3 * c + k] = 3 * vertices.at(element.dofs[element_dof(0, corner_node(c))]) + k;
    for (const global_dof_index i : coarse)
      for (const global_dof_index j : coarse) pattern.add(i, j);
    for (int node = 0; node < element_nodes; ++node)
      for (std::size_t k = 0; k < 3; ++k) {
        const auto component = static_cast<int>(k);
        const global_dof_index dof = element.dofs[element_dof(component, node)];
        if (!rows[dof].empty() || constraints.is_constrained(dof)) continue;
        for (std::size_t c = 0; c < corners; ++c)
          if (in_star(c, node) &&
              !constraints.is_constrained(element.dofs[element_dof(component, corner_node(c))]))
            rows[dof].push_back({coarse[3 * c + k], trilinear(c, node)});
      }
    for (std::size_t c = 0; c < corners; ++c)
      for (std::size_t k = 0; k < 3; ++k)
        if (constraints.is_constrained(
                element.dofs[element_dof(static_cast<int>(k), corner_node(c))]))
          fixed_.push_back(coarse[3 * c + k]);
  }
  std::sort(fixed_.begin(), fixed_.end());
  fixed_.erase(std::unique(fixed_.begin(), fixed_.end()), fixed_.end());
  prolongation_starts_.push_back(0);
  for (const auto& row : rows) {
    prolongation_.insert(prolongation_.end(), row.begin(), row.end());
    prolongation_starts_.push_back(prolongation_.size());
  }
  coarse_pattern_.copy_from(pattern);
  coarse_matrix_.reinit(coarse_pattern_);
  coarse_solver_ = std::make_unique<DirectSolver>(
      coarse_pattern_, DirectSolver::Kind::symmetric_part, own_coarse_rows());
  work_.resize(coarse_matrix_.m());
}

RowRange Multigrid::own_coarse_rows() const {
  RowRange result{coarse_matrix_.m(), 0};
  const auto add = [&result](Row row) {
    result = {std::min(result.begin, row), std::max(result.end, row + 1)};
  };
  for (std::size_t k = prolongation_starts_[rows_.begin]; k < prolongation_starts_[rows_.end]; ++k)
    add(prolongation_[k].column);
  if (rank() == 0) std::for_each(fixed_.begin(), fixed_.end(), add);
  return {std::min(result.begin, result.end), result.end};
}

void Multigrid::add_coarse_row(const SparseMatrix<double>& matrix, Row row) {
  const auto weights = [&](Row i) {
    return std::span(prolongation_)
        .subspan(prolongation_starts_[i], prolongation_starts_[i + 1] - prolongation_starts_[i]);
  };
  if (weights(row).empty()) return;
  std::vector<global_dof_index> columns;
  for (auto entry = matrix.begin(row); entry != matrix.end(row); ++entry)
    for (const Weight& weight : weights(entry->column())) {
      if (work_[weight.column] == 0) columns.push_back(weight.column);
      work_[weight.column] += weight.value * entry->value();
      if (work_[weight.column] == 0)  // keeps the column marked
        work_[weight.column] = std::numeric_limits<double>::min();
    }
  std::vector<double> values;
  for (const Weight& weight : weights(row)) {
    values.clear();
    for (const global_dof_index column : columns) values.push_back(weight.value * work_[column]);
    coarse_matrix_.add(weight.column, columns, values);
  }
  for (const global_dof_index column : columns) work_[column] = 0;
}

void Multigrid::update(const SparseMatrix<double>& matrix) {
  matrix_.update(matrix);
  stars_.update(matrix);
  coarse_matrix_ = 0;
  for (Row row = rows_.begin; row < rows_.end; ++row) add_coarse_row(matrix, row);
  if (rank() == 0)
    for (const Row dof : fixed_) coarse_matrix_.add(dof, dof, 1);
  coarse_solver_->factorize(coarse_matrix_);
}

void Multigrid::residual(Vector<double>& r, const Vector<double>& x,
                         const Vector<double>& b) const {
  r.reinit(b.size(), true);
  matrix_.vmult(r, x);
  r.sadd(-1, 1, b);
}

void Multigrid::smooth(Vector<double>& x, const Vector<double>& b, bool from_zero) const {
  // Chebyshev iteration on [lower, upper]: Saad, Iterative Methods for Sparse Linear Systems, 2nd
  // ed., algorithm 12.1.
  constexpr double upper = safety * VertexStars::largest_eigenvalue;
  constexpr double lower = upper / smoother_range;
  constexpr double centre = (upper + lower) / 2;
  constexpr double half_width = (upper - lower) / 2;
  constexpr double sigma = centre / half_width;
  Vector<double> r(b);
  Vector<double> z;
  if (!from_zero) residual(r, x, b);
  stars_.vmult(z, r);
  Vector<double> step(z);
  step /= centre;
  x += step;
  double rho = 1 / sigma;
  for (int k = 1; k < smoother_degree; ++k) {
    residual(r, x, b);
    stars_.vmult(z, r);
    const double next = 1 / (2 * sigma - rho);
    step.sadd(rho * next, 2 * next / half_width, z);
    rho = next;
    x += step;
  }
}

void Multigrid::correct(Vector<double>& x, const Vector<double>& b) const {
  Vector<double> r;
  residual(r, x, b);
  Vector<double> coarse_residual(coarse_matrix_.m());
  Vector<double> correction;
  for (Row i = 0; i < r.size(); ++i)
    for (std::size_t k = prolongation_starts_[i]; k < prolongation_starts_[i + 1]; ++k)
      coarse_residual[prolongation_[k].column] += prolongation_[k].value * r[i];
  coarse_solver_->solve(coarse_residual, correction);
  for (Row i = 0; i < r.size(); ++i)
    for (std::size_t k = prolongation_starts_[i]; k < prolongation_starts_[i + 1]; ++k)
      x[i] += prolongation_[k].value * correction[prolongation_[k].column];
}

void Multigrid::vmult(Vector<double>& x, const Vector<double>& b) const {
  x.reinit(b.size());
  smooth(x, b, true);
  correct(x, b);
  smooth(x, b, false);
}

}  // namespace ciliaval::fem
