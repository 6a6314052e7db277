// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

namespace ciliaval::meshes {

/// Area (m²) and second moments about the centroid's x and y axes (m⁴) of a meshed section.
struct SectionProperties {
  double area = 0;
  double about_x = 0;  ///< ∫ (y − y₀)² dA
  double about_y = 0;  ///< ∫ (x − x₀)² dA
};

}  // namespace ciliaval::meshes
