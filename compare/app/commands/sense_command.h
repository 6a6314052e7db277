// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "compare/app/commands/commands.h"

namespace ciliaval::compare::app::commands {

struct SenseOptions {
  std::optional<std::filesystem::path> background;
  std::string models = "elastica/volume";
  std::string noise = "1 uT";          ///< standard deviation of each component of a reading
  std::optional<std::string> largest;  ///< load; else 1.25 times the case's largest
  std::optional<std::filesystem::path> json;
  std::optional<std::filesystem::path> csv;
  std::optional<std::filesystem::path> plot;  ///< of a bench, an SVG file
  std::string command;                        ///< the command line, for the provenance
  std::vector<std::string> given;             ///< names of the options on the command line
};

/// `ciliaval sense`: readings of a case, or without a file of readings a test bench. Throws
/// InputError if the files are not of these kinds.
ExitCode sense(const std::filesystem::path& file, const std::filesystem::path& readings,
               const SenseOptions& options);

/// `ciliaval sense CASE READINGS`: the load and its direction, with confidence intervals, from each
/// reading of the case's sensors (compare/sensing/readings.h), to stdout. Returns `solver` if the
/// least squares fails at a reading, `undecided` if no reading gives a load. Throws InputError,
/// SolverError, FileError.
ExitCode sense_readings(const std::filesystem::path& file, const std::filesystem::path& readings,
                        const SenseOptions& options);

/// `ciliaval sense NAME.sense.toml`: simulates the test bench (compare/sensing/bench.h), to stdout.
/// Throws InputError, SolverError, FileError.
ExitCode sense_bench(const std::filesystem::path& file, const SenseOptions& options);

}  // namespace ciliaval::compare::app::commands
