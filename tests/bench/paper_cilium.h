// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include "problem/cilium.h"

namespace ciliaval {

/// The cilium of the paper, sections 3.2 and 3.4.1; Poisson's ratio is not in the paper.
inline Cilium paper_cilium(double poisson_ratio = 0.49) {
  Segment base;
  base.length = 3e-3;
  base.young_modulus = 1e5;
  base.poisson_ratio = poisson_ratio;
  Segment magnet = base;
  magnet.length = 17e-3;
  magnet.young_modulus = 3e6;
  return {3e-3, {base, magnet}};
}

}  // namespace ciliaval
