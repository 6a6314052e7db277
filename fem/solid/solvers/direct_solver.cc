// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/solvers/direct_solver.h"

#include <deal.II/base/mpi.h>
#include <dmumps_c.h>
#include <metis.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <string>
#include <vector>

#include "fem/parallel.h"
#include "problem/error.h"
#include "problem/support/interruption.h"

namespace ciliaval::fem::solid::solvers {
using namespace discretisation;
namespace {

using dealii::SparsityPattern;

// MUMPS's jobs (users' guide 5.5, section 5.1) …
constexpr int start = -1;
constexpr int end = -2;
constexpr int analyse_pattern = 1;
constexpr int factorize_matrix = 2;
constexpr int solve_system = 3;
// … and error codes (section 8).
constexpr int main_workspace_too_small = -9;
constexpr int singular = -10;
constexpr int integer_workspace_too_small = -8;
constexpr int not_enough_memory = -13;

/// Memory beyond MUMPS's estimate, %, for pivoting: first value and largest one.
constexpr int first_margin = 60;
constexpr int largest_margin = 1000;

/// The position of each unknown, from 1, in a nested dissection of the graph of the nodes.
std::vector<MUMPS_INT> nested_dissection(const SparsityPattern& pattern) {
  auto nodes = static_cast<idx_t>(pattern.n_rows() / node_unknowns);
  std::vector<idx_t> starts{0};
  std::vector<idx_t> neighbours;
  for (Row row = 0; row < pattern.n_rows(); row += node_unknowns) {
    for (auto entry = pattern.begin(row); entry != pattern.end(row); ++entry)
      if (entry->column() % node_unknowns == 0 && entry->column() != row)
        neighbours.push_back(static_cast<idx_t>(entry->column() / node_unknowns));
    starts.push_back(static_cast<idx_t>(neighbours.size()));
  }
  std::vector<idx_t> order(static_cast<std::size_t>(nodes));
  std::vector<idx_t> positions(order.size());
  if (METIS_NodeND(&nodes, starts.data(), neighbours.data(), nullptr, nullptr, order.data(),
                   positions.data()) != METIS_OK)
    return {};
  std::vector<MUMPS_INT> result;
  for (const idx_t position : positions)
    for (Row k = 1; k <= node_unknowns; ++k)
      result.push_back(position * static_cast<MUMPS_INT>(node_unknowns) +
                       static_cast<MUMPS_INT>(k));
  return result;
}

}  // namespace

struct DirectSolver::Mumps {
  DMUMPS_STRUC_C data{};
  std::vector<MUMPS_INT> rows;
  std::vector<MUMPS_INT> columns;
  std::vector<double> values;
  std::vector<MUMPS_INT> order;
  const bool alone;

  /// An option by its number in the users' guide.
  MUMPS_INT& option(std::size_t number) { return data.icntl[number - 1]; }

  /// MUMPS's code: 0, a warning above, or an error below, the same on all ranks.
  int run(int job) {
    data.job = job;
    dmumps_c(&data);
    return data.infog[0];
  }

  Mumps(Kind kind, MPI_Comm communicator) : alone(rank_count(communicator) == 1) {
    data.par = 1;
    data.sym = kind == Kind::symmetric_part ? 2 : 0;
    data.comm_fortran = MPI_Comm_c2f(communicator);
    check(run(start));
    for (const std::size_t output : {1, 2, 3}) option(output) = -1;
    option(4) = 0;
    option(6) = 0;  // no columns permuted to large diagonals: a stiffness matrix has them
    option(8) = 0;  // no scaling: it gains nothing
    // ScaLAPACK would not count the negative pivots of the last front.
    if (kind == Kind::symmetric_part) option(13) = 1;
    option(18) = alone ? 0 : 3;                           // each rank gives its own entries
    option(15) = -static_cast<MUMPS_INT>(node_unknowns);  // the pattern is analysed node by node
    option(14) = first_margin;
  }
  Mumps(const Mumps&) = delete;
  Mumps& operator=(const Mumps&) = delete;
  ~Mumps() {
    int ended = 0;
    MPI_Finalized(&ended);
    // On several ranks this waits for the others, which may not come where one rank has failed.
    if (ended == 0 && (std::uncaught_exceptions() == 0 || alone)) run(end);
  }

