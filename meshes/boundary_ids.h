// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <deal.II/base/types.h>

#include <string>
#include <vector>

namespace ciliaval::meshes {

/// Boundary ids of every mesh of a cilium.
inline constexpr dealii::types::boundary_id base_id = 0;      ///< Z = 0
inline constexpr dealii::types::boundary_id mantle_id = 1;    ///< X² + Y² = R²
inline constexpr dealii::types::boundary_id tip_id = 2;       ///< Z = L
inline constexpr dealii::types::boundary_id symmetry_id = 3;  ///< Y = 0 of the half cylinder

/// Names of the first three surfaces by their ids, as mesh files have them.
inline const std::vector<std::string> boundary_names{"base", "mantle", "tip"};

}  // namespace ciliaval::meshes
