// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/solvers/multigrid.h"

#include <deal.II/lac/dynamic_sparsity_pattern.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <span>

namespace ciliaval::fem::solid::solvers {
using namespace discretisation;
namespace {

using dealii::Vector;
using dealii::types::global_dof_index;

/// Chebyshev iteration: polynomial degree, and the part of the spectrum that it damps, from the
/// largest eigenvalue down (docs/theory/solid.md).
constexpr int smoother_degree = 2;
constexpr double smoother_range = 10;
constexpr double safety = 1.05;  ///< tangents of compressed cells are not quite positive

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

}  // namespace

Multigrid::Multigrid(const SolidSpace& space, const dealii::AffineConstraints<double>& constraints,
                     const BlockCsr& matrix, RowRange rows, MPI_Comm communicator)
    : matrix_(matrix),
      rows_(rows),
      communicator_(communicator),
      schwarz_(space, constraints, rows, communicator) {
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
          if (trilinear(c, node) > 0 &&
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
      coarse_pattern_, DirectSolver::Kind::symmetric_part, own_coarse_rows(), communicator_);
  work_.resize(coarse_matrix_.m());
}

RowRange Multigrid::own_coarse_rows() const {
  RowRange result{coarse_matrix_.m(), 0};
  const auto add = [&result](Row row) {
    result = {std::min(result.begin, row), std::max(result.end, row + 1)};
  };
  for (std::size_t k = prolongation_starts_[rows_.begin]; k < prolongation_starts_[rows_.end]; ++k)
    add(prolongation_[k].column);
  if (rank(communicator_) == 0) std::for_each(fixed_.begin(), fixed_.end(), add);
  return {std::min(result.begin, result.end), result.end};
}

void Multigrid::add_coarse_rows(BlockCsr::Node node) {
  const auto weights = [&](Row i) {
    return std::span(prolongation_)
        .subspan(prolongation_starts_[i], prolongation_starts_[i + 1] - prolongation_starts_[i]);
  };
  const std::span neighbours = matrix_.columns(node);
  std::vector<global_dof_index> columns;
  std::vector<double> values;
  for (Row k = 0; k < node_unknowns; ++k) {
    const std::span own = weights(node_unknowns * Row{node} + k);
    if (own.empty()) continue;
    columns.clear();
    for (std::size_t position = 0; position < neighbours.size(); ++position) {
      const Matrix3 block = matrix_.block(node, position);
      for (Row l = 0; l < node_unknowns; ++l)
        for (const Weight& weight : weights(node_unknowns * Row{neighbours[position]} + l)) {
          if (work_[weight.column] == 0) columns.push_back(weight.column);
          work_[weight.column] += weight.value * block(k, l);
          if (work_[weight.column] == 0)  // keeps the column marked
            work_[weight.column] = std::numeric_limits<double>::min();
        }
    }
    for (const Weight& weight : own) {
      values.clear();
      for (const global_dof_index column : columns) values.push_back(weight.value * work_[column]);
      coarse_matrix_.add(weight.column, columns, values);
    }
    for (const global_dof_index column : columns) work_[column] = 0;
  }
}

void Multigrid::update() {
  schwarz_.update(matrix_);
  coarse_matrix_ = 0;
  for (Row row = rows_.begin; row < rows_.end; row += node_unknowns)
    add_coarse_rows(static_cast<BlockCsr::Node>(row / node_unknowns));
  if (rank(communicator_) == 0)
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
  constexpr double upper = safety * VertexPatchSchwarz::largest_eigenvalue;
  constexpr double lower = upper / smoother_range;
  constexpr double centre = (upper + lower) / 2;
  constexpr double half_width = (upper - lower) / 2;
  constexpr double sigma = centre / half_width;
  Vector<double> r(b);
  Vector<double> z;
  if (!from_zero) residual(r, x, b);
  schwarz_.vmult(z, r);
  Vector<double> step(z);
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

}  // namespace ciliaval::fem::solid::solvers
