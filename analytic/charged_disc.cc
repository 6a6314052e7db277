// SPDX-License-Identifier: LGPL-2.1-or-later
#include "analytic/charged_disc.h"

#include <cmath>
#include <numbers>

#include "analytic/elliptic.h"

namespace ciliaval::analytic {
namespace {

constexpr double pi = std::numbers::pi;

/// H_ζ of the unit disc by its multipole series, a² = ρ² + ζ² > 9.
double axial_series(double zeta, double a2) {
  const double a = std::sqrt(a2);
  const double u = zeta / a;
  double even = 1;        // P_{2k−2}(u)
  double odd = u;         // P_{2k−1}(u)
  double binomial = 0.5;  // binom(½, k)
  double power = 1 / a2;  // a^{−2k}
  double sum = 0;
  for (int k = 1; k <= 40; ++k) {
    const double order = 2 * k - 1;
    sum += binomial * order * odd * power;
    if (std::abs(binomial) * order * power < 1e-18 / a2) break;
    even = ((2 * order + 1) * u * odd - order * even) / (order + 1);
    odd = ((2 * order + 3) * u * even - (order + 1) * odd) / (order + 2);
    binomial *= (0.5 - k) / (k + 1);
    power /= a2;
  }
  return sum / 2;
}

/// H_ζ of the unit disc in elliptic integrals.
double axial_closed_form(double rho, double zeta, double s, double kc, double K) {
  if (rho == 1) return std::copysign(0.25, zeta) - zeta * K / (2 * pi * s);
  const double gamma = (1 - rho) / (1 + rho);
  const double smooth = zeta * bulirsch_cel(kc, gamma * gamma, 1, gamma) / (pi * (1 + rho) * s);
  return (rho < 1 ? std::copysign(0.5, zeta) : 0.0) - smooth;
}

}  // namespace

MeridianVector charged_disc_field(double rho, double zeta) {
  const double s = std::hypot(zeta, 1 + rho);
  const double kc = std::hypot(zeta, 1 - rho) / s;
  const CompleteElliptic elliptic = complete_elliptic(kc, 4 * rho / (s * s));
  const double a2 = rho * rho + zeta * zeta;
  return {4 * rho * elliptic.C / (pi * s * s * s),
          a2 > 9 ? axial_series(zeta, a2) : axial_closed_form(rho, zeta, s, kc, elliptic.K)};
}

Vector3 charged_disc_field(const Circle& disc, const Vector3& x) {
  const CylindricalPoint point = cylindrical(disc, x);
  const MeridianVector H = charged_disc_field(point.rho / disc.radius, point.zeta / disc.radius);
  return H.radial * point.e_rho + H.axial * disc.normal;
}

}  // namespace ciliaval::analytic
