// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/direct_solver.h"

#include <petscksp.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <span>
#include <string>
#include <vector>

#include "problem/error.h"

namespace ciliaval::fem {
namespace {

/// PETSc's errors are those of one rank: the others wait for it.
void check(PetscErrorCode code) {
  if (code == 0) return;
  const char* text = nullptr;
  PetscErrorMessage(code, &text, nullptr);
  const std::string message = std::string("the linear solver failed: ") +
                              (text != nullptr ? text : "PETSc error " + std::to_string(code));
  if (rank_count() > 1) throw RankFailure("rank " + std::to_string(rank()) + ": " + message);
  throw SolverError(message);
}

PetscInt to_petsc(std::size_t value) {
  return static_cast<PetscInt>(value);
}

}  // namespace

struct DirectSolver::Handles {
  Mat matrix = nullptr;
  KSP solver = nullptr;
  Vec rhs = nullptr;
  Vec solution = nullptr;
  RowRange own;

  Handles() = default;
  Handles(const Handles&) = delete;
  Handles& operator=(const Handles&) = delete;
  ~Handles() {
    PetscBool ended = PETSC_FALSE;
    PetscFinalized(&ended);
    // On several ranks these wait for the others, which may not come where one rank has failed.
    if (ended || (std::uncaught_exceptions() > 0 && rank_count() > 1)) return;
    KSPDestroy(&solver);
    MatDestroy(&matrix);
    VecDestroy(&rhs);
    VecDestroy(&solution);
  }
};

DirectSolver::DirectSolver(const dealii::SparsityPattern& pattern, Kind kind) : kind_(kind) {
  start_mpi();
  handles_ = std::make_unique<Handles>();
  Handles& h = *handles_;
  h.own = own_range(pattern.n_rows());
  std::vector<PetscInt> inside;
  std::vector<PetscInt> outside;
  const bool symmetric = kind == Kind::symmetric_part;
  for (Row row = h.own.begin; row < h.own.end; ++row) {
    inside.push_back(0);
    outside.push_back(0);
    for (auto entry = pattern.begin(row); entry != pattern.end(row); ++entry)
      if (!symmetric || entry->column() >= row)
        ++(h.own.contains(entry->column()) ? inside : outside).back();
  }
  const PetscInt size = to_petsc(pattern.n_rows());
  const PetscInt own = to_petsc(h.own.end - h.own.begin);
  if (symmetric)  // the upper triangle
    check(MatCreateSBAIJ(PETSC_COMM_WORLD, 1, own, own, size, size, 0, inside.data(), 0,
                         outside.data(), &h.matrix));
  else
    check(MatCreateAIJ(PETSC_COMM_WORLD, own, own, size, size, 0, inside.data(), 0, outside.data(),
                       &h.matrix));
  check(MatSetOption(h.matrix, MAT_NEW_NONZERO_ALLOCATION_ERR, PETSC_TRUE));
  check(MatCreateVecs(h.matrix, &h.solution, &h.rhs));
  check(KSPCreate(PETSC_COMM_WORLD, &h.solver));
  check(KSPSetType(h.solver, KSPPREONLY));
  check(KSPSetOperators(h.solver, h.matrix, h.matrix));
  PC pc = nullptr;
  check(KSPGetPC(h.solver, &pc));
  check(PCSetType(pc, symmetric ? PCCHOLESKY : PCLU));
  check(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  check(PCFactorSetUpMatSolverType(pc));
  Mat factor = nullptr;
  check(PCFactorGetMatrix(pc, &factor));
  check(MatMumpsSetIcntl(factor, 14, 60));  // % of memory above the estimate, for pivoting
  check(MatMumpsSetIcntl(factor, 8, 0));    // no scaling: it costs a fifth of the factorisation
}

DirectSolver::~DirectSolver() = default;

void DirectSolver::factorize(const dealii::SparseMatrix<double>& matrix, RowRange rows) {
  const Handles& h = *handles_;
  check(MatZeroEntries(h.matrix));
  const bool symmetric = kind_ == Kind::symmetric_part;
  std::vector<PetscInt> columns;
  std::vector<double> values;
  for (Row row = rows.begin; row < rows.end; ++row) {
    columns.clear();
    values.clear();
    const PetscInt index = to_petsc(row);
    // The zeros too where they are stored, so that the pattern is the same for all matrices.
    for (auto entry = matrix.begin(row); entry != matrix.end(row); ++entry) {
      if (!h.own.contains(row) && entry->value() == 0) continue;
      const PetscInt column = to_petsc(entry->column());
      const double value = symmetric && column != index ? entry->value() / 2 : entry->value();
      if (symmetric && column < index) {
        check(MatSetValues(h.matrix, 1, &column, 1, &index, &value, ADD_VALUES));
      } else {
        columns.push_back(column);
        values.push_back(value);
      }
    }
    check(MatSetValues(h.matrix, 1, &index, to_petsc(columns.size()), columns.data(), values.data(),
                       ADD_VALUES));
  }
  check(MatAssemblyBegin(h.matrix, MAT_FINAL_ASSEMBLY));
  check(MatAssemblyEnd(h.matrix, MAT_FINAL_ASSEMBLY));
  check(KSPSetOperators(h.solver, h.matrix, h.matrix));
  check(KSPSetUp(h.solver));
  PC pc = nullptr;
  check(KSPGetPC(h.solver, &pc));
  PCFailedReason reason = PC_NOERROR;
  check(PCGetFailedReason(pc, &reason));
  if (reason == PC_FACTOR_OUTMEMORY)
    throw SolverError("the memory does not suffice to factorise the stiffness matrix");
  if (reason != PC_NOERROR) throw SolverError("the stiffness matrix is singular");
}

void DirectSolver::solve(const dealii::Vector<double>& rhs,
                         dealii::Vector<double>& solution) const {
  const Handles& h = *handles_;
  const auto own = static_cast<std::ptrdiff_t>(h.own.end - h.own.begin);
  const auto first = static_cast<std::ptrdiff_t>(h.own.begin);
  double* array = nullptr;
  check(VecGetArray(h.rhs, &array));
  std::copy(rhs.begin() + first, rhs.begin() + first + own, array);
  check(VecRestoreArray(h.rhs, &array));
  check(KSPSolve(h.solver, h.rhs, h.solution));
  solution.reinit(rhs.size(), true);
  const double* result = nullptr;
  check(VecGetArrayRead(h.solution, &result));
  std::copy(result, result + own, solution.begin() + first);
  check(VecRestoreArrayRead(h.solution, &result));
  gather_over_ranks({solution.begin(), solution.size()});
  if (!std::isfinite(solution.l2_norm())) throw SolverError("the stiffness matrix is singular");
}

}  // namespace ciliaval::fem
