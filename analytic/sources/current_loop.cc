// SPDX-License-Identifier: LGPL-2.1-or-later
#include "analytic/sources/current_loop.h"

#include <cmath>
#include <numbers>

#include "analytic/sources/elliptic.h"

namespace ciliaval::analytic::sources {

LoopField current_loop_field(double rho, double zeta) {
  const double zeta2 = zeta * zeta;
  const double s2 = zeta2 + (1 + rho) * (1 + rho);
  const double d2 = zeta2 + (1 - rho) * (1 - rho);
  const double s = std::sqrt(s2);
  const double kc = std::sqrt(d2) / s;
  const double four_over_s2 = 4 / s2;
  const CompleteElliptic elliptic = complete_elliptic(kc, four_over_s2 * rho);
  const double scale = 1 / (std::numbers::pi * s * d2);
  const double difference = four_over_s2 * (elliptic.D - elliptic.C);
  const double axial = kc < 0.5
                           ? (1 - rho) * ((1 + rho) * elliptic.E + (1 - rho) * elliptic.K) / 2 +
                                 zeta2 * four_over_s2 * rho * elliptic.D / 2
                           : elliptic.E - rho * rho * difference;
  return {scale * zeta * difference, scale * axial};
}

}  // namespace ciliaval::analytic::sources
