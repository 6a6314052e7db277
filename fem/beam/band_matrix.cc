// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/beam/band_matrix.h"

#include <deal.II/base/config.h>

#include "problem/error.h"

#ifndef DEAL_II_WITH_LAPACK
#error "deal.II must be built with LAPACK"
#endif

// LAPACK's Fortran interface, which deal.II declares only where it uses it itself.
extern "C" {
void DEAL_II_FORTRAN_MANGLE(dgbtrf, DGBTRF)(const int* rows, const int* columns, const int* lower,
                                            const int* upper, double* entries, const int* stride,
                                            int* pivots, int* info);
void DEAL_II_FORTRAN_MANGLE(dgbtrs, DGBTRS)(const char* transposed, const int* size,
                                            const int* lower, const int* upper, const int* systems,
                                            const double* factors, const int* stride,
                                            const int* pivots, double* right_hand_sides,
                                            const int* distance, int* info);
}

namespace ciliaval::fem::beam {

using Eigen::Index;

BandMatrix::BandMatrix(std::size_t size, std::size_t half_bandwidth)
    : half_bandwidth_(half_bandwidth),
      entries_(static_cast<Index>(3 * half_bandwidth + 1), static_cast<Index>(size)),
      pivots_(size) {
  entries_.setZero();
}

void BandMatrix::set_zero() {
  entries_.setZero();
}

void BandMatrix::factorize() {
  if (!entries_.allFinite()) throw SolverError("is not a number");
  const auto size = static_cast<int>(entries_.cols());
  const auto width = static_cast<int>(half_bandwidth_);
  const auto stride = static_cast<int>(entries_.rows());
  int info = 0;
  DEAL_II_FORTRAN_MANGLE(dgbtrf, DGBTRF)
  (&size, &size, &width, &width, entries_.data(), &stride, pivots_.data(), &info);
  if (info != 0) throw SolverError("is singular");
}

void BandMatrix::solve(Eigen::VectorXd& right_hand_side) const {
  const auto size = static_cast<int>(entries_.cols());
  const auto width = static_cast<int>(half_bandwidth_);
  const auto stride = static_cast<int>(entries_.rows());
  const int systems = 1;
  int info = 0;
  DEAL_II_FORTRAN_MANGLE(dgbtrs, DGBTRS)
  ("N", &size, &width, &width, &systems, entries_.data(), &stride, pivots_.data(),
   right_hand_side.data(), &size, &info);
}

}  // namespace ciliaval::fem::beam
