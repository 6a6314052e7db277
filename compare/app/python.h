// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <CLI/App.hpp>
#include <filesystem>
#include <string>
#include <vector>

/// Pages and figures are made by the Python package `ciliaval` (python/), which this program
/// starts.
namespace ciliaval::compare::app {

/// End of a module of the package that made what it was asked for.
struct ModuleEnd {
  std::vector<std::string> warnings;  ///< what it could not show, a line each
};

/// Runs `python3 -m MODULE OPTIONS… -- FILES…` with the package of this build, of this
/// installation, or of PYTHONPATH. Throws FileError with the module's message if it made nothing,
/// and with what to install if Python, the package or something that it needs is missing.
ModuleEnd run_python_module(const std::string& module,
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

/// Draws the main figure of a JSON file of results: SVG, PDF or PNG, by the name of `figure`. A
/// study has a figure for each output: `figure` is a folder. Throws FileError.
void draw_figure(const std::filesystem::path& results, const std::filesystem::path& figure);
/// The same from the text of such a file.
void draw_figure(const std::string& json, const std::filesystem::path& figure);

}  // namespace ciliaval::compare::app
