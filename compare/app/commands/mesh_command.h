// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "compare/input/case.h"

namespace ciliaval::compare::app::commands {

/// `ciliaval mesh`: writes the mesh on which the solid solves a case, whole (not its half): the
/// built-in one at the case's refinement or at the one given, or the user's of [models.solid] mesh
/// as it was read. A `.msh` has the names of the segments and the boundary and can be named in a
/// case again, a `.vtu` is for ParaView; both keep the curved geometry. The file is written under a
/// temporary name beside it and renamed. Returns a line about it, and the mesh's remarks. Throws
/// InputError (another extension, a refinement of a user's mesh), FileError.
std::string write_case_mesh(const input::Case& problem, const std::filesystem::path& output,
                            std::optional<unsigned int> refinement, const std::string& command);

/// Reads the user's mesh of a case, if it names one and asks for the solid, and returns the remarks
/// on it. Throws InputError and FileError as meshes::gmsh::read_gmsh().
std::vector<std::string> check_case_mesh(const input::Case& problem);

}  // namespace ciliaval::compare::app::commands
