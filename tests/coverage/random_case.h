// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "problem/cilium.h"
#include "problem/load.h"
#include "problem/types.h"

namespace ciliaval::test {

/// A cilium, a load and sensors drawn at random from what case files admit.
struct RandomCase {
  Cilium cilium;
  Load load;
  double tip_angle = 0;          ///< that of the elastica under the load, rad; infinite: none
  double kernel_width = 0.5e-3;  ///< m
  std::vector<Vector3> sensors;  ///< m
};

/// The case of a seed: 1 to 4 segments, E between neighbours' in ratios of 0.05 to 100, ν of 0.3 to
/// 0.4999, L/d of 4 to 40, one of the load types (by turns) that turns the elastica's tip by 2° to
/// 60°, four sensors: 0.05 radii to 10 lengths below the base. The kernel is the default's, or a
/// third of the room that the height leaves it.
RandomCase random_case(std::uint32_t seed);

/// A cilium of the box in which joints are corrected: a soft base of 0.5 to 8 diameters and ν of
/// 0.3 to 0.4999, a magnet of 2 to 10 diameters, 1 to 100 times stiffer, and every second time one
/// or two segments of 0.5 to 2 diameters between them; the loads and angles of random_case(); a
/// sensor 0.3 to 2 diameters below the base.
RandomCase random_design(std::uint32_t seed);

/// A cilium of random_case() under a surface, flat, a sine or a trapezoid by turns, pressed on it
/// by 0.003 to 0.1 lengths, with a friction up to 0.6.
RandomCase random_sweep(std::uint32_t seed);

}  // namespace ciliaval::test