  void check(int code) const {
    if (code >= 0) return;
    if (code == singular) throw SolverError("the stiffness matrix is singular");
    if (code == not_enough_memory || code == main_workspace_too_small ||
        code == integer_workspace_too_small)
      throw SolverError("the memory does not suffice to factorise the stiffness matrix");
    throw SolverError("the linear solver failed: MUMPS's error " + std::to_string(code) + ", " +
                      std::to_string(data.infog[1]));
  }
};

DirectSolver::DirectSolver(const SparsityPattern& pattern, Kind kind, RowRange rows,
                           MPI_Comm communicator)
    : kind_(kind), rows_(rows), communicator_(communicator) {
  start_mpi();
  mumps_ = std::make_unique<Mumps>(kind, communicator);
  analyse(pattern);
}

DirectSolver::~DirectSolver() = default;

void DirectSolver::analyse(const SparsityPattern& pattern) {
  support::check_interruption();
  Mumps& m = *mumps_;
  const bool symmetric = kind_ == Kind::symmetric_part;
  std::size_t entries = 0;
  for (Row row = rows_.begin; row < rows_.end; ++row) entries += pattern.row_length(row);
  m.rows.resize(entries);
  m.columns.resize(entries);
  std::size_t k = 0;
  for (Row row = rows_.begin; row < rows_.end; ++row)
    for (auto entry = pattern.begin(row); entry != pattern.end(row); ++entry, ++k) {
      const auto i = static_cast<MUMPS_INT>(row) + 1;
      const auto j = static_cast<MUMPS_INT>(entry->column()) + 1;
      m.rows[k] = symmetric ? std::min(i, j) : i;
      m.columns[k] = symmetric ? std::max(i, j) : j;
    }
  m.values.resize(entries);
  m.data.n = static_cast<MUMPS_INT>(pattern.n_rows());
  m.data.nnz = m.data.nnz_loc = static_cast<MUMPS_INT8>(entries);
  m.data.irn = m.data.irn_loc = m.rows.data();
  m.data.jcn = m.data.jcn_loc = m.columns.data();
  m.data.a = m.data.a_loc = m.values.data();
  // MUMPS's own choice, PORD, has fewer operations, but two ranks gain little with it
  // (docs/theory/solid.md).
  if (!m.alone && rank(communicator_) == 0) {
    m.order = nested_dissection(pattern);
    if (!m.order.empty()) m.option(7) = 1;
    m.data.perm_in = m.order.data();
  }
  m.check(m.run(analyse_pattern));
}

void DirectSolver::factorize(const dealii::SparseMatrix<double>& matrix) {
  support::check_interruption();
  Mumps& m = *mumps_;
  const double off_diagonal = kind_ == Kind::symmetric_part ? 0.5 : 1;
  std::size_t k = 0;
  for (Row row = rows_.begin; row < rows_.end; ++row)
    for (auto entry = matrix.begin(row); entry != matrix.end(row); ++entry)
      m.values[k++] = entry->column() == row ? entry->value() : off_diagonal * entry->value();
  int code = m.run(factorize_matrix);
  while ((code == main_workspace_too_small || code == integer_workspace_too_small) &&
         m.option(14) < largest_margin) {
    m.option(14) *= 2;
    code = m.run(factorize_matrix);
  }
  m.check(code);
}

int DirectSolver::negative_eigenvalues() const {
  return mumps_->data.infog[11];
}

void DirectSolver::solve(const Vector& rhs, Vector& solution) const {
  Mumps& m = *mumps_;
  solution = rhs;
  if (rank(communicator_) == 0) {
    m.data.rhs = solution.begin();
    m.data.nrhs = 1;
    m.data.lrhs = m.data.n;
  }
  m.check(m.run(solve_system));
  dealii::Utilities::MPI::broadcast(solution.begin(), solution.size(), 0, communicator_);
  if (!std::isfinite(solution.l2_norm())) throw SolverError("the stiffness matrix is singular");
}

}  // namespace ciliaval::fem::solid::solvers
