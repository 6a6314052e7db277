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

/// A vector in the meridian plane through the axis of a circle and a point.
struct MeridianVector {
  double radial;  ///< along e_ρ, away from the axis
  double axial;   ///< along the normal
};

/// A point in the cylindrical coordinates of a circle.
struct CylindricalPoint {
  double rho;     ///< distance from the axis, m
  double zeta;    ///< height above the plane, m; never −0, so that 0 means the normal's side
  Vector3 e_rho;  ///< unit vector away from the axis; zero on the axis
};

CylindricalPoint cylindrical(const Circle& circle, const Vector3& x);

/// Distance (m) of a point from the circle's line.
double distance_from_line(const Circle& circle, const Vector3& x);
/// Distance (m) of a point from the flat disc that the circle bounds.
double distance_from_disc(const Circle& circle, const Vector3& x);

}  // namespace ciliaval::analytic::sources
