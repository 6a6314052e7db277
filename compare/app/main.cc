// SPDX-License-Identifier: LGPL-2.1-or-later
#include <fcntl.h>
#include <fmt/core.h>
#include <fmt/ranges.h>

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "compare/app/commands/commands.h"
#include "compare/app/terminal.h"
#include "compare/output/provenance.h"
#include "compare/output/text_table.h"
#include "fem/parallel.h"
#include "problem/error.h"
#include "problem/support/words.h"

namespace {

namespace commands = ciliaval::compare::app::commands;
using commands::ExitCode;

constexpr const char* examples = R"(
Examples:
  ciliaval list                          what there is: models, loads, cases
  ciliaval new my --load flow            a case file to start from, my.toml
  ciliaval validate my.toml              is the case file right?
  ciliaval run my.toml                   results in results/<case name>
  ciliaval check                         are the results of all shipped cases as accepted?
  ciliaval converge my.toml              how far are the results from the converged ones?
  ciliaval budget my.toml                what does each assumption of the paper's model cost?
  ciliaval sense my.toml readings.csv    which load did the sensor read?
  ciliaval claims                        what of the paper holds, by which model?
  ciliaval study my.study.toml           how does the signal change with stiffness, size, load?
  ciliaval report                        one page of everything in results/
  ciliaval schema > case.schema.json     for editors (docs/guide/cases.md)
  ciliaval mesh my.toml -o my.msh        the solid's mesh, for Gmsh (.vtu: for ParaView)
  ciliaval run a.toml b.toml -o out      two cases, results in out/<case name>
  paraview --script=results/<case name>/vtk/open.py

A run or study that was killed goes on where it was when the same command is given again; --fresh
starts anew (docs/guide/results.md).

A case file states the cilium, its load, the sensors and the models, each quantity with its unit
(docs/guide/cases.md). The results are explained in docs/guide/results.md, meshes of one's own in
docs/guide/meshes.md.

Exit codes: 0 done, 1 `check`: a result is not as accepted, 2 wrong usage or case file, 3 a model
did not converge (the results of the others are written; `study`: every point failed), 4 a file
could not be read or written, 5 `check`, `converge`, `budget`, `sense`: nothing could be compared,
refined, judged or found.)";

/// A word as a POSIX shell reads it back: in single quotes if it holds anything special.
std::string shell_word(std::string_view word) {
  constexpr const char* plain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=./,:@%";
  if (!word.empty() && word.find_first_not_of(plain) == std::string_view::npos)
    return std::string(word);
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

/// The command line, to be pasted into a shell; without the folder of the program.
std::string command_line(int argc, char** argv) {
  std::string text = "ciliaval";
  for (int i = 1; i < argc; ++i) text += fmt::format(" {}", shell_word(argv[i]));
  return text;
}

/// Throws InputError if the first word is not a command, or if the command has not the options that
/// are asked for: CLI11 would say that a command is missing, or take an option's value for a file.
void check_words(const CLI::App& app, std::span<char* const> words) {
  if (words.size() < 2 || words[1][0] == '-') return;
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  const std::string name = words[1];
  const auto near = [](const std::string& word, const std::vector<std::string>& known) {
    return ciliaval::support::did_you_mean(
        word, std::vector<std::string_view>(known.begin(), known.end()));
  };
  if (std::ranges::find(names, name) == names.end())
    throw ciliaval::InputError(
        fmt::format("there is no command `{}`; the commands are {}; `ciliaval --help` explains "
                    "them{}",
                    name, fmt::join(names, ", "), near(name, names)));
  std::vector<std::string> options;
  for (const CLI::App* of : std::initializer_list<const CLI::App*>{&app, app.get_subcommand(name)})
    for (const CLI::Option* option : of->get_options())
      for (const std::string& word : option->get_lnames()) options.push_back("--" + word);
  for (const std::string word : words.subspan(2)) {
    if (word == "--") return;
    const std::string option = word.substr(0, word.find('='));
    if (!option.starts_with("--") || std::ranges::find(options, option) != options.end()) continue;
    throw ciliaval::InputError(
        fmt::format("`ciliaval {0}` has no option `{1}`, `ciliaval {0} --help` names all{2}", name,
                    option, near(option, options)));
  }
}

/// Help, version or a fault of the command line, as CLI11 words it.
ExitCode print_parse_result(const CLI::App& app, const CLI::ParseError& error) {
  std::ostringstream out;
  std::ostringstream err;
  const int code = app.exit(error, out, err);
  ciliaval::compare::app::print(out.str());
  fmt::print(stderr, "{}", ciliaval::support::printable(err.str()));
  return code == 0 ? ExitCode::pass : ExitCode::usage;
}

/// True if a message starts with `file:line:column: `, which editors jump to.
bool is_located(std::string_view message) {
  message = message.substr(0, message.find('\n'));
  const auto number_ends =
      [&](std::size_t begin) {  // where its colon stands; npos if there is none
        const std::size_t end = message.find_first_not_of("0123456789", begin);
        return end == begin || end == message.npos || message[end] != ':' ? message.npos : end;
      };
  for (std::size_t at = message.find(':', 1); at != message.npos; at = message.find(':', at + 1)) {
    const std::size_t line = number_ends(at + 1);
    const std::size_t column = line == message.npos ? line : number_ends(line + 1);
    if (column != message.npos && message.substr(column).starts_with(": ")) return true;
  }
  return false;
}

/// A file that the program opens must not become the standard output of a user who has closed it.
void open_standard_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(stream, F_GETFD) < 0 && open("/dev/null", O_RDWR) != stream)
      throw ciliaval::FileError("cannot open /dev/null");
}

