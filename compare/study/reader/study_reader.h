// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <filesystem>
#include <vector>

#include "compare/study/study.h"

namespace ciliaval::compare::study::reader {

/// Reads and checks a study file, its case and every point. Throws InputError with every fault
/// found, a line each: `file:line:column: what is wrong; did you mean …?`.
Study read_study(const std::filesystem::path& file);

/// The files that a study is read from: its own, the case that it names, and those that the case
/// names. Throws InputError.
std::vector<std::filesystem::path> files_of_study(const std::filesystem::path& file);

}  // namespace ciliaval::compare::study::reader
