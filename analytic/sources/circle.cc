// SPDX-License-Identifier: LGPL-2.1-or-later
#include "analytic/sources/circle.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace ciliaval::analytic::sources {
namespace {

/// Distance from the axis and height above the plane, m.
std::pair<double, double> cylindrical(const Circle& circle, const Vector3& x) {
  const Vector3 offset = x - circle.centre;
  const double zeta = offset.dot(circle.normal);
  return {(offset - zeta * circle.normal).norm(), zeta};
}

}  // namespace

double distance_from_line(const Circle& circle, const Vector3& x) {
  const auto [rho, zeta] = cylindrical(circle, x);
  return std::hypot(rho - circle.radius, zeta);
}

double distance_from_disc(const Circle& circle, const Vector3& x) {
  const auto [rho, zeta] = cylindrical(circle, x);
  return std::hypot(std::max(rho - circle.radius, 0.0), zeta);
}

}  // namespace ciliaval::analytic::sources
