// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <limits>

namespace ciliaval {

using Vector3 = Eigen::Vector3d;
using Matrix3 = Eigen::Matrix3d;
using Quaternion = Eigen::Quaterniond;

/// Names of a vector's components.
inline constexpr std::array<const char*, 3> axis_names{"x", "y", "z"};

/// The relative distance of a double of 1 to the next: twice the largest rounding error.
inline constexpr double epsilon = std::numeric_limits<double>::epsilon();

}  // namespace ciliaval
