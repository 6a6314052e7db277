// SPDX-License-Identifier: LGPL-2.1-or-later
#include "problem/support/rotation.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <numbers>
#include <random>

namespace ciliaval::support {
namespace {

// Also as near to the opposite direction as numbers go, where 1 + cos θ cancels.
TEST(TurnTo, IsTheShortestTurnToTheDirection) {
  std::mt19937 random(20261127);
  std::uniform_real_distribution<double> uniform;
  for (int i = 0; i < 2000; ++i) {
    const double from_opposite = std::pow(10.0, -18 * uniform(random));  // sin θ
    const double azimuth = 2 * std::numbers::pi * uniform(random);
    const double z = std::sqrt(std::max(0.0, 1 - from_opposite * from_opposite));
    const Vector3 direction(from_opposite * std::cos(azimuth), from_opposite * std::sin(azimuth),
                            i % 2 == 0 ? z : -z);
    const Quaternion turn = turn_to(3 * direction);
    EXPECT_NEAR(turn.norm(), 1, 1e-15);
    EXPECT_LT((turn * Vector3::UnitZ() - direction).norm(), 8 * epsilon)  // measured: 5 ε
        << direction.transpose();
    EXPECT_EQ(turn.z(), 0);  // the axis lies across both
    EXPECT_GE(turn.w(), 0);  // by half a turn at most
  }
  EXPECT_EQ(turn_to(Vector3::UnitZ()).coeffs(), Quaternion::Identity().coeffs());
  EXPECT_EQ(turn_to(-Vector3::UnitZ()).coeffs(), Quaternion(0, 1, 0, 0).coeffs());
}

TEST(PolarRotation, LeavesASymmetricPositiveStretch) {
  std::mt19937 random(20261128);
  std::uniform_real_distribution<double> uniform(-1, 1);
  int drawn = 0;
  while (drawn < 500) {
    const Matrix3 F = Matrix3::NullaryExpr([&] { return uniform(random); });
    if (F.determinant() < 0.05) continue;
    ++drawn;
    const Matrix3 R = polar_rotation(F);
    const Matrix3 U = R.transpose() * F;
    EXPECT_LT((R * R.transpose() - Matrix3::Identity()).norm(), 1e-14);
    EXPECT_GT(R.determinant(), 0);
    EXPECT_LT((U - U.transpose()).norm(), 1e-14);
    // Sylvester: all leading minors are positive.
    EXPECT_GT(U(0, 0), 0);
    EXPECT_GT((U.topLeftCorner<2, 2>().determinant()), 0);
  }
}

}  // namespace
}  // namespace ciliaval::support
