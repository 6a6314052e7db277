// SPDX-License-Identifier: LGPL-2.1-or-later
#include "analytic/sources/charged_disc.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "analytic/sources/current_loop.h"
#include "analytic/sources/elliptic.h"

namespace ciliaval::analytic::sources {
namespace {

using std::numbers::pi;

/// One term of the series. With y_n = P_n(u)/u and z_n = P'_n(u) for odd n = 2k − 1, both even in
/// u, three-term recurrences over two degrees (from Bonnet's, and for z from Gegenbauer's
/// C_{n−1}^{3/2} = P'_n) lead to the next: y' = (a u² − b) y − c y₋, z' = (d u² − e) z − f z₋.
struct Term {
  double binomial;  ///< ½ binom(½, k)
  double order;     ///< 2k − 1
  double a, b, c, d, e, f;
};

/// x C_m = α_m C_{m+1} + β_m C_{m−1} twice gives x² C_m in C_{m+2}, C_m and C_{m−2}.
struct TwoSteps {
  double square;  ///< of u²
  double constant;
  double previous;
};
constexpr TwoSteps two_steps(double m, double (*alpha)(double), double (*beta)(double)) {
  const double scale = 1 / (alpha(m) * alpha(m + 1));
  const double middle = alpha(m) * beta(m + 1) + (m > 0 ? beta(m) * alpha(m - 1) : 0);
  return {scale, scale * middle, m > 1 ? scale * beta(m) * beta(m - 1) : 0};
}
constexpr double legendre_up(double n) {
  return (n + 1) / (2 * n + 1);
}
constexpr double legendre_down(double n) {
  return n / (2 * n + 1);
}
constexpr double gegenbauer_up(double m) {
  return (m + 1) / (2 * m + 3);
}
constexpr double gegenbauer_down(double m) {
  return (m + 2) / (2 * m + 3);
}

constexpr std::size_t most_terms = 20;  // a² = 9: 9⁻²⁰ = 8e-20

constexpr std::array<Term, most_terms> series_terms() {
  std::array<Term, most_terms> terms{};
  double binomial = 0.5;
  for (std::size_t i = 0; i < most_terms; ++i) {
    const double k = static_cast<double>(i) + 1;
    const double order = 2 * k - 1;
    const TwoSteps y = two_steps(order, legendre_up, legendre_down);
    const TwoSteps z = two_steps(order - 1, gegenbauer_up, gegenbauer_down);
    terms[i] = {binomial / 2, order,    y.square,   y.constant,
                y.previous,   z.square, z.constant, z.previous};
    binomial *= (0.5 - k) / (k + 1);
  }
  return terms;
}

constexpr std::array<Term, most_terms> terms = series_terms();

/// H_ζ of the unit disc in elliptic integrals.
double axial_closed_form(double rho, double zeta, double s, double kc, double K) {
  if (rho == 1) return std::copysign(0.25, zeta) - zeta * K / (2 * pi * s);
  const double gamma = (1 - rho) / (1 + rho);
  const double smooth = zeta * bulirsch_cel(kc, gamma * gamma, 1, gamma) / (pi * (1 + rho) * s);
  return (rho < 1 ? std::copysign(0.5, zeta) : 0.0) - smooth;
}

/// Beyond three radii: the series at a² = ρ² + ζ².
DiscField far_disc_field(double zeta, double a2) {
  const double inverse = 1 / a2;
  const double u2 = zeta * zeta * inverse;
  double y = 1;  // P_{2k−1}/u
  double z = 1;  // P'_{2k−1}
  double y_below = 0;
  double z_below = 0;
  double power = inverse;  // a^{−2k}
  double axial = 0;
  double radial = 0;
  for (const Term& term : terms) {
    const double scale = term.binomial * power;
    axial += scale * term.order * y;
    radial += scale * z;
    power *= inverse;
    // binom(½, k) P'_{2k−1} grows like √k only.
    if (power < 1e-18 * inverse) break;
    const double y_above = (term.a * u2 - term.b) * y - term.c * y_below;
    const double z_above = (term.d * u2 - term.e) * z - term.f * z_below;
    y_below = y;
    z_below = z;
    y = y_above;
    z = z_above;
  }
  const double over_a = std::sqrt(inverse);
  return {radial * over_a, axial * zeta * over_a};
}

/// Up to three radii: the elliptic integrals.
DiscField near_disc_field(double rho, double zeta) {
  const double s2 = zeta * zeta + (1 + rho) * (1 + rho);
  const double s = std::sqrt(s2);
  const double kc = std::sqrt((zeta * zeta + (1 - rho) * (1 - rho)) / s2);
  const CompleteElliptic elliptic = complete_elliptic(kc, 4 * rho / s2);
  return {4 * elliptic.C / (pi * s2 * s), axial_closed_form(rho, zeta, s, kc, elliptic.K)};
}

}  // namespace

DiscField charged_disc_field(double rho, double zeta) {
  const double a2 = rho * rho + zeta * zeta;
  return a2 > 9 ? far_disc_field(zeta, a2) : near_disc_field(rho, zeta);
}

DiscGradient charged_disc_gradient(double rho, double zeta) {
  const double P = charged_disc_field(rho, zeta).radial_over_rho;
  const LoopField loop = current_loop_field(rho, zeta);
  return {P, loop.axial - P, -loop.axial, -loop.radial_over_rho};
}

}  // namespace ciliaval::analytic::sources
