// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <array>

#include "analytic/sources/field_points.h"
#include "problem/types.h"

namespace ciliaval::analytic::sources {

/// Field H of the rectangle |x| ≤ a, |y| ≤ b, z = 0 with unit magnetic surface charge, at a point
/// in its own axes (m). With u = x ± a, v = y ± b, R² = u² + v² + z² and the signs of the four
/// corners,
///   H_x = −1/4π Σ± asinh(v/√(u² + z²)),  H_y the same with u and v exchanged,
///   H_z = 1/4π Σ± atan(uv/(zR)),
/// from ∫∫ (u, v, z)/R³ du dv. The uncertainty is 8 ε times the sum of the terms' magnitudes, which
/// cancel far away like the area over the distance squared. On the rectangle z = +0 and z = −0 are
/// the limits from its two sides. Not finite on its edge.
FieldValue charged_rectangle_field(const std::array<double, 2>& half_sides, const Vector3& x);

/// Distance (m) of a point, in the rectangle's own axes, from its edge.
double distance_from_edge(const std::array<double, 2>& half_sides, const Vector3& x);

}  // namespace ciliaval::analytic::sources
