// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <algorithm>
#include <cmath>

#include "problem/cilium.h"
#include "problem/surroundings/environment.h"

namespace ciliaval::surroundings {

/// True if the environment lies in the vertical plane along the horizontal unit vector e, but for
/// the rounding of components that are stated with ten digits.
inline bool lies_in_plane(const Environment& environment, const Vector3& e) {
  constexpr double rounding = 1e-9;
  return component(environment, Vector3::UnitZ().cross(e)) <= rounding;
}

/// The same of the couple that the environment exerts on the cilium: its magnetisation lies in the
/// plane, too, if there is a field.
inline bool lies_in_plane(const Environment& environment, const Cilium& cilium, const Vector3& e) {
  constexpr double rounding = 1e-9;
  if (!lies_in_plane(environment, e)) return false;
  if (environment.uniform_field.isZero(0) && environment.magnets.empty()) return true;
  return std::ranges::all_of(cilium.segments, [&e](const Segment& segment) {
    const Vector3 M = magnetization(segment);
    return std::abs(M.dot(Vector3::UnitZ().cross(e))) <= rounding * M.norm();
  });
}

}  // namespace ciliaval::surroundings
