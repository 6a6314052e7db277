// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include "problem/surroundings/magnets/field.h"

namespace ciliaval::surroundings::magnets {

/// B/μ₀ (A/m) of a disc about the third axis at the origin, of radius R (m) and unit magnetic
/// surface charge (A/m), at x off the disc. In radii, with q = ρ², H = (x P, y P, H_ζ),
///   P = H_ρ/ρ = 4 C(kc)/(π s³) = (1/8A) Σ_{n≥1} 2ⁿ C_n²/q,
/// where C_n are the differences in the arithmetic-geometric mean A of s and d,
/// s², d² = ζ² + (1 ± ρ)². From its first step on, A₁² = (e + √(e² − 4q))/2, e = ζ² + 1 + q,
/// C₁² = q/A₁², it is analytic in q, so that P and its derivatives by q and ζ are good on the axis
/// and far away, where nothing cancels. ∇·H = 0 and ∇×H = 0 give the derivatives of H_ζ, which
/// itself is H_ζ = sign(ζ)·{½ inside ρ < 1} − ζ[γ Π(1 − γ², k) + K(k)]/(2π s), γ = (1−ρ)/(1+ρ),
/// k² = 4ρ/s², in Carlson's R_F and R_J, and beyond three radii the multipole series
///   ½ Σ_{k≥1} binom(½, k)(2k−1) P_{2k−1}(ζ/a)/a^{2k}, a² = q + ζ².
FieldJet disc_jet(double radius, const Vector3& x);

}  // namespace ciliaval::surroundings::magnets
