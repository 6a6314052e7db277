// SPDX-License-Identifier: LGPL-2.1-or-later
// The statement of ASME V&V 20 and χ², against figures by hand and by SciPy.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>

#include "compare/validation/statistics.h"

namespace ciliaval::compare::validation {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// By hand: 0.03² + 0.04² + 0.12² = 0.13².
TEST(Assessment, BoundsAnErrorBeyondTwiceTheUncertaintyAndOnlySuchAnOne) {
  const Uncertainties u{.numerical = 0.03, .input = 0.04, .measured = 0.12};
  const Assessment seen = assess(4.6, 5.0, u);
  EXPECT_NEAR(seen.error, -0.4, 1e-15);
  EXPECT_NEAR(seen.u_val, 0.13, 1e-15);
  EXPECT_NEAR(seen.least, 0.14, 1e-15);
  EXPECT_NEAR(seen.bound, 0.66, 1e-15);
  EXPECT_EQ(seen.verdict, Verdict::bounded);
  const Assessment hidden = assess(5.2, 5.0, u);
  EXPECT_NEAR(hidden.error, 0.2, 1e-15);
  EXPECT_EQ(hidden.least, 0);
  EXPECT_NEAR(hidden.bound, 0.46, 1e-15);
  EXPECT_EQ(hidden.verdict, Verdict::not_resolved);
  // Each of the three counts: without it the second would be seen.
  EXPECT_EQ(assess(5.2, 5.0, {0.03, 0.04, 0.08}).verdict, Verdict::bounded);
  EXPECT_EQ(assess(5.2, 5.0, {0.0999, 0, 0}).verdict, Verdict::bounded);
  EXPECT_EQ(assess(5.2, 5.0, {0, 0.101, 0}).verdict, Verdict::not_resolved);
}

TEST(ChiSquared, IsTheSumOfSquaresWithoutInputs) {
  const VectorXd E = VectorXd{{1, -2, 3}};
  const VectorXd variances = VectorXd{{1, 4, 9}};
  EXPECT_NEAR(chi_squared(E, variances, MatrixXd(3, 0)).value(), 3, 1e-14);
}

// By hand: V = [[2, 1], [1, 2]], V⁻¹ = [[2, −1], [−1, 2]]/3. The input explains the common error of
// both values, but not their difference.
TEST(ChiSquared, TakesAnInputsErrorForTheSameAtAllValues) {
  const VectorXd variances = VectorXd::Ones(2);
  const MatrixXd C = MatrixXd::Ones(2, 1);
  EXPECT_NEAR(chi_squared(VectorXd{{1, 1}}, variances, C).value(), 2.0 / 3, 1e-14);
  EXPECT_NEAR(chi_squared(VectorXd{{1, -1}}, variances, C).value(), 2, 1e-14);
}

// Oracle: SciPy 1.10, E @ linalg.solve(diag(un² + uD²) + C C^T, E); with the diagonal alone it
// would be 6.88.
TEST(ChiSquared, IsThatOfSciPy) {
  const VectorXd E = VectorXd{{0.4, -0.3, 0.55, 0.1}};
  const VectorXd un = VectorXd{{0.01, 0.02, 0.03, 0.04}};
  const VectorXd uD = VectorXd{{0.1, 0.12, 0.14, 0.16}};
  const MatrixXd C = MatrixXd{{0.2, 0.05}, {0.25, -0.1}, {0.3, 0.02}, {0.1, 0.3}};
  const VectorXd variances = un.cwiseAbs2() + uD.cwiseAbs2();
  constexpr double expected = 22.982346735965347;
  EXPECT_NEAR(chi_squared(E, variances, C).value(), expected, 1e-12);
  // Whatever the units, which differ between values of a field in T and of a place in m.
  const VectorXd units = VectorXd{{1e-9, 1, 1e6, 1e-3}};
  EXPECT_NEAR(chi_squared(units.cwiseProduct(E), units.cwiseAbs2().cwiseProduct(variances),
                          units.asDiagonal() * C)
                  .value(),
              expected, 1e-11);
}

TEST(ChiSquared, IsNotKnownWithoutUncertainties) {
  EXPECT_FALSE(chi_squared(VectorXd{{1, 2}}, VectorXd::Zero(2), MatrixXd::Ones(2, 1)));
  EXPECT_FALSE(chi_squared(VectorXd(0), VectorXd(0), MatrixXd(0, 1)));
}

}  // namespace
}  // namespace ciliaval::compare::validation
