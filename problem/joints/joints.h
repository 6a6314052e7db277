// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <vector>

#include "problem/cilium.h"

/// Joints of a rod: its clamp and the interfaces of its segments. Beside a bonded interface of two
/// materials the section can neither contract nor warp as the rod assumes, over about a diameter.
/// docs/theory/joints.md has the derivation and the table.
namespace ciliaval::joints {

/// Option of a rod to correct its joints; `none` is the paper's model.
enum class Correction { none, corrected };

/// A bent bar beyond small strains, to the second order of neo-Hooke's solid: under the axial force
/// N and the moment M
///     K = M/EI + 2 p N M + g M³ + h M⁵,   Γ₃ = N/EA + p M²,
/// which is one energy. With the radius R and y = 1 − 2ν, p EI EA = (3 − y/3 − 10 y²/9)/2, from the
/// bar's stretch; g EI³/R² = k(ν), a cubic that fits the section's problem to 1e-3; h = 3 g² EI.
struct BendingLaw {
  double lengthening = 0;        ///< p, 1/(N²·m²)
  double softening = 0;          ///< g, 1/(N³·m⁴)
  double further_softening = 0;  ///< h, 1/(N⁵·m⁶)
};
BendingLaw bending_law(double diameter, const Segment& segment);

/// Excess compliance of a joint over the rod's, symmetric and never positive definite (a bonded end
/// is stiffer): jumps of the pose from the lower to the upper side under the section force n and
/// moment m, all in the section's axes,
///     Δφ₁ = a m₁ − b n₂,  Δφ₂ = a m₂ + b n₁,
///     Δu₁ = b m₂ + c n₁,  Δu₂ = −b m₁ + c n₂,  Δu₃ = e n₃.
struct Joint {
  double rotation = 0;      ///< a, rad/(N·m)
  double coupling = 0;      ///< b, rad/N
  double displacement = 0;  ///< c, m/N
  double extension = 0;     ///< e, m/N
  BendingLaw beyond{};      ///< small strains: of the jumps, as K and Γ₃ have it, times m
};

Joint& operator+=(Joint& a, const Joint& b);

/// Terms that a corrected rod adds to the paper's: for each segment the joint at its lower end, the
/// clamp first, and the bending law. Empty: no correction.
struct Corrections {
  std::vector<Joint> joints{};
  std::vector<BendingLaw> laws{};

  bool empty() const { return joints.empty(); }
};

Corrections& operator+=(Corrections& a, const Corrections& b);

/// Throws InputError, with what to do, where the table does not reach: a section that is no circle,
/// a segment shorter than 0.3 diameters, Poisson's ratio or a ratio of moduli outside of it.
Corrections corrections(const Cilium& cilium);

/// Uncertainties of the corrections, all to the softer side, so that they add up: 1e-4 d/EI (3e-4
/// d/EA) of the table, 15 % of a joint's law and 20 % of a segment's, for terms of the same order
/// that the laws leave out (docs/theory/joints.md).
Corrections uncertainties(const Cilium& cilium);

}  // namespace ciliaval::joints
