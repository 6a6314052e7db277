// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "compare/output/table.h"

namespace ciliaval::compare::app::commands {

/// Exit code of the program.
enum class ExitCode {
  pass = 0,
  tolerance = 1,     ///< `check`: a result is not as it was accepted
  usage = 2,         ///< the command line or a case file cannot be used
  solver = 3,        ///< a model did not converge; the results of the others are written
  input_output = 4,  ///< a file could not be read or written
  undecided = 5      ///< `check`, `converge`, `budget`: nothing could be compared, refined, judged
};

/// The command line while it is declared and parsed. It must outlive the parsing.
struct CommandLine {
  CLI::App& program;
  std::string words;                 ///< as a shell reads them back, for the provenance
  std::function<ExitCode()> chosen;  ///< the command that the user has named

  /// Adds a command. `execute(options)` becomes the chosen one if the user names it.
  template <typename Options, typename Execute>
  CLI::App* add(const char* name, const char* description, std::shared_ptr<Options> options,
                Execute execute) {
    CLI::App* command = program.add_subcommand(name, description);
    command->footer("Examples of all commands, exit codes: ciliaval help");
    command->callback([this, options, execute] {
      chosen = [this, options, execute] { return execute(*options, words); };
    });
    return command;
  }
};

using OptionalFile = std::optional<std::filesystem::path>;

/// Takes the name of a file that exists, or the name of a case, study or bench that comes with the
/// program, as `ciliaval list` names it or without folder and `.toml`: `fig3b`.
CLI::Validator input_file();

/// A positional file that must exist, or be one that comes with the program.
CLI::Option* add_file(CLI::App* command, const char* name, std::filesystem::path& file,
                      const char* description);
/// An option that names a file to write.
void add_output(CLI::App* command, const char* name, OptionalFile& file, const char* description,
                const char* type = "FILE");

/// Files that a command writes beside its tables, if the command line names them.
struct Outputs {
  OptionalFile json;
  OptionalFile csv;
  OptionalFile plot;  ///< a figure

  /// Declares `--json`, which writes `what`; then, if they are asked for, `--csv` and `--plot`.
  void declare(CLI::App* command, const std::string& what, bool has_csv = false,
               const char* figure = nullptr);
  /// Throws InputError if one of them is one of the inputs or another output.
  void check(const std::vector<std::filesystem::path>& inputs,
             const OptionalFile& other = {}) const;
  /// Writes those that are named, after the table: a full disk must not cost that. The figure comes
  /// last, because it needs Python.
  void write(const std::function<std::string()>& to_json,
             const std::function<std::string()>& to_csv = {}) const;
};

/// `--explain`, and what it does to a table.
void add_explain(CLI::App* command, bool& explain);
output::Footnotes footnotes_of(bool explain);

/// An option that names a figure to write: SVG, PDF or PNG by its name.
void add_plot(CLI::App* command, OptionalFile& file, const char* description,
              const char* name = "--plot");

/// Throws InputError under mpirun.
void require_one_rank(const char* command);

// Each adds a command with its options and help. The commands throw InputError before anything
// runs, SolverError and FileError.
void add_draw(CommandLine& line);
void add_new(CommandLine& line);
void add_run(CommandLine& line);
void add_validate(CommandLine& line);
void add_mesh(CommandLine& line);
void add_check(CommandLine& line);
void add_converge(CommandLine& line);
void add_budget(CommandLine& line);
void add_sense(CommandLine& line);
void add_calibrate(CommandLine& line);
void add_study(CommandLine& line);
void add_claims(CommandLine& line);
void add_report(CommandLine& line);
void add_list(CommandLine& line);
void add_help(CommandLine& line);
void add_schema(CommandLine& line);

}  // namespace ciliaval::compare::app::commands
