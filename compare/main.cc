// SPDX-License-Identifier: LGPL-2.1-or-later
#include <fmt/core.h>
#include <fmt/ranges.h>

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iostream>
#include <optional>
#include <regex>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "compare/budget_command.h"
#include "compare/check_command.h"
#include "compare/claims_command.h"
#include "compare/commands.h"
#include "compare/converge_command.h"
#include "compare/sense_command.h"
#include "compare/study_command.h"
#include "fem/parallel.h"
#include "problem/error.h"

namespace {

using ciliaval::compare::ExitCode;

constexpr const char* examples = R"(
Examples:
  ciliaval list                          what there is: models, loads, cases
  ciliaval validate my.toml              is the case file right?
  ciliaval run my.toml                   results in results/<case name>
  ciliaval check                         are the results of all shipped cases as accepted?
  ciliaval converge my.toml              how far are the results from the converged ones?
  ciliaval budget my.toml                what does each assumption of the paper's model cost?
  ciliaval sense my.toml readings.csv    which load did the sensor read?
  ciliaval claims                        what of the paper holds, by which model?
  ciliaval study my.study.toml           how does the signal change with stiffness, size, load?
  ciliaval mesh my.toml -o my.msh        the solid's mesh, for Gmsh (.vtu: for ParaView)
  ciliaval run a.toml b.toml -o out      two cases, results in out/<case name>
  paraview --script=results/<case name>/vtk/open.py

A run or study that was killed goes on where it was when the same command is given again; --fresh
starts anew (docs/restart.md).

A case file states the cilium, its load, the sensors and the models, each quantity with its unit
(docs/cases.md). The results are explained in docs/results.md, meshes of one's own in
docs/meshes.md.

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

/// Throws InputError if the first word is not a command; CLI11 would only say that one is missing.
void check_command(const CLI::App& app, int argc, char** argv) {
  if (argc < 2 || argv[1][0] == '-') return;
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  if (std::find(names.begin(), names.end(), argv[1]) != names.end()) return;
  throw ciliaval::InputError(
      fmt::format("there is no command `{}`; the commands are {}; "
                  "`ciliaval --help` explains them",
                  argv[1], fmt::join(names, ", ")));
}

/// Help, version or a fault of the command line, as CLI11 words it.
ExitCode print_parse_result(const CLI::App& app, const CLI::ParseError& error) {
  const int code = app.exit(error);
  std::cout.flush();
  if (!std::cout)
    throw ciliaval::FileError("cannot write to the standard output; is the disk full?");
  return code == 0 ? ExitCode::pass : ExitCode::usage;
}

/// Whether a message starts with `file:line:column: `, which editors jump to.
bool is_located(const std::string& message) {
  static const std::regex located("^[^\n]+:[0-9]+:[0-9]+: ");
  return std::regex_search(message, located, std::regex_constants::match_continuous);
}

constexpr const char* sense_help = R"(
READINGS.csv has a header with units and a row for each reading:

  sample, Bx [uT], By [uT], Bz [uT]
  unloaded, 12.1, -33.0, 2231.5          the straight cilium; several rows: their mean
  first, 71.4, -1.2, 2230.9
  second, 100.2, 14.8, 2226.0

or dBx, dBy, dBz, what the load has changed. Without READINGS, CASE is a simulated test bench,
NAME.sense.toml: errors of speed and direction, and which error of the sensor makes them. The load found is the least-squares solution with the
chosen pair of models, its interval that of the noise. `nothing`: the interval holds zero; `misfit`:
no load explains the reading; `beyond range`: see --largest (docs/sense.md).)";

CLI::App* add_sense(CLI::App& app, std::filesystem::path& file, std::filesystem::path& readings,
                    ciliaval::compare::SenseOptions& options) {
  CLI::App* sense = app.add_subcommand(
      "sense",
      "From what the sensors read to the load: force or flow speed and direction of each reading,\n"
      "with intervals of 95 %.");
  sense->footer(sense_help);
  sense
      ->add_option("CASE", file,
                   "Case file (TOML): cilium, kind of load, sensors; or a test bench,\n"
                   "NAME.sense.toml, which is simulated")
      ->required()
      ->check(CLI::ExistingFile);
  sense->add_option("READINGS", readings, "Readings (CSV with units)")->check(CLI::ExistingFile);
  sense
      ->add_option("--background", options.background,
                   "The ambient field at each azimuth of the stage (CSV: azimuth, Bx, By, Bz),\n"
                   "taken off the readings, which then have a column `azimuth`")
      ->type_name("FILE")
      ->check(CLI::ExistingFile);
  sense->add_option("--models", options.models, "The pair of models to invert, such as solid/mesh")
      ->type_name("MECHANICS/FIELD")
      ->capture_default_str();
  sense->add_option("--noise", options.noise, "Standard deviation of a component of a reading")
      ->type_name("QUANTITY")
      ->capture_default_str();
  sense
      ->add_option("--largest", options.largest,
                   "The largest load to look for; left out: 1.25 times the case's largest")
      ->type_name("QUANTITY");
  sense->add_option("--json", options.json, "Write the loads as JSON too")->type_name("FILE");
  sense->add_option("--csv", options.csv, "Write the loads as CSV too")->type_name("FILE");
  sense
      ->add_option("--plot", options.plot,
                   "Of a test bench: plot the loads found over the true ones; SVG, by gnuplot")
      ->type_name("FILE.svg");
  return sense;
}

