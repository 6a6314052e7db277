// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/beam/stability/stability.h"

#include <deal.II/base/config.h>
#include <deal.II/base/types.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "problem/error.h"

using dealii::types::blas_int;

// LAPACK's Fortran interface, which deal.II declares only where it uses it itself.
extern "C" {
void DEAL_II_FORTRAN_MANGLE(dsytrf, DSYTRF)(const char* triangle, const blas_int* size,
                                            double* entries, const blas_int* stride,
                                            blas_int* pivots, double* work,
                                            const blas_int* work_size, blas_int* info);
void DEAL_II_FORTRAN_MANGLE(dsytrs, DSYTRS)(const char* triangle, const blas_int* size,
                                            const blas_int* systems, const double* factors,
                                            const blas_int* stride, const blas_int* pivots,
                                            double* right_hand_sides, const blas_int* distance,
                                            blas_int* info);
}

namespace ciliaval::fem::beam::stability {
namespace {

using Eigen::Index;

/// LDLᵀ of a symmetric matrix.
class Factors {
 public:
  explicit Factors(Eigen::MatrixXd matrix)
      : a_(std::move(matrix)),
        n_(static_cast<blas_int>(a_.rows())),
        pivots_(static_cast<std::size_t>(n_)) {
    const blas_int length = 64 * n_;
    std::vector<double> work(static_cast<std::size_t>(length));
    blas_int info = 0;
    DEAL_II_FORTRAN_MANGLE(dsytrf, DSYTRF)
    ("L", &n_, a_.data(), &n_, pivots_.data(), work.data(), &length, &info);
    if (info != 0) throw SolverError("the second variation of the beam is singular");
  }

  /// Negative eigenvalues of D: one of each 2 × 2 block, whose determinant is negative.
  int negative() const {
    int count = 0;
    for (blas_int i = 0; i < n_; ++i) {
      if (pivots_[static_cast<std::size_t>(i)] > 0) {
        count += a_(i, i) < 0 ? 1 : 0;
      } else {
        ++count;
        ++i;
      }
    }
    return count;
  }

  void solve(Eigen::Ref<Eigen::MatrixXd> b) const {
    const auto columns = static_cast<blas_int>(b.cols());
    blas_int info = 0;
    DEAL_II_FORTRAN_MANGLE(dsytrs, DSYTRS)
    ("L", &n_, &columns, a_.data(), &n_, pivots_.data(), b.data(), &n_, &info);
  }

 private:
  Eigen::MatrixXd a_;
  blas_int n_;
  std::vector<blas_int> pivots_;
};

std::vector<Index> free_unknowns(const System& system) {
  std::vector<Index> free;
  for (std::size_t i = 0; i < system.n_unknowns(); ++i)
    if (!system.supported()[i]) free.push_back(static_cast<Index>(i));
  return free;
}

Eigen::MatrixXd symmetric_tangent(const System& system, const State& state, const Loads& loads,
                                  const std::vector<Index>& free) {
  const Eigen::MatrixXd tangent = system.tangent(state, loads)(free, free);
  return (tangent + tangent.transpose()) / 2;
}

/// The length that belongs to each node, over L.
std::vector<double> shares(const System& system, const State& state) {
  const std::size_t nodes = state.position.size();
  std::vector<double> result(nodes, 0);
  for (std::size_t i = 0; i < nodes; ++i) {
    const double below = i == 0 ? 0 : system.node_arclength(state, i - 1);
    const double above = system.node_arclength(state, i + 1 == nodes ? i : i + 1);
    result[i] = (above - below) / (2 * system.length_scale());
  }
  return result;
}

}  // namespace

int unstable_modes(const System& system, const State& state, const Loads& loads) {
  const std::vector<Index> free = free_unknowns(system);
  const Eigen::MatrixXd tangent = symmetric_tangent(system, state, loads, free);
  // Each element with its upper vertex: the one below, or the clamp, holds it.
  const Index block = 12 * static_cast<Index>(system.mesh().degree);
  int negative = 0;
  Index begin = 0;
  Eigen::MatrixXd from_below;
  for (std::size_t e = 0; e < system.mesh().n_elements(); ++e) {
    const Index last = static_cast<Index>(e + 1) * block + 6;
    const Index size = std::ranges::lower_bound(free, last) - free.begin() - begin;
    Eigen::MatrixXd diagonal = tangent.block(begin, begin, size, size);
    if (e > 0) diagonal -= from_below;
    const Factors factors(diagonal);
    negative += factors.negative();
    const Index next = std::min(block, tangent.rows() - begin - size);
    const auto coupling = tangent.block(begin, begin + size, size, next);
    begin += size;
    Eigen::MatrixXd solved = coupling;
    factors.solve(solved);
    from_below = coupling.transpose() * solved;
  }
  return negative - static_cast<int>(6 * state.force.size());
}

Eigenvalue smallest_eigenvalue(const System& system, const State& state, const Loads& loads) {
  const auto all = static_cast<Index>(system.n_unknowns());
  const std::vector<Index> free = free_unknowns(system);
  const Factors factors(symmetric_tangent(system, state, loads, free));

  Eigen::VectorXd weights = Eigen::VectorXd::Zero(all);
  Eigen::VectorXd start = Eigen::VectorXd::Zero(all);
  const std::vector<double> share = shares(system, state);
  for (std::size_t node = 0; node < share.size(); ++node)
    for (std::size_t c = 0; c < 3; ++c) {
      const auto i = static_cast<Index>(system.node_unknown(node, c));
      weights[i] = share[node];
      // Some of every mode.
      start[i] = std::pow(system.node_arclength(state, node) / system.length_scale(), 2) +
                 0.1 * static_cast<double>(c);
    }
  const Eigen::VectorXd w = weights(free);
  Eigen::VectorXd u = start(free);
  double omega = 0;
  constexpr int most = 500;
  for (int k = 0; k < most; ++k) {
    Eigen::VectorXd next = w.cwiseProduct(u);
    factors.solve(next);
    // Rayleigh's quotient of the inverse.
    const double inverse = u.dot(w.cwiseProduct(next)) / u.dot(w.cwiseProduct(u));
    u = next / std::sqrt(next.dot(w.cwiseProduct(next)));
    const double before = omega;
    omega = 1 / inverse;
    if (std::abs(omega - before) <= 1e-13 * std::abs(omega)) break;
  }
  Eigenvalue result;
  result.value = omega;
  result.mode = Eigen::VectorXd::Zero(all);
  for (std::size_t k = 0; k < free.size(); ++k) result.mode[free[k]] = u[static_cast<Index>(k)];
  return result;
}

}  // namespace ciliaval::fem::beam::stability
