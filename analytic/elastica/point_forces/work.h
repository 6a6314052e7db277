// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "analytic/elastica/tip_contact.h"

namespace ciliaval::analytic::elastica::point_forces {

/// The works of a step, by Hermite's corrected trapezoidal rule, h²/12 (f′(a) − f′(b)).
struct Work {
  double surface = 0;
  double surface_correction = 0;
  double friction = 0;
  double friction_correction = 0;
};

inline Work work_between(const TipContact& before, const SurfacePlace& from,
                         const TipContact& contact, const SurfacePlace& to, double friction) {
  const Eigen::Vector2d way{to.travel - from.travel, to.height - from.height};
  Work work;
  work.surface = (before.force_x + contact.force_x) / 2 * way[0] +
                 (before.force_z + contact.force_z) / 2 * way[1];
  work.surface_correction =
      ((before.force_x_by_place - contact.force_x_by_place) * way).value() * way[0] / 12 +
      ((before.force_z_by_place - contact.force_z_by_place) * way).value() * way[1] / 12;
  for (const Touch& touch : contact.touches) {
    const double way_back = touch.slip < 0 ? -1 : 1;
    work.friction +=
        std::abs(touch.before.friction_force + touch.friction_force) / 2 * std::abs(touch.slip);
    // ∫ N dq of two functions of the way: h²/12 (N′(a) q′(b) − N′(b) q′(a)).
    const auto along = [&](const Eigen::RowVector2d& by_place) { return (by_place * way).value(); };
    work.friction_correction += friction * way_back / 12 *
                                (along(touch.before.normal_by_place) * along(touch.slip_by_place) -
                                 along(touch.normal_by_place) * along(touch.before.slip_by_place));
  }
  return work;
}

}  // namespace ciliaval::analytic::elastica::point_forces
