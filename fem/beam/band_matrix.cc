// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/beam/band_matrix.h"

#ifndef DEAL_II_WITH_LAPACK
#error "deal.II must be built with LAPACK"
#endif

using dealii::types::blas_int;

// LAPACK's Fortran interface, which deal.II declares only where it uses it itself.
extern "C" {
void DEAL_II_FORTRAN_MANGLE(dgbtrf, DGBTRF)(const blas_int* rows, const blas_int* columns,
                                            const blas_int* lower, const blas_int* upper,
                                            double* entries, const blas_int* stride,
                                            blas_int* pivots, blas_int* info);
void DEAL_II_FORTRAN_MANGLE(dgbtrs, DGBTRS)(const char* transposed, const blas_int* size,
                                            const blas_int* lower, const blas_int* upper,
                                            const blas_int* systems, const double* factors,
                                            const blas_int* stride, const blas_int* pivots,
                                            double* right_hand_sides, const blas_int* distance,
                                            blas_int* info);
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

bool BandMatrix::factorize() {
  const auto size = static_cast<blas_int>(entries_.cols());
  const auto width = static_cast<blas_int>(half_bandwidth_);
  const auto stride = static_cast<blas_int>(entries_.rows());
  blas_int info = 0;
  DEAL_II_FORTRAN_MANGLE(dgbtrf, DGBTRF)
  (&size, &size, &width, &width, entries_.data(), &stride, pivots_.data(), &info);
  assert(info >= 0);
  return info == 0;
}

void BandMatrix::solve(Eigen::VectorXd& right_hand_side) const {
  assert(right_hand_side.size() == entries_.cols());
  const auto size = static_cast<blas_int>(entries_.cols());
  const auto width = static_cast<blas_int>(half_bandwidth_);
  const auto stride = static_cast<blas_int>(entries_.rows());
  const blas_int systems = 1;
  blas_int info = 0;
  DEAL_II_FORTRAN_MANGLE(dgbtrs, DGBTRS)
  ("N", &size, &width, &width, &systems, entries_.data(), &stride, pivots_.data(),
   right_hand_side.data(), &size, &info);
  assert(info == 0);
}

}  // namespace ciliaval::fem::beam
