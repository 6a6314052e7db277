// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <optional>

#include "analytic/rod/field_models.h"
#include "analytic/rod/rod_magnet.h"
#include "analytic/sources/field_points.h"

namespace ciliaval::analytic::rod {

/// B (T) at x outside the rod by quadrature over its reference volume,
///   B = ∫∫∫ dipole_field(M₁ d₁ + M₂ d₂ + M₃ v, x − y) dX dY dS,  y = r(S) + X d₁ + Y d₂,
/// v = ∂y/∂S for `wedge` (paper's Eq. 9 with the Jacobian, m dv = F·M dV₀) and v = d₃ for `stacked`
/// (Eq. 9 with one 1/cosθ). Gauss–Legendre in S, on stretches no longer than their distance from x,
/// and along the sides of a rectangle, or in r and trapezoid in φ; the order of each of the three
/// directions is raised by itself until raising it by half moves B by less than tolerance·|B|/3.
/// The three changes and the rounding are the uncertainty. Throws SolverError inside the rod, so
/// near to it that the tolerance needs more than 2·10⁷ nodes, or if the changes are down to
/// rounding (10⁻¹⁴|B|) and still above the tolerance.
sources::FieldValue rod_field_by_quadrature(const RodMagnet& magnet, const RodInterior& interior,
                                            VolumeOptions::Slices slices, double tolerance,
                                            const Vector3& x);

/// The same where charges or poles cancel, far from the rod beside its length: dipoles do not.
/// Nothing inside, or if the tolerance needs more than 2·10⁵ nodes or is not reached.
std::optional<sources::FieldValue> far_field_of_rod(const RodMagnet& magnet,
                                                    const RodInterior& interior,
                                                    VolumeOptions::Slices slices, double tolerance,
                                                    const Vector3& x);

/// Its derivative ∂B_i/∂x_j (T/m), of `wedge`.
std::optional<Matrix3> far_gradient_of_rod(const RodMagnet& magnet, const RodInterior& interior,
                                           double tolerance, const Vector3& x);

}  // namespace ciliaval::analytic::rod
