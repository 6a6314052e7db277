// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <algorithm>
#include <array>

#include "problem/cilium.h"
#include "problem/types.h"

namespace ciliaval {

/// M of a segment along the reference's axes x, y, z, A/m.
inline Vector3 magnetization(const Segment& segment) {
  const auto& [x, y] = segment.transverse_magnetization;
  return {x, y, segment.magnetization};
}

inline bool is_magnetic(const Segment& segment) {
  return !magnetization(segment).isZero(0);
}

inline bool has_magnet(const Cilium& cilium) {
  return std::ranges::any_of(cilium.segments, is_magnetic);
}

/// Whether a segment is magnetised across the axis.
inline bool has_transverse_magnetization(const Cilium& cilium) {
  return std::ranges::any_of(cilium.segments, [](const Segment& segment) {
    return segment.transverse_magnetization != std::array{0.0, 0.0};
  });
}

}  // namespace ciliaval
