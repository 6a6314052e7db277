// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <numbers>
#include <type_traits>

namespace ciliaval::analytic::sources {

/// Bulirsch's general complete elliptic integral (Numer. Math. 13, 305, 1969),
///   C(kc, p, c, s) = ∫₀^{π/2} (c cos²φ + s sin²φ) / [(cos²φ + p sin²φ) √(cos²φ + kc² sin²φ)] dφ,
/// for kc > 0 and p > 0, to a few units of rounding of the larger of its two parts.
double bulirsch_cel(double kc, double p, double c, double s);

/// The complete integrals of Jahnke and Emde, Δ² = cos²φ + kc² sin²φ, m = 1 − kc²:
///   K = ∫ dφ/Δ,  E = ∫ Δ dφ,  D = ∫ sin²φ/Δ dφ = (K − E)/m,
///   C = ∫ sin²φ cos²φ/Δ³ dφ = [(2 − m)K − 2E]/m²   over 0 … π/2.
/// Real is double or an Eigen array of several moduli.
template <class Real>
struct CompleteElliptic {
  Real K;
  Real E;
  Real D;
  Real C;
};

/// K, E, D, C from the arithmetic-geometric mean: with c_n its differences, Gauss's
/// E = K(1 − ½Σ_{n≥0} 2ⁿ c_n²) and c₀² = m give C = K Σ_{n≥1} 2ⁿ c_n²/m², a sum of positive terms
/// that keeps all digits as m → 0, where the textbook forms of D and C lose them. kc > 0 and
/// m = 1 − kc² are both arguments, so that neither has to be found by cancellation. Of an array all
/// moduli are iterated as long as the slowest needs.
template <class Real>
CompleteElliptic<Real> complete_elliptic(const Real& kc, const Real& m) {
  using std::sqrt;
  // The mean converges quadratically: a difference of √ε now is one of ε at the next step.
  constexpr double half_precision = 1e-8;
  const auto goes_on = [&](const Real& t, const Real& a) {
    if constexpr (std::is_same_v<Real, double>)
      return m * t > half_precision * a;
    else
      return (m * t > half_precision * a).any();
  };
  // t = c_n/m, n = 1, 2, …: c₁ = (1 − kc)/2 = m/(2(1 + kc)), c_{n+1} = c_n²/(4a_{n+1}).
  Real a = (1 + kc) / 2;
  Real b = sqrt(kc);
  Real t = 0.25 / a;
  double weight = 2;
  Real sum = weight * t * t;
  while (goes_on(t, a)) {
    const Real arithmetic = (a + b) / 2;
    b = sqrt(Real(a * b));
    a = arithmetic;
    t = m * t * t / (4 * a);
    weight *= 2;
    sum += weight * t * t;
  }
  const Real K = std::numbers::pi / (a + b);
  const Real C = K * sum;
  const Real D = (K + m * C) / 2;
  return {K, K - m * D, D, C};
}

}  // namespace ciliaval::analytic::sources