constexpr const char* study_help = R"(
A study file names a case, the numbers of it to vary, and the pairs of models to run:

  [study]
  name = "my-study"                      # results in DIR/my-study
  case = "my.toml"                       # beside the study file
  pairs = ["elastica/line", "beam/volume"]
  outputs = ["dB_norm", "sensitivity", "range"]

  [fixed]                                # numbers of the case that differ from it
  load.force = "1 mN"

  [[parameter]]                          # one or more: every combination is a point
  path = "cilium.segment.base.young_modulus"
  from = "0.1 MPa"
  to = "3 MPa"
  count = 40
  spacing = "logarithmic"

  [tolerances]                           # or in place of it: standard deviations
  cilium.diameter = "0.05 mm"            # at the case with its fixed numbers
  cilium.segment.base.young_modulus = "5 %"

Each point is kept as soon as it is solved: a study that was killed goes on where it was when the
same command is given again. All keys and outputs: docs/study.md; examples: `ciliaval list`.)";

CLI::App* add_study(CLI::App& app, std::filesystem::path& file,
                    ciliaval::compare::StudyOptions& options) {
  CLI::App* study = app.add_subcommand(
      "study",
      "Parameter study: vary numbers of a case, alone or together, run pairs of models at each\n"
      "point, and write tables and plots of the signal, its sensitivity and its range; propagate\n"
      "tolerances to their standard deviations.");
  study->footer(study_help);
  study->add_option("STUDY", file, "Study file (TOML)")->required()->check(CLI::ExistingFile);
  study
      ->add_option("-o,--output", options.directory,
                   "Folder for the results: study.csv, study.json, plots and the journal of what\n"
                   "is solved, in a subfolder of the study's name")
      ->type_name("DIR")
      ->capture_default_str();
  study->add_option("--json", options.json, "Write study.json to this file too")->type_name("FILE");
  study->add_flag("--fresh", options.fresh,
                  "Start anew: forget what an earlier run of the study has solved");
  return study;
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
  ciliaval::compare::RunOptions options;
  options.command = command_line(argc, argv);
  CLI::App* run = app.add_subcommand("run", "Run cases, compare the models, write the results");
  run->add_option("CASE", files, "Case files (TOML)")->required()->check(CLI::ExistingFile);
  run->add_option("-o,--output", options.directory,
                  "Folder for the results, one subfolder for each case")
      ->type_name("DIR")
      ->capture_default_str();
  run->add_flag("--fresh", options.fresh,
                "Start anew: delete the checkpoint of a run that was killed or did not converge");
  CLI::App* validate = app.add_subcommand("validate", "Read and check case files, run nothing");
  validate->add_option("CASE", files, "Case and study files (TOML)")
      ->required()
      ->check(CLI::ExistingFile);
  CLI::App* mesh = app.add_subcommand(
      "mesh",
      "Write the solid's mesh of a case to a file: FILE.msh for Gmsh, with the names of the\n"
      "segments and the boundary, or FILE.vtu for ParaView. A .msh can be changed and named\n"
      "in the case, [models.solid] mesh = \"FILE.msh\" (docs/meshes.md).");
  std::filesystem::path mesh_case;
  std::filesystem::path mesh_file;
  std::optional<unsigned int> refinement;
  mesh->add_option("CASE", mesh_case, "Case file (TOML)")->required()->check(CLI::ExistingFile);
  mesh->add_option("-o,--output", mesh_file,
                   "File to write: .msh or .vtu; one that is there is replaced")
      ->type_name("FILE")
      ->required();
  mesh->add_option("--refinement", refinement,
                   "0 coarse, 1 default, 2 fine; left out: as the case says")
      ->type_name("N");
  CLI::App* check = app.add_subcommand(
      "check",
      "Regression check: run cases, by default all shipped ones, and hold every result against\n"
      "the accepted one in the baseline beside the case, NAME.baseline.json (docs/evidence.md).");
  ciliaval::compare::CheckOptions check_options;
  check_options.command = options.command;
  check->add_option("CASE", files, "Case files (TOML); none: all shipped ones")
      ->check(CLI::ExistingFile);
  check->add_flag("--quick", check_options.quick,
                  "Leave out solid and potential: seconds instead of minutes");
  check->add_flag(
      "--accept", check_options.accept,
      "Check nothing: write NAME.baseline.candidate.json beside each case that has\n"
      "changed, and say what changed from what to what. It is accepted by renaming it.");
  check->add_option("--junit", check_options.junit, "Write the report as JUnit's XML too")
      ->type_name("FILE");
  check->add_option("--json", check_options.json, "Write the report as JSON too")
      ->type_name("FILE");
  CLI::App* converge = app.add_subcommand(
      "converge",
      "Refinement study: refine meshes, element degrees, sums and tolerances of each model of a\n"
      "case; give the observed order, the extrapolated value and its interval of each result, or\n"
      "say why there is none.");
  std::filesystem::path converge_file;
  ciliaval::compare::ConvergeOptions converge_options;
  converge->add_option("CASE", converge_file, "Case file (TOML)")
      ->required()
      ->check(CLI::ExistingFile);
  converge
      ->add_option("--levels", converge_options.levels,
                   "How many levels of each refinement, from the coarsest, or as many as there\n"
                   "are (solid 4, potential 3)")
      ->capture_default_str();
  converge->add_option("--json", converge_options.json, "Write the study as JSON too")
      ->type_name("FILE");
  converge->add_option("--csv", converge_options.csv, "Write the study as CSV too")
      ->type_name("FILE");
  converge
      ->add_option(
          "--plot", converge_options.plot,
          "Plot the errors over the levels' sizes, with the fitted orders; SVG, by gnuplot")
      ->type_name("FILE.svg");
  CLI::App* budget = app.add_subcommand(
      "budget",
      "Error budget: split what lies between the paper's model and the best one into the parts of\n"
      "its assumptions, each with its numerical uncertainty, for tip, B, dB and dB/dF.");
  std::filesystem::path budget_file;
  ciliaval::compare::BudgetOptions budget_options;
  budget->add_option("CASE", budget_file, "Case file (TOML); its lists of models do not matter")
      ->required()
      ->check(CLI::ExistingFile);
  budget
      ->add_option(
          "--without", budget_options.without,
          "Leave out beam, solid, volume, mesh, potential, dipole or sensitivity (dB/dF);\n"
          "may be repeated. Without solid and potential it takes a second.")
      ->type_name("MODEL")
      ->expected(1)
      ->take_all();
  budget->add_option("--json", budget_options.json, "Write the budget as JSON too")
      ->type_name("FILE");
  budget->add_option("--csv", budget_options.csv, "Write the budget as CSV too")->type_name("FILE");
  budget
      ->add_option("--plot", budget_options.plot,
                   "Plot tip and dB of the last step as a waterfall; SVG, by gnuplot")
      ->type_name("FILE.svg");
  std::filesystem::path sense_file;
  std::filesystem::path sense_readings;
  ciliaval::compare::SenseOptions sense_options;
  const CLI::App* sense = add_sense(app, sense_file, sense_readings, sense_options);
  std::filesystem::path study_file;
  ciliaval::compare::StudyOptions study_options;
  study_options.command = options.command;
  const CLI::App* study = add_study(app, study_file, study_options);
  ciliaval::compare::ClaimsOptions claims_options;
  CLI::App* claims = app.add_subcommand(
      "claims",
      "The paper's quantitative statements, each with what the models find: reproduced, not\n"
      "reproduced, depends on the model, or not checkable and why (docs/paper.md).");
  claims->add_flag("--quick", claims_options.quick,
                   "Without the 3D solid: seconds instead of two minutes");
  claims->add_option("--json", claims_options.json, "Write the ledger as JSON too")
      ->type_name("FILE");
  const CLI::App* list = app.add_subcommand("list", "List models, loads, shipped cases, studies");

  check_command(app, argc, argv);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return print_parse_result(app, error);
  }
  if (list->parsed())
    ciliaval::compare::list();
  else if (validate->parsed())
    ciliaval::compare::validate_cases(files);
  else if (check->parsed())
    return ciliaval::compare::check_cases(files, check_options);
  else if (converge->parsed())
    return ciliaval::compare::converge_case(converge_file, converge_options);
  else if (budget->parsed())
    return ciliaval::compare::budget_case(budget_file, budget_options);
  else if (sense->parsed())
    return ciliaval::compare::sense(sense_file, sense_readings, sense_options);
  else if (claims->parsed())
    return ciliaval::compare::print_claims(claims_options);
  else if (study->parsed())
    return ciliaval::compare::run_study(study_file, study_options);
  else if (mesh->parsed())
    ciliaval::compare::write_mesh(mesh_case, mesh_file, refinement, command_line(argc, argv));
  else
    return ciliaval::compare::run_cases(files, options);
  return ExitCode::pass;
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
  const std::string line = fmt::format("{}{}\n", is_located(message) ? "" : "ciliaval: ", message);
  const int file = ciliaval::fem::rank() > 0 ? silenced_stderr : STDERR_FILENO;
  if (write(file, line.data(), line.size()) < 0) return;  // there is nobody left to tell
}

}  // namespace

/// The one place where errors become exit codes.
int main(int argc, char** argv) {
  ExitCode code = ExitCode::pass;
  std::string message;
  bool alone = false;
  try {
    if (ciliaval::fem::launched_on_several_ranks()) start_ranks();
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
  } catch (const ciliaval::RankFailure& error) {
    code = ExitCode::solver;
    message = error.what();
    alone = true;
  } catch (const std::exception& error) {  // SolverError, and what no model should throw
    code = ExitCode::solver;
    message = error.what();
  }
  if (!message.empty()) {
    print_error(message, alone);
    ciliaval::fem::abort_all_ranks(static_cast<int>(code));
  }
  return ciliaval::fem::from_first_rank(static_cast<int>(code));
}
