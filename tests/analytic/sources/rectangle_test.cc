// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "analytic/sources/charged_disc.h"
#include "analytic/sources/charged_rectangle.h"
#include "problem/lagrange.h"

namespace ciliaval::analytic {
namespace {

using std::numbers::pi;

/// ∫∫ (x − x′)/(4π|x − x′|³) by Gauss's rule on n × n parts of 8 × 8 points.
Vector3 by_quadrature(const std::array<double, 2>& half, const Vector3& x, int n) {
  const QuadratureRule rule = gauss_legendre(8);
  Vector3 sum = Vector3::Zero();
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (std::size_t p = 0; p < 8; ++p)
        for (std::size_t q = 0; q < 8; ++q) {
          const double u = half[0] * ((2 * i + 1 + rule.nodes[p]) / n - 1);
          const double v = half[1] * ((2 * j + 1 + rule.nodes[q]) / n - 1);
          const Vector3 offset = x - Vector3(u, v, 0);
          sum += rule.weights[p] * rule.weights[q] / (n * n) * offset / std::pow(offset.norm(), 3);
        }
  return half[0] * half[1] / (4 * pi) * sum;
}

// Oracle: Gauss's rule, near and far, beside the face and on the lines of its edges.
TEST(ChargedRectangle, IsTheIntegralOverItsFace) {
  const std::array<double, 2> half{2.5, 0.42};
  for (const Vector3& x : std::vector<Vector3>{{0, 0, 1},
                                               {0.3, -0.2, -0.7},
                                               {2.5, 0.1, 0.9},
                                               {2.5, 0.42, 1.2},
                                               {4, 0.42, 0},
                                               {-3.5, -0.42, 0},
                                               {2.5, -3, 0},
                                               {-6, 2, 3},
                                               {0, 9, 0},
                                               {20, -30, 10}}) {
    const sources::FieldValue value = sources::charged_rectangle_field(half, x);
    const Vector3 exact = by_quadrature(half, x, 24);
    EXPECT_LT((value.B - exact).norm(), 1e-11 * exact.norm()) << x.transpose();
    EXPECT_LT(value.uncertainty.norm(), 1e-9 * exact.norm()) << x.transpose();
  }
}

// Oracle: far away a disc of the same area, to the quadrupole; and the jump of H across the face.
TEST(ChargedRectangle, JumpsByItsChargeAndIsAPoleFarAway) {
  const std::array<double, 2> half{1, 1};
  const double R = std::sqrt(4 / pi);
  const Vector3 far = sources::charged_rectangle_field(half, {0, 0, 400}).B;
  EXPECT_NEAR(far.z() / sources::charged_disc_field(0, 400 / R).axial, 1, 1e-5);
  EXPECT_EQ(far.x(), 0);
  const Vector3 above = sources::charged_rectangle_field(half, {0.3, 0.2, 0.0}).B;
  const Vector3 below = sources::charged_rectangle_field(half, {0.3, 0.2, -0.0}).B;
  EXPECT_NEAR(above.z(), 0.5, 1e-15);
  EXPECT_NEAR(below.z(), -0.5, 1e-15);
  EXPECT_LT((above - below - Vector3::UnitZ()).norm(), 1e-15);
}

TEST(ChargedRectangle, KnowsTheDistanceFromItsEdge) {
  const std::array<double, 2> half{2, 1};
  EXPECT_DOUBLE_EQ(sources::distance_from_edge(half, {0, 0, 0}), 1);
  EXPECT_DOUBLE_EQ(sources::distance_from_edge(half, {1.5, 0, 0}), 0.5);
  EXPECT_DOUBLE_EQ(sources::distance_from_edge(half, {5, 5, 0}), 5);
  EXPECT_DOUBLE_EQ(sources::distance_from_edge(half, {1.5, 0.25, -1.2}), 1.3);
  EXPECT_EQ(sources::distance_from_edge(half, {2, 0.5, 0}), 0);
}

}  // namespace
}  // namespace ciliaval::analytic
