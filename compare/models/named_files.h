// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <filesystem>
#include <vector>

#include "compare/input/case.h"

namespace ciliaval::compare::models {

/// The files that a case names and that are read with it: its meshes, its surface, and the results
/// of its external models.
std::vector<std::filesystem::path> named_files(const input::Case& problem);

}  // namespace ciliaval::compare::models
