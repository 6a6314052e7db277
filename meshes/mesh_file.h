// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <filesystem>

namespace ciliaval::meshes {

/// A user's mesh (docs/guide/meshes.md): a Gmsh file, which has no units, and its unit.
struct MeshFile {
  std::filesystem::path path;
  double unit = 1;  ///< length of the file's unit, m: 1e-3 for a file in mm
};

}  // namespace ciliaval::meshes
