// SPDX-License-Identifier: LGPL-2.1-or-later
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

#include "compare/commands.h"
#include "problem/error.h"

namespace {

using ciliaval::compare::ExitCode;

constexpr const char* examples = R"(
Examples:
  ciliaval list                          what there is: models, loads, cases
  ciliaval validate my.toml              is the case file right?
  ciliaval run my.toml                   results in results/<case name>
  ciliaval run a.toml b.toml -o out      two cases, results in out/<case name>
  paraview --script=results/<case name>/vtk/open.py

A case file states the cilium, its load, the sensors and the models, each quantity with its unit
(docs/cases.md). The results are explained in docs/results.md.

Exit codes: 0 done, 2 wrong usage or case file, 3 a model did not converge (the results of the
others are written), 4 a file could not be read or written.)";

/// The command line as it was typed, but for the folder of the program.
std::string command_line(int argc, char** argv) {
  std::string text = "ciliaval";
  for (int i = 1; i < argc; ++i) text += std::string(" ") + argv[i];
  return text;
}

ExitCode execute(int argc, char** argv) {
  CLI::App app{
      "Cross-validation of models of magnetic-cilium tactile sensors: runs several models of\n"
      "the bending and of the magnetic field on one case and says what separates them.",
      "ciliaval"};
  app.set_version_flag("--version", ciliaval::compare::version_line());
  app.footer(examples);
  app.require_subcommand(1);

  std::vector<std::filesystem::path> files;
  std::filesystem::path directory = "results";
  CLI::App* run = app.add_subcommand("run", "Run cases, compare the models, write the results");
  run->add_option("CASE", files, "Case files (TOML)")->required()->check(CLI::ExistingFile);
  run->add_option("-o,--output", directory, "Folder for the results, one subfolder for each case")
      ->type_name("DIR")
      ->capture_default_str();
  CLI::App* validate = app.add_subcommand("validate", "Read and check case files, run nothing");
  validate->add_option("CASE", files, "Case files (TOML)")->required()->check(CLI::ExistingFile);
  const CLI::App* list = app.add_subcommand("list", "List models, loads and shipped cases");

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? ExitCode::pass : ExitCode::usage;
  }
  if (list->parsed())
    ciliaval::compare::list();
  else if (validate->parsed())
    ciliaval::compare::validate_cases(files);
  else
    return ciliaval::compare::run_cases(files, directory, command_line(argc, argv));
  return ExitCode::pass;
}

}  // namespace

/// The one place where errors become exit codes.
int main(int argc, char** argv) {
  ExitCode code = ExitCode::pass;
  std::string message;
  try {
    code = execute(argc, argv);
  } catch (const ciliaval::InputError& error) {
    code = ExitCode::usage;
    message = error.what();
  } catch (const ciliaval::FileError& error) {
    code = ExitCode::input_output;
    message = error.what();
  } catch (const std::filesystem::filesystem_error& error) {
    code = ExitCode::input_output;
    message = error.what();
  } catch (const std::exception& error) {  // SolverError, and what no model should throw
    code = ExitCode::solver;
    message = error.what();
  }
  if (!message.empty()) fmt::print(stderr, "ciliaval: {}\n", message);
  return static_cast<int>(code);
}
