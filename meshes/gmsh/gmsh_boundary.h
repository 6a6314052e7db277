// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include "meshes/gmsh/gmsh_section.h"

namespace ciliaval::meshes::gmsh {

/// Checks that the physical surfaces `base`, `mantle` and `tip` are exactly the boundary faces on Z
/// = 0, on the mantle and on Z = L. Throws InputError at the first face that is elsewhere, belongs
/// to no cell, or is missing.
void check_boundaries(UserMesh& mesh, const Extrusion& extrusion, const Section& section);

}  // namespace ciliaval::meshes::gmsh
