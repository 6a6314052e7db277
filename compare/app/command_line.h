// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>

#include "compare/app/commands/commands.h"

namespace ciliaval::compare::app {

/// What the command line asks for.
using Command = std::function<commands::ExitCode()>;

/// Adds all commands with their options and help. When the command line is parsed, `chosen` becomes
/// the one that it names; it must outlive the parsing. `command_line` is for the provenance.
void add_commands(CLI::App& app, const std::string& command_line, Command& chosen);

}  // namespace ciliaval::compare::app
