// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <filesystem>
#include <vector>

#include "compare/input/case.h"

namespace ciliaval::compare::app {

/// All cases, or one InputError with the faults of all files; two cases of the same name are one.
/// Prints what is odd about the users' meshes.
std::vector<input::Case> read_cases(const std::vector<std::filesystem::path>& files);

/// The files that a command reads for a case: `file`, which is the case, or a study or test bench,
/// then the case that it names; the case's mesh; the files of its external models.
std::vector<std::filesystem::path> input_files(const std::filesystem::path& file,
                                               const input::Case& problem);

/// True if the file is named like a study (docs/guide/studies.md), NAME.study.toml.
bool is_study_file(const std::filesystem::path& file);

/// True if the file is named like a test bench to be simulated (docs/guide/sensing.md),
/// NAME.sense.toml.
bool is_bench_file(const std::filesystem::path& file);

/// The cases, studies and benches that come with the program.
struct ShippedCases {
  std::filesystem::path folder;
  std::vector<std::filesystem::path> files;  ///< in alphabetical order; none if they are not found
  std::vector<std::filesystem::path> studies;  ///< NAME.study.toml, which are no cases
  std::vector<std::filesystem::path> benches;  ///< NAME.sense.toml, which are no cases
};

/// The cases installed beside the program, or the build tree's sources.
ShippedCases shipped_cases();

}  // namespace ciliaval::compare::app