ExitCode execute(int argc, char** argv) {
  CLI::App app{
      "Cross-validation of models of magnetic-cilium tactile sensors: runs several models of\n"
      "the bending and of the magnetic field on one case and says what separates them.",
      "ciliaval"};
  app.set_version_flag("--version", ciliaval::compare::output::version_line());
  app.footer(examples);
  app.require_subcommand(1);
  app.fallthrough();  // the command's options first, then these
  app.add_flag_callback("--quiet", ciliaval::compare::app::silence_progress,
                        "No progress on stderr; behind any command");
  commands::CommandLine line{app, command_line(argc, argv), {}};
  for (const auto add :
       {commands::add_new, commands::add_draw, commands::add_run, commands::add_validate,
        commands::add_mesh, commands::add_check, commands::add_converge, commands::add_budget,
        commands::add_sense, commands::add_calibrate, commands::add_study, commands::add_claims,
        commands::add_report, commands::add_list, commands::add_schema, commands::add_help})
    add(line);
  check_words(app, std::span(argv, static_cast<std::size_t>(argc)));
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return print_parse_result(app, error);
  }
  return line.chosen();
}

/// The stderr of a rank that keeps silent.
int silenced_stderr = STDERR_FILENO;

/// Under mpirun: rank 0 alone reads, writes and prints.
void start_ranks() {
  ciliaval::fem::start_mpi();
  if (ciliaval::fem::rank() == 0) return;
  silenced_stderr = dup(STDERR_FILENO);
  for (std::FILE* stream : {stdout, stderr})
    if (std::freopen("/dev/null", "w", stream) == nullptr)
      throw ciliaval::FileError("cannot open /dev/null");
}

/// Says what has gone wrong. Where all ranks meet the same error, rank 0 says it and ends them;
/// another rank speaks if it has failed alone, which it knows or learns by waiting.
void print_error(const std::string& message, bool of_this_rank_alone) {
  using namespace std::chrono_literals;
  if (ciliaval::fem::rank() > 0 && !of_this_rank_alone) std::this_thread::sleep_for(10s);
  const std::string line =
      fmt::format("{}{}\n", is_located(message) ? "" : ciliaval::compare::app::message_prefix(),
                  ciliaval::support::printable(message));
  const int file = ciliaval::fem::rank() > 0 ? silenced_stderr : STDERR_FILENO;
  if (write(file, line.data(), line.size()) < 0) return;  // there is nobody left to tell
}

/// Exit code of an error: `solver` for SolverError, RankFailure and any exception that no model
/// should throw.
ExitCode code_of(const std::exception& error) {
  if (dynamic_cast<const ciliaval::InputError*>(&error) != nullptr) return ExitCode::usage;
  const bool is_of_file = dynamic_cast<const ciliaval::FileError*>(&error) != nullptr ||
                          dynamic_cast<const std::filesystem::filesystem_error*>(&error) != nullptr;
  return is_of_file ? ExitCode::input_output : ExitCode::solver;
}

}  // namespace

/// The one place where errors become exit codes.
int main(int argc, char** argv) {
  ExitCode code = ExitCode::pass;
  std::string message;
  bool alone = false;
  try {
    open_standard_streams();
    std::signal(SIGXFSZ, SIG_IGN);  // a write beyond the limit of a file's size says so then
    if (ciliaval::fem::launched_on_several_ranks()) start_ranks();
    ciliaval::compare::output::set_line_width(ciliaval::compare::app::terminal_columns());
    code = execute(argc, argv);
  } catch (const std::exception& error) {
    code = code_of(error);
    message = error.what();
    alone = dynamic_cast<const ciliaval::RankFailure*>(&error) != nullptr;
  }
  if (!message.empty()) {
    print_error(message, alone);
    ciliaval::fem::abort_all_ranks(static_cast<int>(code));
  }
  return ciliaval::fem::from_first_rank(static_cast<int>(code));
}
