// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <span>

#include "analytic/rod/rod_magnet.h"
#include "analytic/sources/field_points.h"

namespace ciliaval::analytic::rod {

/// field_of_end_discs() of rectangular sections: B (T) at x, μ₀ Σ σ H(rectangle), with the rounding
/// of the kernel and of the offset times the gradient, at most μ₀σ/(2·distance from the edge).
/// Throws InputError on an edge, where B diverges.
sources::FieldValue field_of_end_rectangles(std::span<const RodEnd> ends, const Vector3& x);

}  // namespace ciliaval::analytic::rod
