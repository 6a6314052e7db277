// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include "problem/types.h"

namespace ciliaval::analytic::sources {

/// A circle in space: the edge of a charged disc, or a current loop, positive about the normal.
struct Circle {
  Vector3 centre = Vector3::Zero();   ///< m
  Vector3 normal = Vector3::UnitZ();  ///< unit vector
  double radius = 0;                  ///< m
};

/// Distance (m) of a point from the circle's line.
double distance_from_line(const Circle& circle, const Vector3& x);
/// Distance (m) of a point from the flat disc that the circle bounds.
double distance_from_disc(const Circle& circle, const Vector3& x);

}  // namespace ciliaval::analytic::sources
