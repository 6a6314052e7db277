// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cmath>
#include <numbers>
#include <type_traits>

#include "analytic/sources/circle.h"
#include "analytic/sources/elliptic.h"

namespace ciliaval::analytic::sources {

/// H_ρ/ρ, which has no pole on the axis, and H_ζ of a loop.
template <class Real>
struct LoopField {
  Real radial_over_rho;
  Real axial;
};

/// Field H of a loop of unit radius and unit current (right-handed about +ζ), at the distance ρ ≥ 0
/// from its axis and the height ζ above its plane (in radii). From Biot–Savart with
/// s² = ζ² + (1+ρ)², kc² = [ζ² + (1−ρ)²]/s², m = 4ρ/s² and E, D, C of `complete_elliptic`:
///   H_ρ = ζ m (D − C)/(π s³ kc²),  H_ζ = [E − ρ m (D − C)]/(π s³ kc²).
/// These are the textbook forms in K and E (Jackson, Classical Electrodynamics, §5.5) rearranged so
/// that nothing cancels far away or near the axis; near the loop, kc < ½, where the two terms of
/// H_ζ cancel, it is the sum of small terms
///   H_ζ = [(1−ρ²)E + (1−ρ)²K + ζ²mD]/(2π s³ kc²).  Not finite on the loop. Real is double or an
/// Eigen array of several points.
template <class Real>
LoopField<Real> loop_field(const Real& rho, const Real& zeta) {
  using std::sqrt;
  const Real zeta2 = zeta * zeta;
  const Real s2 = zeta2 + (1 + rho) * (1 + rho);
  const Real d2 = zeta2 + (1 - rho) * (1 - rho);
  const Real s = sqrt(s2);
  const Real kc = sqrt(d2) / s;
  const Real four_over_s2 = 4 / s2;
  const auto elliptic = complete_elliptic<Real>(kc, Real(four_over_s2 * rho));
  const Real scale = 1 / (std::numbers::pi * s * d2);
  const Real difference = four_over_s2 * (elliptic.D - elliptic.C);
  const Real far = elliptic.E - rho * rho * difference;
  const Real near = (1 - rho) * ((1 + rho) * elliptic.E + (1 - rho) * elliptic.K) / 2 +
                    zeta2 * four_over_s2 * rho * elliptic.D / 2;
  Real axial;
  if constexpr (std::is_same_v<Real, double>)
    axial = kc < 0.5 ? near : far;
  else
    axial = (kc < 0.5).select(near, far);
  return {scale * zeta * difference, scale * axial};
}

/// H_ρ and H_ζ of the same loop.
MeridianVector current_loop_field(double rho, double zeta);

}  // namespace ciliaval::analytic::sources
