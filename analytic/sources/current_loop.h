// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

namespace ciliaval::analytic::sources {

/// H_ρ/ρ, which has no pole on the axis, and H_ζ of a loop.
struct LoopField {
  double radial_over_rho;
  double axial;
};

/// Field H of a loop of unit radius and unit current (right-handed about +ζ), at the distance ρ ≥ 0
/// from its axis and the height ζ above its plane (in radii). From Biot–Savart with
/// s² = ζ² + (1+ρ)², kc² = [ζ² + (1−ρ)²]/s², m = 4ρ/s² and E, D, C of `complete_elliptic`:
///   H_ρ = ζ m (D − C)/(π s³ kc²),  H_ζ = [E − ρ m (D − C)]/(π s³ kc²).
/// These are the textbook forms in K and E (Jackson, Classical Electrodynamics, §5.5) rearranged so
/// that nothing cancels far away or near the axis. Near the loop, kc < ½, where the two terms of
/// H_ζ cancel, it is the sum of small terms
///   H_ζ = [(1−ρ²)E + (1−ρ)²K + ζ²mD]/(2π s³ kc²).  Not finite on the loop.
LoopField current_loop_field(double rho, double zeta);

}  // namespace ciliaval::analytic::sources
