// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace ciliaval::meshes::gmsh {

/// Runs work that calls the Gmsh library in a forked process, and returns its text: Gmsh crashes on
/// some damaged files, keeps global state and writes into the home folder. Its messages are
/// silent, the user's configuration is not read. Throws the work's InputError and FileError; for
/// an error of Gmsh, a crash, or an excess of time or memory FileError "FILE: Gmsh cannot WHAT:
/// why".
std::string in_gmsh_process(const std::filesystem::path& file, const std::string& what,
                            const std::function<std::string()>& work);

}  // namespace ciliaval::meshes::gmsh
