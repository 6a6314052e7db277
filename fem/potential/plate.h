// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <Eigen/Geometry>

namespace ciliaval::fem {

/// A permeable body: a box with its own relative permeability.
struct PermeableBox {
  Eigen::AlignedBox3d box;           ///< m
  double relative_permeability = 1;  ///< μ_r > 0
};

}  // namespace ciliaval::fem
