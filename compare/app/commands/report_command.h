// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "compare/app/commands/commands.h"

namespace ciliaval::compare::app::commands {

struct ReportOptions {
  std::optional<std::filesystem::path> output;  ///< else report.html in the folder
  std::string command;                          ///< the command line, for the page's foot
};

/// `ciliaval report`: one page of everything found in a folder of results, as one file
/// (compare/report/report.h); says where it is on stdout. Where a result file is damaged or a
/// figure cannot be drawn, the page is written with what can be shown and `input_output` returned.
/// Throws InputError, FileError.
ExitCode write_report(const std::filesystem::path& folder, const ReportOptions& options);

}  // namespace ciliaval::compare::app::commands
