// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "meshes/gmsh/gmsh_file.h"
#include "meshes/mesh_file.h"
#include "problem/cilium.h"

namespace ciliaval::meshes::gmsh {

/// A user's mesh on its way into a triangulation, and the words for its faults. Lengths in messages
/// are in the file's unit, so that they can be found in Gmsh.
struct UserMesh {
  const MeshFile& source;
  const Cilium& cilium;
  GmshFile file;
  std::vector<std::size_t> segments;  ///< of the hexahedra
  std::vector<std::string> remarks;   ///< oddities that are no faults

  /// Two positions nearer than this are the same, m.
  double tolerance() const { return 1e-5 * cilium.diameter; }
  dealii::Point<3> position(std::size_t node) const {
    return file.nodes[node] * source.unit;
  }  ///< m
  /// A length (m) in the file's unit.
  double in_file(double length) const { return length / source.unit; }

  /// Throws InputError "FILE: what".
  [[noreturn]] void fail(const std::string& what) const;
  std::string node(std::size_t index) const;        ///< "node 12 at (1.5, 0, 3)"
  std::string hexahedron(std::size_t index) const;  ///< "element 17 of 'magnet' at (1, 0, 3.5)"
};

/// Finds the segment of each hexahedron by the name of its physical volume. Throws InputError if a
/// name is unknown or missing, or if a hexahedron is in no physical volume or in two.
void find_segments(UserMesh& mesh);

/// The physical surfaces `base`, `mantle` and `tip`: the boundary id of each of their entities (see
/// boundary_ids.h). Throws InputError if one is missing, or if an entity is in two of them.
/// Surfaces of other names get a remark.
std::map<int, unsigned int> find_boundaries(UserMesh& mesh);

}  // namespace ciliaval::meshes::gmsh
