// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include "problem/types.h"

namespace ciliaval::oracle {

/// B (T) and, where it is asked for, ∂B_i/∂x_j (T/m).
struct FieldAndGradient {
  Vector3 B;
  Matrix3 gradient = Matrix3::Zero();
};

/// Magnets that stand on z = 0 about the z axis, evaluated in 50 digits and rounded once; the
/// gradients are central differences of them over steps of 1e-12. Outside of the magnet, not in the
/// plane of a face.

/// A round one, magnetised by M (A/m) along the axis; a tube if `inner_radius` is more than 0:
/// Derby & Olbert, Am. J. Phys. 78, 229 (2010).
FieldAndGradient standing_tube(double M, double radius, double inner_radius, double height,
                               const Vector3& x, bool with_gradient = false);

/// A cuboid of these edges with any M: charged rectangles, asinh and atan at their corners.
FieldAndGradient standing_cuboid(const Vector3& M, const Vector3& edges, const Vector3& x,
                                 bool with_gradient = false);

/// Two poles ±q (A·m), the negative one at 0, the other at the height.
FieldAndGradient standing_poles(double q, double height, const Vector3& x,
                                bool with_gradient = false);

}  // namespace ciliaval::oracle
