// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <filesystem>

#include "meshes/mesh_nodes.h"
#include "problem/cilium.h"

namespace ciliaval::meshes::gmsh {

struct GmshFormat {
  double version = 4.1;   ///< or 2.2
  bool binary = false;    ///< text has 16 digits, binary all
  double unit = 1;        ///< length of the file's unit, m
  bool quadratic = true;  ///< 27-node hexahedra; false: 8-node, the curved geometry is lost
};

/// Writes a mesh of a cilium as a Gmsh file that read_gmsh() reads: a physical volume for each
/// segment (by material id), physical surfaces `base`, `mantle`, `tip` (by boundary id). The path
/// must end in `.msh`. Throws FileError if it cannot be written, InputError if an id has no name.
void write_gmsh(const MeshNodes& mesh, const Cilium& cilium, const std::filesystem::path& path,
                const GmshFormat& format = {});

}  // namespace ciliaval::meshes::gmsh
