// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <deal.II/fe/mapping.h>
#include <deal.II/grid/tria.h>

namespace ciliaval::meshes {

/// Area (m²) and second moments about the centroid's x and y axes (m⁴) of a meshed section.
struct SectionProperties {
  double area = 0;
  double about_x = 0;  ///< ∫ (y − y₀)² dA
  double about_y = 0;  ///< ∫ (x − x₀)² dA
};

/// Those of the faces with base_id, integrated exactly for a mapping of degree 2.
SectionProperties base_section(const dealii::Triangulation<3>& triangulation,
                               const dealii::Mapping<3>& mapping);

}  // namespace ciliaval::meshes
