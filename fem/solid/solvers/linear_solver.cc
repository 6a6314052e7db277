// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/solvers/linear_solver.h"

#include <deal.II/dofs/dof_tools.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/solver_control.h>
#include <deal.II/lac/solver_gmres.h>
#include <deal.II/lac/vector.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "fem/parallel.h"
#include "problem/error.h"

namespace ciliaval::fem::solid::solvers {
using namespace discretisation;
namespace {

constexpr unsigned int max_iterations = 300;
constexpr unsigned int restart = 60;  ///< vectors of GMRES
/// Iterations with the LU of another matrix, beyond which the LU of the own one is cheaper.
constexpr unsigned int max_with_old_factors = 20;

/// GMRES iterations that cost as much as the multigrid's preparation (docs/measurements.md).
constexpr unsigned int preparation = 10;

/// Unknowns beyond which `automatic` is `iterative` (docs/measurements.md).
constexpr double direct_unknowns = 100000;

/// A matrix that is whole on this rank. By plain vectors: of distributed ones deal.II's product
/// looks up the owner of each value, in four times the instructions.
struct WholeMatrix {
  const dealii::SparseMatrix<double>& matrix;
  void vmult(Vector& y, const Vector& x) const {
    const dealii::Vector<double> plain(x.begin(), x.end());
    dealii::Vector<double> product(matrix.m());
    matrix.vmult(product, plain);
    std::ranges::copy(product, y.begin());
  }
};

/// This rank's rows of a matrix.
struct OwnRows {
  const dealii::SparseMatrix<double>& matrix;
  RowRange rows;
  MPI_Comm communicator;
  void vmult(Vector& y, const Vector& x) const {
    y = 0.;
    for (Row row = rows.begin; row < rows.end; ++row)
      for (auto entry = matrix.begin(row); entry != matrix.end(row); ++entry)
        y.local_element(row) += entry->value() * x.local_element(entry->column());
    sum_over_ranks(communicator, {y.begin(), y.locally_owned_size()});
  }
};

struct Factors {
  const DirectSolver& solver;
  void vmult(Vector& x, const Vector& b) const { solver.solve(b, x); }
};

}  // namespace

bool is_iterative(SolverKind kind, double unknowns) {
  return kind == SolverKind::iterative ||
         (kind == SolverKind::automatic && unknowns > direct_unknowns);
}

LinearSolver::LinearSolver(const SolidSpace& space,
                           const dealii::AffineConstraints<double>& constraints, SolverKind kind,
                           MPI_Comm communicator)
    : communicator_(communicator), rows_(own_range(communicator, space.unknowns())) {
  if (is_iterative(kind, space.unknowns())) {
    for (std::size_t e = 0; e < space.elements().size(); ++e) cells_.push_back(e);
    const CellNodes cells = element_cell_nodes(space);
    blocks_ = std::make_unique<BlockCsr>(cells, constrained_unknowns(space, constraints));
    multigrid_ = std::make_unique<Multigrid>(space, cells, *blocks_);
    return;
  }
  for (std::size_t e = 0; e < space.elements().size(); ++e)
    if (std::ranges::any_of(space.elements()[e].dofs,
                            [this](Row dof) { return rows_.contains(dof); }))
      cells_.push_back(e);
  dealii::DynamicSparsityPattern pattern(space.unknowns());
  dealii::DoFTools::make_sparsity_pattern(space.dof_handler(), pattern);
  pattern_.copy_from(pattern);
  matrix_.reinit(pattern_);
  assembled_ = std::make_unique<AssembledTangent>(constraints, matrix_);
  direct_ =
      std::make_unique<DirectSolver>(pattern_, DirectSolver::Kind::general, rows_, communicator);
}

TangentMatrix& LinearSolver::new_tangent() {
  current_ = false;
  if (blocks_) {
    blocks_->clear();
    return *blocks_;
  }
  matrix_ = 0;
  return *assembled_;
}

void LinearSolver::prepare_near_last() {
  if (!is_prepared_) prepare();
}

void LinearSolver::prepare() {
  is_prepared_ = false;
  if (multigrid_)
    multigrid_->update();
  else
    direct_->factorize(matrix_);
  is_prepared_ = true;
  current_ = true;
}

std::optional<int> LinearSolver::gmres(const Vector& rhs, Vector& solution, double reduction,
                                       unsigned int max_iterations) const {
  using Vector = Vector;
  // Flexible, for the multigrid rounds to single precision and is not quite linear.
  using Solver = dealii::SolverFGMRES<Vector>;
  dealii::SolverControl control(max_iterations, reduction * rhs.l2_norm());
  Solver solver(control, Solver::AdditionalData(restart));
  try {
    if (multigrid_)
      solver.solve(*blocks_, solution, rhs, *multigrid_);
    else if (rank_count(communicator_) == 1)
      solver.solve(WholeMatrix{matrix_}, solution, rhs, Factors{*direct_});
    else
      solver.solve(OwnRows{matrix_, rows_, communicator_}, solution, rhs, Factors{*direct_});
  } catch (const dealii::SolverControl::NoConvergence&) {
    return std::nullopt;
  }
  return static_cast<int>(control.last_step());
}

int LinearSolver::solve(const Vector& rhs, Vector& solution, double reduction) {
  std::optional<int> iterations;
  int abandoned = 0;
  solution.reinit(rhs);
  if (!current_) {
    // GMRES goes on as long as it can be cheaper than to prepare and to start anew.
    const unsigned int limit = direct_ ? max_with_old_factors : usual_ + preparation;
    iterations = gmres(rhs, solution, reduction, limit);
    if (!iterations) {
      prepare();
      abandoned = static_cast<int>(limit);
      if (!std::isfinite(solution.l2_norm())) solution = 0.;
    }
  }
  if (!iterations && direct_) {
    direct_->solve(rhs, solution);
    return 1;
  }
  if (!iterations) {
    iterations = gmres(rhs, solution, reduction, max_iterations);
    if (!iterations)
      throw SolverError("GMRES did not converge in " + std::to_string(max_iterations) +
                        " iterations");
    usual_ = std::max(usual_, static_cast<unsigned int>(*iterations));
  }
  if (!std::isfinite(solution.l2_norm())) throw SolverError("the stiffness matrix is singular");
  return abandoned + *iterations;
}

}  // namespace ciliaval::fem::solid::solvers
