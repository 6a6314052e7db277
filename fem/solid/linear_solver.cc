// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/linear_solver.h"

#include <deal.II/lac/solver_control.h>
#include <deal.II/lac/solver_gmres.h>

#include <cmath>
#include <string>

#include "problem/error.h"

namespace ciliaval::fem {
namespace {

constexpr unsigned int max_iterations = 300;
constexpr unsigned int restart = 60;  ///< vectors of GMRES

}  // namespace

LinearSolver::LinearSolver(const SolidSpace& space,
                           const dealii::AffineConstraints<double>& constraints,
                           const dealii::SparsityPattern& pattern, SolverKind kind) {
  start_mpi();
  rows_ = own_range(space.unknowns());
  if (kind == SolverKind::automatic)
    kind = space.unknowns() > direct_unknowns ? SolverKind::iterative : SolverKind::direct;
  if (kind == SolverKind::iterative)
    multigrid_ = std::make_unique<Multigrid>(space, constraints, rows_);
  else
    direct_ = std::make_unique<DirectSolver>(pattern);
}

void LinearSolver::prepare(const dealii::SparseMatrix<double>& matrix) {
  matrix_ = &matrix;
  if (multigrid_)
    multigrid_->update(matrix);
  else
    direct_->factorize(matrix, rows_);
}

int LinearSolver::solve(const dealii::Vector<double>& rhs, dealii::Vector<double>& solution,
                        double reduction) const {
  if (direct_) {
    direct_->solve(rhs, solution);
    return 1;
  }
  using Vector = dealii::Vector<double>;
  dealii::SolverControl control(max_iterations, reduction * rhs.l2_norm());
  // The flexible variant: the multigrid rounds to single precision, so that it is not quite linear,
  // which the stiffness of the volume would amplify when the solution is put together.
  dealii::SolverFGMRES<Vector> gmres(control,
                                     dealii::SolverFGMRES<Vector>::AdditionalData(restart));
  solution.reinit(rhs.size());
  try {
    gmres.solve(RowMatrix(*matrix_, rows_), solution, rhs, *multigrid_);
  } catch (const dealii::SolverControl::NoConvergence& failure) {
    throw SolverError("GMRES did not converge in " + std::to_string(failure.last_step) +
                      " iterations");
  }
  if (!std::isfinite(solution.l2_norm())) throw SolverError("the stiffness matrix is singular");
  return static_cast<int>(control.last_step());
}

}  // namespace ciliaval::fem
