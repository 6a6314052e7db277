// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "compare/app/commands/commands.h"

namespace ciliaval::compare::app::commands {

struct StudyOptions {
  std::filesystem::path directory = "results";
  std::optional<std::filesystem::path> json;
  bool fresh = false;   ///< forget what an earlier run of the study has computed
  std::string command;  ///< the command line, for the provenance
};

/// `ciliaval study`: computes the outputs of each pair of models at each point of a parameter study
/// (docs/guide/studies.md), from where an earlier call was stopped; prints tables, writes
/// DIRECTORY/NAME/study.csv, study.json and a plot for each output, the plots last: without
/// gnuplot, everything else is there. Returns `solver` if every point failed. Throws InputError,
/// FileError.
ExitCode run_study(const std::filesystem::path& file, const StudyOptions& options);

}  // namespace ciliaval::compare::app::commands
