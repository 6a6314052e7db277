// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace ciliaval::compare::app::commands {

/// What the program returns.
enum class ExitCode {
  pass = 0,
  tolerance = 1,     ///< `check`: a result is not as it was accepted
  usage = 2,         ///< the command line or a case file cannot be used
  solver = 3,        ///< a model did not converge; the results of the others are written
  input_output = 4,  ///< a file could not be read or written
  undecided = 5      ///< `check`, `converge`, `budget`: nothing could be compared, refined, judged
};

struct RunOptions {
  std::filesystem::path directory = "results";
  bool fresh = false;   ///< delete the checkpoints of runs that were killed
  std::string command;  ///< the command line, for the provenance
};

/// `ciliaval run`: reads and checks all case files, output folders and checkpoints before anything
/// runs, then runs each case, from its checkpoint if there is one, writes its results to
/// DIRECTORY/name and its table to stdout. Throws InputError (also if two cases have the same name)
/// and FileError.
ExitCode run_cases(const std::vector<std::filesystem::path>& files, const RunOptions& options);

/// `ciliaval validate`: reads and checks cases and studies, and says so on stdout. Throws
/// InputError with the faults of all files, FileError.
void validate_cases(const std::vector<std::filesystem::path>& files);

/// `ciliaval mesh`: writes the solid's mesh of a case to a `.msh` or `.vtu` file and a line about
/// it to stdout (compare/mesh_command.h). Throws InputError, FileError.
void write_mesh(const std::filesystem::path& file, const std::filesystem::path& output,
                std::optional<unsigned int> refinement, const std::string& command);

/// `ciliaval list`: models, loads, shipped cases and studies, to stdout.
void list();

/// "ciliaval 0.1.0 (git …)"
std::string version_line();

}  // namespace ciliaval::compare::app::commands
