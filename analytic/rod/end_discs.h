// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <span>

#include "analytic/rod/rod_magnet.h"
#include "analytic/sources/field_points.h"

namespace ciliaval::analytic::rod {

/// B (T) at x of the uniformly charged sections where the magnetisation jumps, μ₀ Σ σ H(disc): all
/// of the wedge's field outside the magnet. Its rounding error: 40 ε|B| of the kernel, and the
/// rounding of the offset times the gradient, at most μ₀σ/(2π·distance from the rim) within three
/// radii and 4|B|/distance beyond. Throws InputError on a rim, where B diverges.
sources::FieldValue field_of_end_discs(std::span<const RodEnd> ends, const Vector3& x);

/// ∂B_i/∂x_j and its rounding error, T/m.
struct DiscsGradient {
  Matrix3 value = Matrix3::Zero();
  double rounding = 0;
};

/// Derivative of field_of_end_discs(). Its rounding error, beyond the discs' rims: 40 ε of the
/// kernel and the rounding of the offset by the largest derivative 6|∇B|/a. Throws InputError on a
/// rim.
DiscsGradient gradient_of_end_discs(std::span<const RodEnd> ends, const Vector3& x);

/// Throws InputError if x is on the rim of one of the sections, where B diverges.
void require_off_the_rims(std::span<const RodEnd> ends, const Vector3& x);

}  // namespace ciliaval::analytic::rod
