// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <deal.II/lac/lapack_support.h>

#include <Eigen/Core>
#include <cassert>
#include <cstddef>
#include <vector>

namespace ciliaval::fem::beam {

/// Square matrix whose entries (i, j) vanish for |i − j| above the half bandwidth, with its LU
/// factorisation by partial pivoting (LAPACK's dgbtrf and dgbtrs). For systems that are much longer
/// than wide: 2 n k² operations, twice as many where rows are exchanged.
class BandMatrix {
 public:
  BandMatrix() = default;
  BandMatrix(std::size_t size, std::size_t half_bandwidth);

  /// Also forgets the factors.
  void set_zero();
  /// Adds to the entry (i, j), |i − j| ≤ half bandwidth, of a matrix that is not factorised.
  void add(std::size_t i, std::size_t j, double value) {
    assert(i <= j + half_bandwidth_ && j <= i + half_bandwidth_);
    const auto row = static_cast<Eigen::Index>(2 * half_bandwidth_ + i - j);
    entries_(row, static_cast<Eigen::Index>(j)) += value;
  }

  bool is_finite() const { return entries_.allFinite(); }
  /// Puts the factors in place of the entries; false if a pivot vanishes: the matrix is singular,
  /// and good for set_zero() only.
  [[nodiscard]] bool factorize();
  /// Replaces the right-hand side by the solution, with the factors.
  void solve(Eigen::VectorXd& right_hand_side) const;

 private:
  std::size_t half_bandwidth_ = 0;
  /// Column by column (i, j) at row 2 k + i − j; pivoting fills the first k rows.
  Eigen::MatrixXd entries_;
  std::vector<dealii::types::blas_int> pivots_;
};

}  // namespace ciliaval::fem::beam
