// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <deal.II/fe/mapping_q_cache.h>
#include <deal.II/grid/tria.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "meshes/mesh_file.h"
#include "problem/cilium.h"

namespace ciliaval::meshes::gmsh {

/// A user's mesh.
struct GmshMesh {
  std::unique_ptr<dealii::Triangulation<3>> triangulation;
  std::unique_ptr<dealii::MappingQCache<3>> mapping;  ///< quadratic, of the curved cells
  std::vector<std::string> remarks;                   ///< odd or poor but usable, a sentence each
};

/// Reads a Gmsh mesh of the cilium (docs/guide/meshes.md): hexahedra extruded along Z from Z = 0 to
/// L, a physical volume for each segment, of its name, and the physical surfaces `base`, `mantle`
/// and `tip`. Ids and vertical mesh lines are as of cylinder::make_cylinder(), the cells in the
/// order of the file's; ones that are turned, upside down or mirrored are renumbered. Nodes within
/// 1e-5 d of an exact extrusion and of the segments' ends are moved there. Second-order nodes are
/// honoured; the mantle of a first-order mesh becomes a cylinder whose section has the area πR².
/// `ranks` says, by the number of the nodes of quadratic cells, on which ranks the mesh is to be in
/// parts (make_in_parts()); all of them read the file. Throws FileError if the file cannot be read
/// as a mesh, InputError if the mesh does not suit the cilium.
GmshMesh read_gmsh(
    const MeshFile& source, const Cilium& cilium,
    const std::function<MPI_Comm(std::size_t nodes)>& ranks = [](std::size_t) {
      return MPI_COMM_SELF;
    });

}  // namespace ciliaval::meshes::gmsh
