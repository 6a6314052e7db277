// SPDX-License-Identifier: LGPL-2.1-or-later
#include "analytic/sources/circle.h"

#include <algorithm>
#include <cmath>

namespace ciliaval::analytic::sources {

CylindricalPoint cylindrical(const Circle& circle, const Vector3& x) {
  const Vector3 offset = x - circle.centre;
  const double zeta = offset.dot(circle.normal) + 0.0;  // turns −0 into +0
  const Vector3 radial = offset - zeta * circle.normal;
  const double rho = radial.norm();
  return {rho, zeta, rho > 0 ? Vector3(radial / rho) : Vector3(Vector3::Zero())};
}

double distance_from_line(const Circle& circle, const Vector3& x) {
  const CylindricalPoint point = cylindrical(circle, x);
  return std::hypot(point.rho - circle.radius, point.zeta);
}

double distance_from_disc(const Circle& circle, const Vector3& x) {
  const CylindricalPoint point = cylindrical(circle, x);
  return std::hypot(std::max(point.rho - circle.radius, 0.0), point.zeta);
}

}  // namespace ciliaval::analytic::sources
