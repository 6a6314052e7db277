// SPDX-License-Identifier: LGPL-2.1-or-later
#include "problem/lagrange.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "problem/error.h"

namespace ciliaval {
namespace {

struct Interpolated {
  double value = 0;
  double derivative = 0;
};

template <class Function>
Interpolated interpolate(const LagrangeBasis& basis, double x, Function f) {
  std::vector<double> values(basis.size());
  std::vector<double> derivatives(basis.size());
  basis.values_and_derivatives(x, values, derivatives);
  Interpolated result;
  for (std::size_t i = 0; i < basis.size(); ++i) {
    result.value += values[i] * f(basis.nodes()[i]);
    result.derivative += derivatives[i] * f(basis.nodes()[i]);
  }
  return result;
}

// Oracle: a polynomial of degree n−1 is its own interpolant.
TEST(Lagrange, ReproducesPolynomialsAndTheirDerivatives) {
  const auto cubic = [](double x) { return 2 - x + 3 * x * x - 5 * x * x * x; };
  const auto slope = [](double x) { return -1 + 6 * x - 15 * x * x; };
  const LagrangeBasis basis({-1, -0.2, 0.7, 1.5});
  for (const double x : {-1.0, -0.999999, -0.3, 0.7, 0.700000001, 1.2, 1.5}) {
    const Interpolated p = interpolate(basis, x, cubic);
    EXPECT_NEAR(p.value, cubic(x), 2e-13) << x;
    EXPECT_NEAR(p.derivative, slope(x), 2e-12) << x;
  }
}

// Oracle: exp itself. 20 Chebyshev points resolve it to rounding error, also on an interval of
// millimetres.
TEST(Lagrange, ConvergesSpectrallyOnChebyshevPoints) {
  const double length = 1e-3;
  const LagrangeBasis basis(chebyshev_points(20, 0, length));
  const auto f = [length](double x) { return std::exp(3 * x / length); };
  for (int k = 0; k <= 37; ++k) {
    const double x = length * k / 37;
    const Interpolated p = interpolate(basis, x, f);
    EXPECT_NEAR(p.value / f(x), 1, 1e-13);
    EXPECT_NEAR(p.derivative / (3 / length * f(x)), 1, 1e-11);
  }
}

TEST(Lagrange, RefusesCoincidentAndMissingNodes) {
  EXPECT_THROW(LagrangeBasis({0, 1, 1}), InputError);
  EXPECT_THROW(LagrangeBasis(std::vector<double>{}), InputError);
  EXPECT_THROW(chebyshev_points(1, 0, 1), InputError);
}

TEST(ChebyshevPoints, IncludeBothEndsAndIncrease) {
  const std::vector<double> points = chebyshev_points(9, 0.1, 0.3);
  EXPECT_EQ(points.front(), 0.1);
  EXPECT_EQ(points.back(), 0.3);
  for (std::size_t i = 1; i < points.size(); ++i) EXPECT_GT(points[i], points[i - 1]);
}

// Oracle: ∫_a^b x^k dx in closed form; the rule is exact up to k = 2n−1 and not beyond.
TEST(GaussLegendre, IsExactToDegree2nMinus1) {
  for (const std::size_t n : {1U, 2U, 3U, 7U, 16U, 64U}) {
    const QuadratureRule rule = gauss_legendre(n, -1, 1);
    const auto integral = [&](std::size_t k) {
      double sum = 0;
      for (std::size_t i = 0; i < n; ++i)
        sum += rule.weights[i] * std::pow(rule.nodes[i], static_cast<double>(k));
      return sum;
    };
    for (std::size_t k = 0; k < 2 * n; ++k) {
      const double exact = k % 2 == 1 ? 0.0 : 2.0 / (static_cast<double>(k) + 1);
      EXPECT_NEAR(integral(k), exact, 2e-15 * 4) << n << " points, degree " << k;
    }
    if (n <= 7) {
      EXPECT_GT(std::abs(integral(2 * n) - 2.0 / (2.0 * static_cast<double>(n) + 1)), 1e-5);
    }
  }
}

TEST(GaussLegendre, MapsToAnyInterval) {
  const QuadratureRule rule = gauss_legendre(12, 1, 3);
  double sum = 0;
  for (std::size_t i = 0; i < 12; ++i) sum += rule.weights[i] / rule.nodes[i];
  EXPECT_NEAR(sum, std::log(3.0), 1e-13);
}

}  // namespace
}  // namespace ciliaval
