// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <CLI/App.hpp>
#include <filesystem>
#include <string>
#include <vector>

/// Pages and figures are made by the Python package `ciliaval` (python/), which this program
/// starts.
namespace ciliaval::compare::app {

/// Runs `python3 -m MODULE OPTIONS… -- FILES…` with the package of this build, of this
/// installation, or of PYTHONPATH. Returns what it could not show, a line each. Throws FileError
/// with the module's message if it made nothing, and with what to install if Python, the package or
/// something that it needs is missing.
std::vector<std::string> run_python_module(const std::string& module,
                                           const std::vector<std::filesystem::path>& files,
                                           const std::vector<std::string>& options = {});

/// Becomes Python with `ciliaval.command`, which runs MODULE with ARGUMENTS…, whose output, signals
/// and exit code are then the program's; the module finds this program in $CILIAVAL_PROGRAM. Throws
/// FileError if there is no Python; without the package, or what it needs, it ends with that code.
[[noreturn]] void become_python_module(const std::string& module,
                                       const std::vector<std::string>& arguments);

/// The same with the options of a command that the user has given, whether to show progress, the
/// command's words for the provenance, and files.
[[noreturn]] void become_python_command(const std::string& module, const CLI::App& command,
                                        const std::string& words,
                                        const std::vector<std::string>& files);

/// Draws the main figure of results, the text of a JSON file: SVG, PDF or PNG, by the name of
/// `figure`. Throws FileError.
void draw_figure(const std::string& json, const std::filesystem::path& figure);

}  // namespace ciliaval::compare::app
