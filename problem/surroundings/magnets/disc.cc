// SPDX-License-Identifier: LGPL-2.1-or-later
#include "problem/surroundings/magnets/disc.h"

#include <boost/math/differentiation/autodiff.hpp>
#include <boost/math/special_functions/ellint_rf.hpp>
#include <boost/math/special_functions/ellint_rj.hpp>
#include <cmath>
#include <numbers>

namespace ciliaval::surroundings::magnets {
namespace {

using std::numbers::pi;

/// P(q, ζ) by the arithmetic-geometric mean, for a number type with derivatives.
template <class Number>
Number radial_over_rho(const Number& q, const Number& zeta) {
  const Number e = zeta * zeta + 1 + q;
  const Number sd = sqrt(e * e - 4 * q);
  Number a = sqrt((e + sd) / 2);
  Number b = sqrt(sd);
  Number c2 = 1 / (a * a);  // C_n²/q
  double weight = 2;
  Number sum = weight * c2;
  // Quadratic convergence; the derivatives follow the value within a step or two.
  for (int n = 0; n < 8; ++n) {
    const Number mean = (a + b) / 2;
    b = sqrt(a * b);
    a = mean;
    c2 = q * c2 * c2 / (16 * a * a);
    weight *= 2;
    sum += weight * c2;
    if (static_cast<double>(q * c2) < 1e-28 * static_cast<double>(a * a)) break;
  }
  return sum / (8 * a);
}

/// H_ζ at ρ, ζ in radii.
double axial(double rho, double zeta) {
  const double a2 = rho * rho + zeta * zeta;
  if (a2 > 9) {
    const double u = zeta / std::sqrt(a2);
    double sum = 0;
    double term = 0.5 / a2;  // binom(½, k)/a^{2k}
    for (unsigned int k = 1; k <= 22; ++k) {
      sum += term * (2 * k - 1) * std::legendre(2 * k - 1, u);
      term *= (0.5 - k) / (k + 1) / a2;
    }
    return sum / 2;
  }
  const double s2 = zeta * zeta + (1 + rho) * (1 + rho);
  const double kc2 = (zeta * zeta + (1 - rho) * (1 - rho)) / s2;
  const double gamma = (1 - rho) / (1 + rho);
  const double K = boost::math::ellint_rf(0.0, kc2, 1.0);
  double third = 0;  // γ Π
  double step = 0.25;
  if (rho != 1) {
    const double p = gamma * gamma;
    third = gamma * (K + (1 - p) / 3 * boost::math::ellint_rj(0.0, kc2, 1.0, p));
    step = rho < 1 ? 0.5 : 0.0;
  }
  return std::copysign(step, zeta) - zeta * (third + K) / (2 * pi * std::sqrt(s2));
}

}  // namespace

FieldJet disc_jet(double radius, const Vector3& x) {
  const double X = x[0] / radius;
  const double Y = x[1] / radius;
  const double zeta = x[2] / radius;
  const double q = X * X + Y * Y;
  const auto variables = boost::math::differentiation::make_ftuple<double, 2, 1>(q, zeta);
  const auto P = radial_over_rho(std::get<0>(variables) + 0 * std::get<1>(variables),
                                 std::get<1>(variables) + 0 * std::get<0>(variables));
  const double P0 = P.derivative(0, 0);
  const double Pq = P.derivative(1, 0);
  const double Pz = P.derivative(0, 1);
  const double Pqq = P.derivative(2, 0);
  const double Pqz = P.derivative(1, 1);
  const double Pzz = -4 * (q * Pqq + 2 * Pq);  // ∇·H = 0 and ∇×H = 0

  FieldJet jet;
  jet.B = {X * P0, Y * P0, axial(std::sqrt(q), zeta)};
  jet.gradient = Matrix3{{P0 + 2 * X * X * Pq, 2 * X * Y * Pq, X * Pz},
                         {2 * X * Y * Pq, P0 + 2 * Y * Y * Pq, Y * Pz},
                         {X * Pz, Y * Pz, -2 * (P0 + q * Pq)}} /
                 radius;
  const double xxx = 6 * X * Pq + 4 * X * X * X * Pqq;
  const double xxy = 2 * Y * Pq + 4 * X * X * Y * Pqq;
  const double xyy = 2 * X * Pq + 4 * X * Y * Y * Pqq;
  const double yyy = 6 * Y * Pq + 4 * Y * Y * Y * Pqq;
  const double xxz = Pz + 2 * X * X * Pqz;
  const double xyz = 2 * X * Y * Pqz;
  const double yyz = Pz + 2 * Y * Y * Pqz;
  const double xzz = X * Pzz;
  const double yzz = Y * Pzz;
  const double zzz = -xxz - yyz;
  jet.second = {Matrix3{{xxx, xxy, xxz}, {xxy, xyy, xyz}, {xxz, xyz, xzz}},
                Matrix3{{xxy, xyy, xyz}, {xyy, yyy, yyz}, {xyz, yyz, yzz}},
                Matrix3{{xxz, xyz, xzz}, {xyz, yyz, yzz}, {xzz, yzz, zzz}}};
  for (Matrix3& matrix : jet.second) matrix /= radius * radius;
  return jet;
}

}  // namespace ciliaval::surroundings::magnets
