// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "compare/app/commands/commands.h"

namespace ciliaval::compare::app::commands {

struct BudgetOptions {
  std::vector<std::string> without;  ///< models left out, "sensitivity"
  std::optional<std::filesystem::path> json;
  std::optional<std::filesystem::path> csv;
  std::optional<std::filesystem::path> plot;  ///< an SVG file
  std::string command;                        ///< the command line, for the provenance
};

/// `ciliaval budget`: splits what lies between the paper's model and the best one into the parts of
/// its assumptions (compare/budget/budget.h), whatever models the case lists; prints the tables,
/// and writes them as JSON, CSV and a plot where asked, the plot last: without gnuplot, everything
/// else is there. Returns `solver` if a model failed somewhere, `undecided` if no link could be
/// judged. Throws InputError, FileError.
ExitCode budget_case(const std::filesystem::path& file, const BudgetOptions& options);

}  // namespace ciliaval::compare::app::commands
