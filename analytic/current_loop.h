// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include "analytic/circle.h"

namespace ciliaval::analytic {

/// Field H of a loop of unit radius and unit current (right-handed about +ζ), at the distance ρ ≥ 0
/// from its axis and the height ζ above its plane (in radii). From Biot–Savart with
/// s² = ζ² + (1+ρ)², kc² = [ζ² + (1−ρ)²]/s², m = 4ρ/s² and E, D, C of `complete_elliptic`:
///   H_ρ = ζ m (D − C)/(π s³ kc²),  H_ζ = [E − ρ m (D − C)]/(π s³ kc²).
/// These are the textbook forms in K and E (Jackson, Classical Electrodynamics, §5.5) rearranged so
/// that nothing cancels far away or near the axis. Not finite on the loop.
MeridianVector current_loop_field(double rho, double zeta);

/// The same for any loop: H per current (1/m) at x (m).
Vector3 current_loop_field(const Circle& loop, const Vector3& x);

}  // namespace ciliaval::analytic
