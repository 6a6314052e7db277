// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/beam/stability/stability.h"

#include <deal.II/base/config.h>
#include <deal.II/base/types.h>

#include <algorithm>
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

/// ∫ N_a u dS/L of the displacements u, nothing of the other unknowns.
Eigen::VectorXd weighed(const System& system, const State& state, const Eigen::VectorXd& u) {
  const ReferenceElement& element = system.reference_element();
  const Eigen::Map<const Eigen::VectorXd> weights(element.weights.data(),
                                                  static_cast<Index>(element.n_points()));
  Eigen::VectorXd result = Eigen::VectorXd::Zero(u.size());
  for (std::size_t e = 0; e < system.mesh().n_elements(); ++e) {
    const double length =
        (system.vertex_arclength(state, e + 1) - system.vertex_arclength(state, e)) /
        system.length_scale();
    for (std::size_t c = 0; c < 3; ++c) {
      std::vector<Index> unknowns;
      for (std::size_t a = 0; a < element.n_nodes(); ++a)
        unknowns.push_back(
            static_cast<Index>(system.node_unknown(e * system.mesh().degree + a, c)));
      const Eigen::VectorXd at_points = length * weights.cwiseProduct(element.values * u(unknowns));
      result(unknowns) += element.values.transpose() * at_points;
    }
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

Eigenpair smallest_eigenvalue(System& system, const State& state, const Loads& loads,
                              int unstable_modes) {
  system.factorize(state, loads);
  return smallest_eigenpair({static_cast<Index>(system.n_unknowns()),
                             [&](const Eigen::VectorXd& f) { return system.solve(f); },
                             [&](const Eigen::VectorXd& u) { return weighed(system, state, u); }},
                            unstable_modes);
}

}  // namespace ciliaval::fem::beam::stability
