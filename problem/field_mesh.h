// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <array>
#include <vector>

#include "problem/types.h"

namespace ciliaval {

/// A magnetic scalar potential on cubes, as a field model computed it: for drawing.
struct FieldMesh {
  struct Leaf {
    Vector3 lower = Vector3::Zero();  ///< corner with the lowest coordinates, m
    double size = 0;                  ///< edge, m
    std::array<double, 27> psi{};     ///< ψ, A, at the corners and midpoints, first index fastest
    Vector3 magnetization = Vector3::Zero();  ///< B_r/μ₀, mean over the cube, A/m
    double relative_permeability = 1;         ///< mean over the cube
  };
  std::vector<Leaf> leaves;  ///< all of them on rank 0, none on the others
};

}  // namespace ciliaval
