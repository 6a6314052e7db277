// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

namespace ciliaval::analytic::sources {

/// Bulirsch's general complete elliptic integral (Numer. Math. 13, 305, 1969),
///   C(kc, p, c, s) = ∫₀^{π/2} (c cos²φ + s sin²φ) / [(cos²φ + p sin²φ) √(cos²φ + kc² sin²φ)] dφ,
/// for kc > 0 and p > 0, to a few units of rounding of the larger of its two parts.
double bulirsch_cel(double kc, double p, double c, double s);

/// The complete integrals of Jahnke and Emde, Δ² = cos²φ + kc² sin²φ, m = 1 − kc²:
///   K = ∫ dφ/Δ,  E = ∫ Δ dφ,  D = ∫ sin²φ/Δ dφ = (K − E)/m,
///   C = ∫ sin²φ cos²φ/Δ³ dφ = [(2 − m)K − 2E]/m²   over 0 … π/2.
struct CompleteElliptic {
  double K;
  double E;
  double D;
  double C;
};

/// K, E, D, C from the arithmetic-geometric mean: with c_n its differences, Gauss's
/// E = K(1 − ½Σ_{n≥0} 2ⁿ c_n²) and c₀² = m give C = K Σ_{n≥1} 2ⁿ c_n²/m², a sum of positive terms
/// that keeps all digits as m → 0, where the textbook forms of D and C lose them. kc > 0 and
/// m = 1 − kc² are both arguments, so that neither has to be found by cancellation.
CompleteElliptic complete_elliptic(double kc, double m);

}  // namespace ciliaval::analytic::sources
