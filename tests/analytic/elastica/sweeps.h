// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <vector>

#include "analytic/elastica/sweep.h"

/// Declarations that the tests of sweeps share.
namespace ciliaval::analytic::elastica {

/// Places of a surface at one height, which travels evenly.
inline std::vector<SurfacePlace> straight_on(double height, double travel, int samples) {
  std::vector<SurfacePlace> places;
  for (int i = 0; i <= samples; ++i) places.push_back({height, travel * i / samples});
  return places;
}

inline std::vector<TipJump> jumps(const std::vector<SweepSample>& samples) {
  std::vector<TipJump> all;
  for (const SweepSample& sample : samples)
    all.insert(all.end(), sample.jumps.begin(), sample.jumps.end());
  return all;
}

}  // namespace ciliaval::analytic::elastica
