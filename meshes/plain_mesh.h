// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string>
#include <vector>

#include "meshes/cylinder/cylinder_mesh_options.h"
#include "meshes/mesh_file.h"
#include "meshes/mesh_nodes.h"
#include "meshes/section_properties.h"
#include "problem/cilium.h"

namespace ciliaval::meshes {

/// A whole mesh to look at or to write, without deal.II's types.
struct PlainMesh {
  MeshNodes nodes;
  SectionProperties section;
  std::vector<std::string> remarks;  ///< of a user's mesh: odd or poor but usable
};

/// The built-in mesh. Throws as cylinder::make_cylinder().
PlainMesh plain_cylinder(const Cilium& cilium, const cylinder::CylinderMeshOptions& options);

/// A user's mesh. Throws as gmsh::read_gmsh().
PlainMesh plain_gmsh(const MeshFile& source, const Cilium& cilium);

}  // namespace ciliaval::meshes
