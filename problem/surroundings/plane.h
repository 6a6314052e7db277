// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include "problem/surroundings/environment.h"

namespace ciliaval::surroundings {

/// Whether the environment lies in the vertical plane along the horizontal unit vector e, but for
/// the rounding of components that are stated with ten digits.
inline bool lies_in_plane(const Environment& environment, const Vector3& e) {
  constexpr double rounding = 1e-9;
  return component(environment, Vector3::UnitZ().cross(e)) <= rounding;
}

}  // namespace ciliaval::surroundings
