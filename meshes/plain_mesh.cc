// SPDX-License-Identifier: LGPL-2.1-or-later
#include "meshes/plain_mesh.h"

#include <deal.II/grid/tria.h>

#include <utility>

#include "meshes/base_section.h"
#include "meshes/cylinder/cylinder_mesh.h"
#include "meshes/gmsh/gmsh_mesh.h"

namespace ciliaval::meshes {

PlainMesh plain_cylinder(const Cilium& cilium, const cylinder::CylinderMeshOptions& options) {
  dealii::Triangulation<3> triangulation;
  cylinder::make_cylinder(cilium, options, triangulation);
  const auto mapping = cylinder::cylinder_mapping(triangulation);
  return {mesh_nodes(triangulation, *mapping), base_section(triangulation, *mapping), {}};
}

PlainMesh plain_gmsh(const MeshFile& source, const Cilium& cilium) {
  gmsh::GmshMesh mesh = gmsh::read_gmsh(source, cilium);
  return {mesh_nodes(*mesh.triangulation, *mesh.mapping),
          base_section(*mesh.triangulation, *mesh.mapping), std::move(mesh.remarks)};
}

}  // namespace ciliaval::meshes
