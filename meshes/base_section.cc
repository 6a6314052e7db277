// SPDX-License-Identifier: LGPL-2.1-or-later
#include "meshes/base_section.h"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_values.h>

#include "meshes/boundary_ids.h"

namespace ciliaval::meshes {

SectionProperties base_section(const dealii::Triangulation<3>& triangulation,
                               const dealii::Mapping<3>& mapping) {
  // (x, y)² times the Jacobian has degree 4 + 3 in each direction.
  const dealii::QGauss<2> quadrature(4);
  const dealii::FE_Q<3> any(1);
  dealii::FEFaceValues<3> face(mapping, any, quadrature,
                               dealii::update_quadrature_points | dealii::update_JxW_values);
  double area = 0;
  dealii::Tensor<1, 3> first;
  dealii::Tensor<1, 3> second;
  for (const auto& cell : triangulation.active_cell_iterators())
    for (const unsigned int f : cell->face_indices()) {
      if (!cell->face(f)->at_boundary() || cell->face(f)->boundary_id() != base_id) continue;
      face.reinit(cell, f);
      for (unsigned int q = 0; q < quadrature.size(); ++q) {
        const dealii::Point<3>& x = face.quadrature_point(q);
        area += face.JxW(q);
        for (unsigned int d = 0; d < 2; ++d) {
          first[d] += x[d] * face.JxW(q);
          second[d] += x[d] * x[d] * face.JxW(q);
        }
      }
    }
  return {area, second[1] - first[1] * first[1] / area, second[0] - first[0] * first[0] / area};
}

}  // namespace ciliaval::meshes
