// SPDX-License-Identifier: LGPL-2.1-or-later
#include "meshes/mesh_nodes.h"

#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_tools.h>

namespace ciliaval::meshes {
namespace {

/// Cell nodes (lexicographic) of the nine nodes of each face in deal.II's order ξ = 0, ξ = 1, η =
/// 0, …; first and second local coordinate of a face turn so that its normal is outwards.
std::array<std::size_t, 9> face_nodes(const std::array<std::size_t, 27>& cell, unsigned int face) {
  constexpr std::array<std::size_t, 3> stride{1, 3, 9};
  const unsigned int axis = face / 2;
  const bool upper = face % 2 == 1;
  const std::size_t first = stride[(axis + (upper ? 1 : 2)) % 3];
  const std::size_t second = stride[(axis + (upper ? 2 : 1)) % 3];
  std::array<std::size_t, 9> result{};
  for (std::size_t j = 0; j < 3; ++j)
    for (std::size_t i = 0; i < 3; ++i)
      result[3 * j + i] = cell[(upper ? 2 : 0) * stride[axis] + i * first + j * second];
  return result;
}

}  // namespace

MeshNodes mesh_nodes(const dealii::Triangulation<3>& triangulation,
                     const dealii::Mapping<3>& mapping) {
  const dealii::FE_Q<3> element(2);  // one degree of freedom for each node
  dealii::DoFHandler<3> dof_handler(triangulation);
  dof_handler.distribute_dofs(element);
  const std::vector<unsigned int> lexicographic =
      dealii::FETools::hierarchic_to_lexicographic_numbering<3>(2);
  MeshNodes mesh;
  mesh.nodes.resize(dof_handler.n_dofs());
  std::vector<dealii::types::global_dof_index> dofs(element.n_dofs_per_cell());
  for (const auto& cell : dof_handler.active_cell_iterators()) {
    cell->get_dof_indices(dofs);
    MeshNodes::Cell plain{{}, cell->material_id()};
    for (unsigned int a = 0; a < dofs.size(); ++a) {
      plain.nodes[lexicographic[a]] = dofs[a];
      mesh.nodes[dofs[a]] =
          mapping.transform_unit_to_real_cell(cell, element.unit_support_point(a));
    }
    for (const unsigned int f : cell->face_indices())
      if (cell->face(f)->at_boundary())
        mesh.faces.push_back({face_nodes(plain.nodes, f), cell->face(f)->boundary_id()});
    mesh.cells.push_back(plain);
  }
  return mesh;
}

}  // namespace ciliaval::meshes
