// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/beam/band_matrix.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <limits>
#include <random>

namespace {

using ciliaval::fem::beam::BandMatrix;
using Eigen::Index;

/// Random entries within the band, but for a diagonal of zeros: no elimination without exchanges.
Eigen::MatrixXd saddle(Index size, Index half_bandwidth) {
  std::mt19937 engine(3);
  const auto uniform = [&engine] { return static_cast<double>(engine()) / 2147483648.0 - 1; };
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(size, size);
  for (Index i = 0; i < size; ++i)
    for (Index j = std::max<Index>(0, i - half_bandwidth);
         j <= std::min(size - 1, i + half_bandwidth); ++j)
      dense(i, j) = i == j ? 0 : uniform();
  return dense;
}

BandMatrix band(const Eigen::MatrixXd& dense, std::size_t half_bandwidth) {
  BandMatrix matrix(static_cast<std::size_t>(dense.rows()), half_bandwidth);
  for (Index i = 0; i < dense.rows(); ++i)
    for (Index j = 0; j < dense.cols(); ++j)
      if (dense(i, j) != 0)
        matrix.add(static_cast<std::size_t>(i), static_cast<std::size_t>(j), dense(i, j));
  return matrix;
}

// Oracle: Eigen's dense LU, also where the band is the whole matrix.
TEST(BeamBandMatrix, SolvesAsADenseFactorisation) {
  for (const Index half_bandwidth : {1, 5, 39, 90}) {
    const Eigen::MatrixXd dense = saddle(40, std::min<Index>(half_bandwidth, 39));
    BandMatrix matrix = band(dense, static_cast<std::size_t>(half_bandwidth));
    ASSERT_TRUE(matrix.factorize());
    const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(40, -1, 2);
    const Eigen::VectorXd exact = dense.fullPivLu().solve(b);
    for (int again = 0; again < 2; ++again) {
      Eigen::VectorXd x = b;
      matrix.solve(x);
      EXPECT_LT((x - exact).norm(), 1e-11 * exact.norm()) << half_bandwidth;
    }
  }
}

TEST(BeamBandMatrix, IsFilledAndFactorisedAgain) {
  const Eigen::MatrixXd dense = saddle(30, 4);
  BandMatrix matrix = band(dense, 4);
  ASSERT_TRUE(matrix.factorize());
  matrix.set_zero();
  for (std::size_t i = 0; i < 30; ++i) matrix.add(i, i, 2);
  ASSERT_TRUE(matrix.factorize());
  Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(30, -1, 2);
  const Eigen::VectorXd half = x / 2;
  matrix.solve(x);
  EXPECT_EQ(x, half);
}

TEST(BeamBandMatrix, TellsWhatHasNoFactors) {
  Eigen::MatrixXd dense = saddle(30, 4);
  dense.col(7).setZero();
  BandMatrix singular = band(dense, 4);
  EXPECT_TRUE(singular.is_finite());
  EXPECT_FALSE(singular.factorize());
  for (const double bad :
       {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
    BandMatrix matrix = band(saddle(30, 4), 4);
    matrix.add(3, 5, bad);
    EXPECT_FALSE(matrix.is_finite());
  }
}

}  // namespace
