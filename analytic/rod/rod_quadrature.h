// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include "analytic/rod/field_models.h"
#include "analytic/rod/rod_magnet.h"
#include "analytic/sources/field_points.h"

namespace ciliaval::analytic::rod {

/// B (T) at x outside the rod by quadrature over its reference volume,
///   B = ∫∫∫ dipole_field(M₁ d₁ + M₂ d₂ + M₃ v, x − y) r dr dφ dS,  y = r(S) + r cosφ d₁ + r sinφ
///   d₂,
/// v = ∂y/∂S for `wedge` (paper's Eq. 9 with the Jacobian, m dv = F·M dV₀) and v = d₃ for `stacked`
/// (Eq. 9 with one 1/cosθ). Gauss–Legendre in S, on stretches no longer than their distance from x,
/// and in r, trapezoid in φ; the order of each of the three directions is raised by itself until
/// raising it by half moves B by less than tolerance·|B|/3. The three changes are the uncertainty.
/// Throws SolverError inside the rod, so near to it that the tolerance needs more than 2·10⁷
/// nodes, or if the changes are down to rounding (10⁻¹⁴|B|) and still above the tolerance.
sources::FieldValue rod_field_by_quadrature(const RodMagnet& magnet, const RodInterior& interior,
                                            VolumeOptions::Slices slices, double tolerance,
                                            const Vector3& x);

}  // namespace ciliaval::analytic::rod
