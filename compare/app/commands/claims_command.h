// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <filesystem>
#include <optional>

#include "compare/app/commands/commands.h"

namespace ciliaval::compare::app::commands {

struct ClaimsOptions {
  bool quick = false;  ///< without the 3D solid
  std::optional<std::filesystem::path> json;
  std::string command;  ///< the command line, for the provenance
};

/// `ciliaval claims`: the paper's quantitative statements, each with what the models find, to
/// stdout (docs/evidence/paper.md). Throws InputError if the shipped cases are not found,
/// SolverError, FileError.
ExitCode print_claims(const ClaimsOptions& options);

}  // namespace ciliaval::compare::app::commands
