// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <filesystem>
#include <vector>

#include "compare/case.h"

namespace ciliaval::compare {

/// All cases, or one InputError with the faults of all files; two cases of the same name are one.
/// Prints what is odd about the users' meshes.
std::vector<Case> read_cases(const std::vector<std::filesystem::path>& files);

/// The cases that come with the program.
struct ShippedCases {
  std::filesystem::path folder;
  std::vector<std::filesystem::path> files;  ///< in alphabetical order; none if they are not found
};

/// Those installed beside the program, or the build tree's sources.
ShippedCases shipped_cases();

}  // namespace ciliaval::compare
