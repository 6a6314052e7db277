// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "compare/app/commands/commands.h"

namespace ciliaval::compare::app::commands {

struct CheckOptions {
  bool quick = false;   ///< without the models that take more than a moment
  bool accept = false;  ///< write candidates for new baselines instead
  std::optional<std::filesystem::path> junit;
  std::optional<std::filesystem::path> json;
  std::string command;  ///< the command line, for the provenance
};

/// `ciliaval check`: runs the cases, all shipped ones if none is named, and holds them against the
/// baselines beside them; prints a report, and writes it as JUnit's XML and as JSON where asked.
/// With `accept` it writes `NAME.baseline.candidate.json` beside each case that is not as its
/// baseline, prints what changed from what to what, and how to accept it: the baseline itself is
/// never touched. Returns `tolerance`, `solver` or `undecided` if the check fails. Throws
/// InputError, before anything runs, if a case or a baseline cannot be used; FileError.
ExitCode check_cases(std::vector<std::filesystem::path> files, const CheckOptions& options);

}  // namespace ciliaval::compare::app::commands
