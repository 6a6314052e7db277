// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>

#include <boost/math/constants/constants.hpp>
#include <boost/math/special_functions/ellint_1.hpp>
#include <boost/math/special_functions/ellint_2.hpp>
#include <boost/math/special_functions/ellint_3.hpp>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <numbers>
#include <vector>

#include "analytic/sources/adaptive_order.h"
#include "analytic/sources/charged_disc.h"
#include "analytic/sources/current_loop.h"
#include "analytic/sources/dipole.h"
#include "analytic/sources/elliptic.h"
#include "problem/field_model.h"
#include "problem/lagrange.h"
#include "tests/analytic/oracles/bent_rods.h"
#include "tests/analytic/oracles/derby_olbert.h"

namespace ciliaval::analytic {
namespace {

using oracle::record;
using Real = boost::multiprecision::cpp_bin_float_50;

const std::vector<double> moduli = {1e-6, 1e-3, 0.1, 0.5, 0.9, 0.99, 0.9999, 1 - 1e-8};

// Oracle: Boost.Math's ellint_1, ellint_2, ellint_3 in 50 digits. Measured 6e-16; margin 3.
TEST(EllipticIntegrals, BulirschAgreesWithLegendresThreeKinds) {
  double error = 0;
  for (const double kc : moduli) {
    const Real k = sqrt(1 - Real(kc) * kc);
    const Real K = boost::math::ellint_1(k);
    const Real E = boost::math::ellint_2(k);
    const auto compare = [&](double value, const Real& exact) {
      error = std::max(error, std::abs(static_cast<double>(value / exact - 1)));
    };
    compare(sources::bulirsch_cel(kc, 1, 1, 1), K);
    compare(sources::bulirsch_cel(kc, 1, 1, kc * kc), E);
    for (const double p : {1e-8, 1e-3, 0.3, 0.999, 2.0, 50.0})
      compare(sources::bulirsch_cel(kc, p, 1, 1), boost::math::ellint_3(k, 1 - Real(p)));
  }
  record("cel against Boost.Math, relative", error);
  EXPECT_LT(error, 2e-15);
}

// Oracle: as before, D and C by their textbook forms, whose cancellation 50 digits bear.
// Measured 2e-15; margin 5.
TEST(EllipticIntegrals, KeepAllDigitsAsTheModulusVanishes) {
  double error = 0;
  for (const double kc : moduli) {
    const Real m = 1 - Real(kc) * kc;
    const Real K = boost::math::ellint_1(Real(sqrt(m)));
    const Real E = boost::math::ellint_2(Real(sqrt(m)));
    const sources::CompleteElliptic value = sources::complete_elliptic(kc, static_cast<double>(m));
    for (const Real& ratio : {Real(value.K / K), Real(value.E / E), Real(value.D / ((K - E) / m)),
                              Real(value.C / (((2 - m) * K - 2 * E) / (m * m)))})
      error = std::max(error, std::abs(static_cast<double>(ratio - 1)));
  }
  record("K, E, D, C against Boost.Math, relative", error);
  EXPECT_LT(error, 1e-14);
}

TEST(EllipticIntegrals, AreThoseOfTheCircleForAVanishingModulus) {
  const sources::CompleteElliptic value = sources::complete_elliptic(1, 0);
  EXPECT_DOUBLE_EQ(value.K, std::numbers::pi / 2);
  EXPECT_DOUBLE_EQ(value.E, std::numbers::pi / 2);
  EXPECT_DOUBLE_EQ(value.D, std::numbers::pi / 4);
  EXPECT_DOUBLE_EQ(value.C, std::numbers::pi / 16);
}

// Oracle: the charge integral H = ∫ a/(4πa³) dA by Gauss–Legendre × trapezoid, points where that
// converges to rounding error. Measured 3e-14, of the sum of 6400 terms; margin 4.
TEST(ChargedDisc, IsTheFieldOfItsCharge) {
  const QuadratureRule radial = gauss_legendre(40, 0, 1);
  const int azimuths = 160;
  double error = 0;
  for (const double rho : {0.0, 1e-9, 0.4, 1.0, 1.7, 2.9, 3.1}) {
    for (const double zeta : {-1.5, -0.7, 0.6, 2.0}) {
      Vector3 H = Vector3::Zero();
      for (std::size_t i = 0; i < radial.nodes.size(); ++i) {
        for (int j = 0; j < azimuths; ++j) {
          const double phi = 2 * std::numbers::pi * j / azimuths;
          const double r = radial.nodes[i];
          const Vector3 a(rho - r * std::cos(phi), -r * std::sin(phi), zeta);
          H += radial.weights[i] * r / (2 * azimuths) * a / std::pow(a.norm(), 3);
        }
      }
      const sources::DiscField value = sources::charged_disc_field(rho, zeta);
      const Vector3 field(rho * value.radial_over_rho, 0, value.axial);
      error = std::max(error, (field - H).norm() / H.norm());
    }
  }
  record("disc against the integral of its charge, relative", error);
  EXPECT_LT(error, 1e-13);
}

// Oracle: Gauss. The normal component jumps by the charge across the disc and not beside it.
TEST(ChargedDisc, JumpsByItsChargeAndOnlyOnTheDisc) {
  for (const double rho : {0.0, 0.3, 0.99}) {
    EXPECT_DOUBLE_EQ(sources::charged_disc_field(rho, 0.0).axial, 0.5);
    EXPECT_DOUBLE_EQ(sources::charged_disc_field(rho, -0.0).axial, -0.5);
    EXPECT_NEAR(sources::charged_disc_field(rho, 1e-12).axial, 0.5, 1e-9);
  }
  for (const double rho : {1.01, 2.0, 5.0})
    EXPECT_EQ(sources::charged_disc_field(rho, 0.0).axial, 0);
}

// The two branches of H_ζ meet at three radii. Measured 9e-15; margin 6: the closed form
// is good to 40 ε there, 9e-15 besides the 4e-15 between the points.
TEST(ChargedDisc, SeriesMeetsTheClosedFormAtThreeRadii) {
  double error = 0;
  for (int i = 0; i <= 20; ++i) {
    const double angle = std::numbers::pi / 2 * i / 20;
    const auto at = [&](double a) {
      return sources::charged_disc_field(a * std::sin(angle), a * std::cos(angle));
    };
    // H ~ a⁻²: from one point to the other it changes by 4e-15.
    const sources::DiscField inner = at(3 * (1 - 1e-15));
    const sources::DiscField outer = at(3 * (1 + 1e-15));
    error =
        std::max(error, std::abs(inner.axial - outer.axial) /
                            std::hypot(inner.axial, 3 * std::sin(angle) * inner.radial_over_rho));
  }
  record("disc, series against closed form at three radii", error);
  EXPECT_LT(error, 6e-14);
}

// Oracle: Biot–Savart by the trapezoidal rule, which converges geometrically on a closed loop.
// Measured 5e-15; margin 20.
TEST(CurrentLoop, IsBiotAndSavartsIntegral) {
  const int n = 600;
  double error = 0;
  for (const double rho : {0.0, 1e-9, 0.5, 0.9, 1.2, 3.0, 40.0, 300.0}) {
    for (const double zeta : {-2.0, -0.2, 0.3, 25.0, 300.0}) {
      Eigen::Matrix<long double, 3, 1> H = Eigen::Matrix<long double, 3, 1>::Zero();
      for (int i = 0; i < n; ++i) {
        const long double phi = 2 * std::numbers::pi_v<long double> * i / n;
        const Eigen::Matrix<long double, 3, 1> a(rho - std::cos(phi), -std::sin(phi), zeta);
        const Eigen::Matrix<long double, 3, 1> tangent(-std::sin(phi), std::cos(phi), 0);
        H += tangent.cross(a) / (2 * n * std::pow(a.norm(), 3.0L));
      }
      const sources::LoopField value = sources::current_loop_field(rho, zeta);
      const Vector3 exact = H.cast<double>();
      error =
          std::max(error, (Vector3(rho * value.radial_over_rho, 0, value.axial) - exact).norm() /
                              exact.norm());
    }
  }
  record("loop against Biot-Savart, relative, to 400 radii", error);
  EXPECT_LT(error, 1e-13);
}

// Oracle: Jackson's form in K and E, in 50 digits. Next to the loop the two terms of H_ζ cancel,
// the loops of a stack then add what is left. Measured 9e-15 of the sum of the
// terms' sizes; margin 5.
TEST(CurrentLoop, KeepsTheDigitsOfTheAxialFieldNextToTheLoop) {
  double error = 0;
  for (const double gap : {-0.1, -1e-3, -1e-6, 1e-9, 1e-6, 1e-3, 0.1})
    for (const double zeta : {0.0, 1e-6, 1e-4, 1e-2, 0.2}) {
      const double rho = 1 + gap;
      const Real z2 = Real(zeta) * zeta;
      const Real s2 = z2 + (1 + Real(rho)) * (1 + Real(rho));
      const Real d2 = z2 + (1 - Real(rho)) * (1 - Real(rho));
      const Real k = sqrt(Real(4 * Real(rho) / s2));
      const Real pi = boost::math::constants::pi<Real>();
      const Real K = boost::math::ellint_1(k);
      const Real E = boost::math::ellint_2(k);
      const Real parts = (abs(Real(1 - Real(rho) * rho)) + z2) / d2 * E + K;
      const Real axial = K + (1 - Real(rho) * rho - z2) / d2 * E;
      const Real scale = 2 * pi * sqrt(s2);
      const Real value = Real(sources::current_loop_field(rho, zeta).axial) * scale;
      error = std::max(error, static_cast<double>(Real(abs(Real(value - axial)) / parts)));
    }
  record("loop's axial field next to it, over its parts", error);
  EXPECT_LT(error, 5e-14);
}

// Oracle: integrals whose rules of order n are off by 2⁻ⁿ and 2⁻²ⁿ. For 1e-6 of their sum the last
// orders but one must be 24 and 12, and the estimate is what the last raisings changed.
TEST(AdaptiveOrder, RaisesEachPartAloneAndReturnsItsLastChanges) {
  std::vector<std::size_t> highest(2, 0);
  const auto contribution = [&](const std::size_t& part, std::size_t order) {
    highest[part] = std::max(highest[part], order);
    const double error = std::pow(2.0, -static_cast<double>((part + 1) * order));
    return sources::FieldValue{(1 + error) * Vector3::UnitX(), Vector3::Zero()};
  };
  const Vector3 x(0, 0, 0);
  const sources::FieldValue value = sources::integrate_adaptively(
      std::vector<std::size_t>{0, 1}, contribution, {1e-6, 54, "test integral", x});
  EXPECT_EQ(highest, (std::vector<std::size_t>{36, 16}));
  const double change =
      std::pow(2.0, -24) - std::pow(2.0, -36) + std::pow(2.0, -24) - std::pow(2.0, -32);
  EXPECT_NEAR(value.uncertainty.x(), change, 1e-15);
  EXPECT_NEAR(value.B.x(), 2, std::pow(2.0, -31));
}

// Oracle: two poles ±q at a distance h → 0 are a dipole qh; finite differences, error O(h²).
TEST(Dipole, IsTwoPolesThatMoveTogether) {
  const Vector3 axis(0.3, -0.5, 0.8);
  const Vector3 a(1.0, 2.0, -0.7);
  const double h = 1e-4;
  const Vector3 poles =
      (sources::pole_field(1, a - h / 2 * axis) - sources::pole_field(1, a + h / 2 * axis)) / h;
  EXPECT_LT(oracle::relative_difference(poles, sources::dipole_field(axis, a)), 1e-8);
}

}  // namespace
}  // namespace ciliaval::analytic
