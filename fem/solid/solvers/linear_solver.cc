// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/solvers/linear_solver.h"

#include <deal.II/lac/solver_control.h>
#include <deal.II/lac/solver_gmres.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "problem/error.h"

namespace ciliaval::fem::solid::solvers {
using namespace discretisation;
namespace {

constexpr unsigned int max_iterations = 300;
constexpr unsigned int restart = 60;  ///< vectors of GMRES
/// Iterations with the LU of another matrix, beyond which the LU of the own one is cheaper.
constexpr unsigned int max_with_old_factors = 20;

/// Unknowns beyond which `automatic` is `iterative` (docs/measurements/solid.md).
constexpr dealii::types::global_dof_index direct_unknowns = 100000;

/// The matrix on one rank, block CSR of the rank's rows on several.
struct Product {
  const dealii::SparseMatrix<double>& matrix;
  const BlockCsr<double>& own;
  bool several_ranks;
  void vmult(dealii::Vector<double>& y, const dealii::Vector<double>& x) const {
    if (several_ranks)
      own.vmult(y, x);
    else
      matrix.vmult(y, x);
  }
};

struct Factors {
  const DirectSolver& solver;
  void vmult(dealii::Vector<double>& x, const dealii::Vector<double>& b) const {
    solver.solve(b, x);
  }
};

}  // namespace

LinearSolver::LinearSolver(const SolidSpace& space,
                           const dealii::AffineConstraints<double>& constraints,
                           const dealii::SparsityPattern& pattern, SolverKind kind,
                           MPI_Comm communicator)
    : communicator_(communicator),
      rows_(own_range(communicator, space.unknowns())),
      own_(rows_, communicator) {
  if (kind == SolverKind::iterative ||
      (kind == SolverKind::automatic && space.unknowns() > direct_unknowns))
    multigrid_ = std::make_unique<Multigrid>(space, constraints, rows_, communicator);
  else
    direct_ =
        std::make_unique<DirectSolver>(pattern, DirectSolver::Kind::general, rows_, communicator);
}

void LinearSolver::take(const dealii::SparseMatrix<double>& matrix) {
  matrix_ = &matrix;
  current_ = false;
  if (rank_count(communicator_) > 1) own_.update(matrix);
}

void LinearSolver::prepare(const dealii::SparseMatrix<double>& matrix) {
  take(matrix);
  update();
}

void LinearSolver::prepare_near_last(const dealii::SparseMatrix<double>& matrix) {
  const bool is_first = matrix_ == nullptr;
  take(matrix);
  if (is_first) update();
}

void LinearSolver::update() {
  if (multigrid_)
    multigrid_->update(*matrix_);
  else
    direct_->factorize(*matrix_);
  current_ = true;
  usual_ = 0;
}

std::optional<int> LinearSolver::gmres(const dealii::Vector<double>& rhs,
                                       dealii::Vector<double>& solution, double reduction,
                                       unsigned int max_iterations) const {
  using Vector = dealii::Vector<double>;
  // Flexible, for the multigrid rounds to single precision and is not quite linear.
  using Solver = dealii::SolverFGMRES<Vector>;
  dealii::SolverControl control(max_iterations, reduction * rhs.l2_norm());
  Solver solver(control, Solver::AdditionalData(restart));
  const Product matrix{*matrix_, own_, rank_count(communicator_) > 1};
  solution.reinit(rhs.size());
  try {
    if (multigrid_)
      solver.solve(matrix, solution, rhs, *multigrid_);
    else
      solver.solve(matrix, solution, rhs, Factors{*direct_});
  } catch (const dealii::SolverControl::NoConvergence&) {
    return std::nullopt;
  }
  return static_cast<int>(control.last_step());
}

int LinearSolver::solve(const dealii::Vector<double>& rhs, dealii::Vector<double>& solution,
                        double reduction) {
  std::optional<int> iterations;
  if (!current_) {
    const unsigned int limit = direct_ ? max_with_old_factors : 2 * usual_;
    iterations = gmres(rhs, solution, reduction, limit);
    if (!iterations) update();
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
  return *iterations;
}

}  // namespace ciliaval::fem::solid::solvers
