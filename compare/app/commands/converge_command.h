// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <filesystem>
#include <optional>

#include "compare/app/commands/commands.h"

namespace ciliaval::compare::app::commands {

struct ConvergeOptions {
  unsigned int levels = 3;
  std::optional<std::filesystem::path> json;
  std::optional<std::filesystem::path> csv;
  std::optional<std::filesystem::path> plot;  ///< an SVG file
  std::string command;                        ///< the command line, for the provenance
};

/// `ciliaval converge`: refines each model of a case through the levels of its meshes, degrees,
/// sums and tolerances and prints orders, extrapolated values and intervals, or why there is none;
/// writes them as JSON, CSV and a plot where asked, the plot last: without gnuplot, everything else
/// is there. Returns `solver` if a model failed on a level, `undecided` if the case has no model
/// that can be refined. Throws InputError, FileError.
ExitCode converge_case(const std::filesystem::path& file, const ConvergeOptions& options);

}  // namespace ciliaval::compare::app::commands
