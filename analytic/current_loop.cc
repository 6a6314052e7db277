// SPDX-License-Identifier: LGPL-2.1-or-later
#include "analytic/current_loop.h"

#include <cmath>
#include <numbers>

#include "analytic/elliptic.h"

namespace ciliaval::analytic {

MeridianVector current_loop_field(double rho, double zeta) {
  const double s = std::hypot(zeta, 1 + rho);
  const double kc = std::hypot(zeta, 1 - rho) / s;
  const double m = 4 * rho / (s * s);
  const CompleteElliptic elliptic = complete_elliptic(kc, m);
  const double scale = 1 / (std::numbers::pi * s * s * s * kc * kc);
  const double difference = m * (elliptic.D - elliptic.C);
  return {scale * zeta * difference, scale * (elliptic.E - rho * difference)};
}

Vector3 current_loop_field(const Circle& loop, const Vector3& x) {
  const CylindricalPoint point = cylindrical(loop, x);
  const MeridianVector H = current_loop_field(point.rho / loop.radius, point.zeta / loop.radius);
  return (H.radial * point.e_rho + H.axial * loop.normal) / loop.radius;
}

}  // namespace ciliaval::analytic
