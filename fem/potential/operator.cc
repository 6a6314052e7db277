// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/potential/operator.h"

#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/lac/solver_cg.h>
#include <deal.II/lac/trilinos_sparsity_pattern.h>

#include <algorithm>
#include <string>

#include "fem/parallel.h"
#include "problem/error.h"
#include "problem/support/interruption.h"

namespace ciliaval::fem::potential {
namespace {

/// Leaves that share one product with the unit cube's matrix.
constexpr int batch = 16;

}  // namespace

PotentialOperator::PotentialOperator(const PotentialSpace& space, const CutCells& bodies)
    : space_(space), unit_(unit_stiffness(space.basis())) {
  for (const int cell : bodies.cells())
    if (bodies.has_permeability(cell)) bodies_.emplace(cell, bodies.stiffness(cell, space.basis()));
}

template <typename Read>
void PotentialOperator::apply(PotentialVector& result, const Read& read) const {
  const std::vector<Cube>& cubes = space_.octree().cubes();
  const int cells = static_cast<int>(cubes.size());
  Eigen::MatrixXd u(space_.nodes(), batch);
  Eigen::MatrixXd r(space_.nodes(), batch);
  for (int start = 0; start < cells; start += batch) {
    support::check_interruption();
    const int count = std::min(batch, cells - start);
    for (int c = 0; c < count; ++c) read(start + c, u.col(c));
    r.noalias() = unit_ * u;
    for (int c = 0; c < count; ++c) {
      const int cell = start + c;
      r.col(c) *= cubes[static_cast<std::size_t>(cell)].size;
      if (const auto body = bodies_.find(cell); body != bodies_.end())
        r.col(c).noalias() += body->second * u.col(c);
      space_.add_free(cell, r.col(c), result);
    }
  }
  result.compress(dealii::VectorOperation::add);
}

double PotentialOperator::el(size_type, size_type) {
  throw SolverError("the potential's operator has no matrix elements");
}

void PotentialOperator::vmult(PotentialVector& result, const PotentialVector& free) const {
  result = 0.;
  free.update_ghost_values();
  apply(result, [&](int cell, auto u) { space_.read_free(cell, free, u); });
  free.zero_out_ghost_values();
}

PotentialVector PotentialOperator::apply_complete(const PotentialVector& complete) const {
  PotentialVector result = space_.vector();
  apply(result, [&](int cell, auto u) { space_.read(cell, complete, u); });
  return result;
}

Eigen::MatrixXd PotentialOperator::cell_matrix(int cell) const {
  Eigen::MatrixXd result = space_.octree().cubes()[static_cast<std::size_t>(cell)].size * unit_;
  if (const auto body = bodies_.find(cell); body != bodies_.end()) result += body->second;
  return result;
}

double PotentialOperator::energy(int cell, const Eigen::Ref<const Eigen::VectorXd>& u) const {
  return space_.octree().cubes()[static_cast<std::size_t>(cell)].size * u.dot(unit_ * u);
}

Eigen::VectorXd PotentialOperator::bodies_part(int cell,
                                               const Eigen::Ref<const Eigen::VectorXd>& u) const {
  return bodies_.at(cell) * u;
}

PotentialVector PotentialOperator::inverse_diagonal() const {
  PotentialVector d = space_.vector();
  const int cells = static_cast<int>(space_.octree().cubes().size());
  for (int c = 0; c < cells; ++c) {
    Eigen::VectorXd own =
        space_.octree().cubes()[static_cast<std::size_t>(c)].size * unit_.diagonal();
    if (const auto body = bodies_.find(c); body != bodies_.end()) own += body->second.diagonal();
    space_.add_diagonal(c, own, d);
  }
  d.compress(dealii::VectorOperation::add);
  for (double& value : d) value = value > 0 ? 1 / value : 0;
  return d;
}

PotentialMultigrid::Coarse::Coarse(const Octree& octree, const CutCells& bodies)
    : space_(octree, 1) {
  const PotentialOperator cells(space_, bodies);
  const dealii::DoFHandler<3>& dofs = space_.dofs();
  const dealii::FE_Q<3> element(1);
  const dealii::AffineConstraints<double>& constraints = space_.constraints();
  dealii::TrilinosWrappers::SparsityPattern pattern(dofs.locally_owned_dofs(),
                                                    octree.communicator());
  dealii::DoFTools::make_sparsity_pattern(dofs, pattern, constraints, false,
                                          dofs.get_triangulation().locally_owned_subdomain());
  pattern.compress();
  matrix_.reinit(pattern);
  const std::vector<unsigned int> hierarchic = element.get_poly_space_numbering_inverse();
  dealii::FullMatrix<double> local(8, 8);
  std::vector<dealii::types::global_dof_index> indices(8);
  for (std::size_t c = 0; c < octree.cells().size(); ++c) {
    const Octree::CellIterator& cell = octree.cells()[c];
    const dealii::DoFHandler<3>::active_cell_iterator with_dofs(
        &cell->get_triangulation(), cell->level(), cell->index(), &dofs);
    with_dofs->get_dof_indices(indices);
    const Eigen::MatrixXd A = cells.cell_matrix(static_cast<int>(c));
    for (unsigned int i = 0; i < 8; ++i)
      for (unsigned int j = 0; j < 8; ++j) local(hierarchic[i], hierarchic[j]) = A(i, j);
    constraints.distribute_local_to_global(local, indices, matrix_);
  }
  matrix_.compress(dealii::VectorOperation::add);
  dealii::TrilinosWrappers::PreconditionAMG::AdditionalData options;
  options.elliptic = true;
  options.smoother_sweeps = 2;
  options.aggregation_threshold = 0.02;
  amg_.initialize(matrix_, options);
}

PotentialMultigrid::PotentialMultigrid(const PotentialOperator& fine, const Coarse& coarse)
    : fine_(fine),
      coarse_(coarse),
      embedding_(interpolation(coarse.space_.basis(), fine.space().basis())),
      residual_(fine.space().vector()),
      coarse_residual_(coarse.space_.vector()),
      coarse_solution_(coarse.space_.vector()) {
  Smoother::AdditionalData options;
  options.degree = 3;
  options.smoothing_range = 12;
  options.eig_cg_n_iterations = 12;
  options.constraints.copy_from(fine.space().constraints());
  options.preconditioner =
      std::make_shared<dealii::DiagonalMatrix<PotentialVector>>(fine.inverse_diagonal());
  smoother_.initialize(fine, options);
}

void PotentialMultigrid::add_prolonged(PotentialVector& fine, const PotentialVector& coarse) const {
  const int cells = static_cast<int>(fine_.space().octree().cells().size());
  Eigen::VectorXd u(8);
  Eigen::VectorXd v(fine_.space().nodes());
  coarse.update_ghost_values();
  for (int c = 0; c < cells; ++c) {
    coarse_.space_.read_free(c, coarse, u);
    v.noalias() = embedding_ * u;
    for (const auto& [row, node] : fine_.space().assigned(c)) fine.local_element(node) += v[row];
  }
  coarse.zero_out_ghost_values();
}

void PotentialMultigrid::add_restricted(PotentialVector& coarse,
                                        const PotentialVector& fine) const {
  const int cells = static_cast<int>(fine_.space().octree().cells().size());
  Eigen::VectorXd r(8);
  Eigen::VectorXd v(fine_.space().nodes());
  for (int c = 0; c < cells; ++c) {
    v.setZero();
    for (const auto& [row, node] : fine_.space().assigned(c)) v[row] = fine.local_element(node);
    r.noalias() = embedding_.transpose() * v;
    coarse_.space_.add_free(c, r, coarse);
  }
  coarse.compress(dealii::VectorOperation::add);
}

void PotentialMultigrid::vmult(PotentialVector& x, const PotentialVector& b) const {
  smoother_.vmult(x, b);
  fine_.vmult(residual_, x);
  residual_.sadd(-1, 1, b);
  coarse_residual_ = 0.;
  add_restricted(coarse_residual_, residual_);
  coarse_solution_ = 0.;
  coarse_.amg_.vmult(coarse_solution_, coarse_residual_);
  add_prolonged(x, coarse_solution_);
  smoother_.step(x, b);
}

unsigned int solve(const PotentialOperator& A, const PotentialMultigrid& preconditioner,
                   const PotentialVector& b, double tolerance, PotentialVector& x) {
  constexpr unsigned int most = 200;
  dealii::SolverControl control(most, tolerance * b.l2_norm());
  dealii::SolverCG<PotentialVector> cg(control);
  const double load = b.l2_norm();
  std::string trouble;
  try {
    cg.solve(A, x, b, preconditioner);
  } catch (const dealii::SolverControl::NoConvergence& failure) {
    trouble = "the potential's conjugate gradients did not converge: residual " +
              std::to_string(failure.last_residual / load) + " of the load after " +
              std::to_string(failure.last_step) + " iterations";
  }
  trouble = first_text(A.space().octree().communicator(), trouble);
  if (!trouble.empty()) throw SolverError(trouble);
  return control.last_step();
}

}  // namespace ciliaval::fem::potential
