// SPDX-License-Identifier: LGPL-2.1-or-later
// The commands as a user sees them: names, options, help. Each calls one function of its own.
#include "compare/app/command_line.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "compare/app/commands/budget_command.h"
#include "compare/app/commands/check_command.h"
#include "compare/app/commands/claims_command.h"
#include "compare/app/commands/converge_command.h"
#include "compare/app/commands/report_command.h"
#include "compare/app/commands/sense_command.h"
#include "compare/app/commands/study_command.h"

namespace ciliaval::compare::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* sense_help = R"(
READINGS.csv has a header with units and a row for each reading:

  sample, Bx [uT], By [uT], Bz [uT]
  unloaded, 12.1, -33.0, 2231.5          the straight cilium; several rows: their mean
  first, 71.4, -1.2, 2230.9
  second, 100.2, 14.8, 2226.0

or dBx, dBy, dBz, what the load has changed. Without READINGS, CASE is a simulated test bench,
NAME.sense.toml: errors of speed and direction, and which error of the sensor makes them.

The load found is the least-squares solution with the chosen pair of models, its interval that of
the noise. `nothing`: the interval holds zero; `misfit`: no load explains the reading; `beyond
range`: see --largest (docs/guide/sensing.md).)";

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

  [optimise]                             # or: the best design within `from` and `to` of each
  maximise = "dB_norm"                   # [[parameter]], found with the first pair, confirmed
  at_least.range = "2 mN"                # with all of them

Each point is kept as soon as it is solved: a study that was killed goes on where it was when the
same command is given again. All keys and outputs: docs/guide/studies.md; examples:
`ciliaval list`.)";

constexpr const char* report_help = R"(
The page shows what lies in DIR and in the folders in it, whatever the files are called:

  ciliaval run CASE.toml -o DIR                      DIR/<case>/summary.json
  ciliaval study NAME.study.toml -o DIR              DIR/<study>/study.json
  ciliaval budget CASE.toml --json DIR/NAME.budget.json
  ciliaval converge CASE.toml --json DIR/NAME.converge.json
  ciliaval sense NAME.sense.toml --json DIR/NAME.sense.json
  ciliaval claims --json DIR/claims.json
  ciliaval check --json DIR/check.json
  pvpython DIR/<case>/vtk/open.py DIR/pictures/NAME.png

What is not there is named in the page with its command. No number is computed: each is from a
file that the page names. A file that is damaged is named, the others are shown, and the exit code
is 4; so it is where gnuplot, which draws the figures, is not installed (docs/guide/report.md).)";

/// Lets `chosen` become the command when the command line names it.
void choose(CLI::App* command, Command& chosen, Command execute) {
  command->callback([&chosen, execute = std::move(execute)] { chosen = execute; });
}

/// A positional file that must exist.
CLI::Option* add_file(CLI::App* command, const char* name, fs::path& file, const char* what) {
  return command->add_option(name, file, what)->required()->check(CLI::ExistingFile);
}

void add_run(CLI::App& app, const std::string& command_line, Command& chosen) {
  const auto files = std::make_shared<std::vector<fs::path>>();
  const auto options = std::make_shared<commands::RunOptions>();
  options->command = command_line;
  CLI::App* run = app.add_subcommand("run", "Run cases, compare the models, write the results");
  run->add_option("CASE", *files, "Case files (TOML)")->required()->check(CLI::ExistingFile);
  run->add_option("-o,--output", options->directory,
                  "Folder for the results, one subfolder for each case")
      ->type_name("DIR")
      ->capture_default_str();
  run->add_flag("--fresh", options->fresh,
                "Start anew: delete the checkpoint of a run that was killed or did not converge");
  choose(run, chosen, [files, options] { return commands::run_cases(*files, *options); });
}

void add_validate(CLI::App& app, Command& chosen) {
  const auto files = std::make_shared<std::vector<fs::path>>();
  CLI::App* validate = app.add_subcommand("validate", "Read and check case files, run nothing");
  validate->add_option("CASE", *files, "Case, study and test bench files (TOML)")
      ->required()
      ->check(CLI::ExistingFile);
  choose(validate, chosen, [files] {
    commands::validate_cases(*files);
    return commands::ExitCode::pass;
  });
}

void add_mesh(CLI::App& app, const std::string& command_line, Command& chosen) {
  struct Options {
    fs::path problem;
    fs::path output;
    std::optional<unsigned int> refinement;
  };
  const auto options = std::make_shared<Options>();
  CLI::App* mesh = app.add_subcommand(
      "mesh",
      "Write the solid's mesh of a case to a file: FILE.msh for Gmsh, with the names of the\n"
      "segments and the boundary, or FILE.vtu for ParaView. A .msh can be changed and named\n"
      "in the case, [models.solid] mesh = \"FILE.msh\" (docs/guide/meshes.md).");
  add_file(mesh, "CASE", options->problem, "Case file (TOML)");
  mesh->add_option("-o,--output", options->output,
                   "File to write: .msh or .vtu; one that is there is replaced")
      ->type_name("FILE")
      ->required();
  mesh->add_option("--refinement", options->refinement,
                   "0 coarse, 1 default, 2 fine; left out: as the case says")
      ->type_name("N");
  choose(mesh, chosen, [options, command_line] {
    commands::write_mesh(options->problem, options->output, options->refinement, command_line);
    return commands::ExitCode::pass;
  });
}

void add_check(CLI::App& app, const std::string& command_line, Command& chosen) {
  const auto files = std::make_shared<std::vector<fs::path>>();
  const auto options = std::make_shared<commands::CheckOptions>();
  options->command = command_line;
  CLI::App* check = app.add_subcommand(
      "check",
      "Regression check: run cases, by default all shipped ones, and hold every result against\n"
      "the accepted one in the baseline beside the case, NAME.baseline.json "
      "(docs/guide/accuracy.md).");
  check->add_option("CASE", *files, "Case files (TOML); none: all shipped ones")
      ->check(CLI::ExistingFile);
  check->add_flag("--quick", options->quick,
                  "Leave out solid and potential: seconds instead of minutes");
  check->add_flag(
      "--accept", options->accept,
      "Check nothing: write NAME.baseline.candidate.json beside each case that has\n"
      "changed, and say what changed from what to what. It is accepted by renaming it.");
  check->add_option("--junit", options->junit, "Write the report as JUnit's XML too")
      ->type_name("FILE");
  check->add_option("--json", options->json, "Write the report as JSON too")->type_name("FILE");
  choose(check, chosen, [files, options] { return commands::check_cases(*files, *options); });
}

void add_converge(CLI::App& app, const std::string& command_line, Command& chosen) {
  const auto file = std::make_shared<fs::path>();
  const auto options = std::make_shared<commands::ConvergeOptions>();
  options->command = command_line;
  CLI::App* converge = app.add_subcommand(
      "converge",
      "Refinement study: refine meshes, element degrees, sums and tolerances of each model of a\n"
      "case; give the observed order, the extrapolated value and its interval of each result, or\n"
      "say why there is none.");
  add_file(converge, "CASE", *file, "Case file (TOML)");
  converge
      ->add_option("--levels", options->levels,
                   "How many levels of each refinement, from the coarsest, or as many as there\n"
                   "are (solid 4, potential 3)")
      ->capture_default_str();
  converge->add_option("--json", options->json, "Write the study as JSON too")->type_name("FILE");
  converge->add_option("--csv", options->csv, "Write the study as CSV too")->type_name("FILE");
  converge
      ->add_option(
          "--plot", options->plot,
          "Plot the errors over the levels' sizes, with the fitted orders; SVG, by gnuplot")
      ->type_name("FILE.svg");
  choose(converge, chosen, [file, options] { return commands::converge_case(*file, *options); });
}

void add_budget(CLI::App& app, const std::string& command_line, Command& chosen) {
  const auto file = std::make_shared<fs::path>();
  const auto options = std::make_shared<commands::BudgetOptions>();
  options->command = command_line;
  CLI::App* budget = app.add_subcommand(
      "budget",
      "Error budget: split what lies between the paper's model and the best one into the parts of\n"
      "its assumptions, each with its numerical uncertainty, for tip, B, dB and dB/dF.");
  add_file(budget, "CASE", *file, "Case file (TOML); its lists of models do not matter");
  budget
      ->add_option(
          "--without", options->without,
          "Leave out beam, solid, volume, mesh, potential, dipole or sensitivity (dB/dF);\n"
          "may be repeated. Without solid and potential it takes a second.")
      ->type_name("MODEL")
      ->expected(1)
      ->take_all();
  budget->add_option("--json", options->json, "Write the budget as JSON too")->type_name("FILE");
  budget->add_option("--csv", options->csv, "Write the budget as CSV too")->type_name("FILE");
  budget
      ->add_option("--plot", options->plot,
                   "Plot tip and dB of the last step as a waterfall; SVG, by gnuplot")
      ->type_name("FILE.svg");
  choose(budget, chosen, [file, options] { return commands::budget_case(*file, *options); });
}

void add_sense(CLI::App& app, const std::string& command_line, Command& chosen) {
  const auto file = std::make_shared<fs::path>();
  const auto readings = std::make_shared<fs::path>();
  const auto options = std::make_shared<commands::SenseOptions>();
  options->command = command_line;
  CLI::App* sense = app.add_subcommand(
      "sense",
      "From what the sensors read to the load: force or flow speed and direction of each reading,\n"
      "with intervals of 95 %.");
  sense->footer(sense_help);
  sense
      ->add_option("CASE", *file,
                   "Case file (TOML): cilium, kind of load, sensors; or a test bench,\n"
                   "NAME.sense.toml, which is simulated")
      ->required()
      ->check(CLI::ExistingFile);
  sense->add_option("READINGS", *readings, "Readings (CSV with units)")->check(CLI::ExistingFile);
  sense
      ->add_option("--background", options->background,
                   "The ambient field at each azimuth of the stage (CSV: azimuth, Bx, By, Bz),\n"
                   "taken off the readings, which then have a column `azimuth`")
      ->type_name("FILE")
      ->check(CLI::ExistingFile);
  sense->add_option("--models", options->models, "The pair of models to invert, such as solid/mesh")
      ->type_name("MECHANICS/FIELD")
      ->capture_default_str();
  sense->add_option("--noise", options->noise, "Standard deviation of a component of a reading")
      ->type_name("QUANTITY")
      ->capture_default_str();
  sense
      ->add_option("--largest", options->largest,
                   "The largest load to look for; left out: 1.25 times the case's largest")
      ->type_name("QUANTITY");
  sense->add_option("--json", options->json, "Write the loads as JSON too")->type_name("FILE");
  sense->add_option("--csv", options->csv, "Write the loads as CSV too")->type_name("FILE");
  sense
      ->add_option("--plot", options->plot,
                   "Of a test bench: plot the loads found over the true ones; SVG, by gnuplot")
      ->type_name("FILE.svg");
  choose(sense, chosen, [file, readings, options, sense] {
    for (const CLI::Option* option : sense->get_options())
      if (option->count() > 0) options->given.push_back(option->get_name());
    return compare::app::commands::sense(*file, *readings, *options);
  });
}

void add_study(CLI::App& app, const std::string& command_line, Command& chosen) {
  const auto file = std::make_shared<fs::path>();
  const auto options = std::make_shared<commands::StudyOptions>();
  options->command = command_line;
  CLI::App* study = app.add_subcommand(
      "study",
      "Parameter study: vary numbers of a case, alone or together, run pairs of models at each\n"
      "point, and write tables and plots of the signal, its sensitivity and its range; propagate\n"
      "tolerances to their standard deviations; find the best design within limits.");
  study->footer(study_help);
  add_file(study, "STUDY", *file, "Study file (TOML)");
  study
      ->add_option("-o,--output", options->directory,
                   "Folder for the results: study.csv, study.json, plots and the journal of what\n"
                   "is solved, in a subfolder of the study's name")
      ->type_name("DIR")
      ->capture_default_str();
  study->add_option("--json", options->json, "Write study.json to this file too")
      ->type_name("FILE");
  study->add_flag("--fresh", options->fresh,
                  "Start anew: forget what an earlier run of the study has solved");
  choose(study, chosen, [file, options] { return commands::run_study(*file, *options); });
}

void add_claims(CLI::App& app, const std::string& command_line, Command& chosen) {
  const auto options = std::make_shared<commands::ClaimsOptions>();
  options->command = command_line;
  CLI::App* claims = app.add_subcommand(
      "claims",
      "The paper's quantitative statements, each with what the models find: reproduced, not\n"
      "reproduced, depends on the model, or not checkable and why (docs/evidence/paper.md).");
  claims->add_flag("--quick", options->quick,
                   "Without the 3D solid: seconds instead of two minutes");
  claims->add_option("--json", options->json, "Write the ledger as JSON too")->type_name("FILE");
  choose(claims, chosen, [options] { return commands::print_claims(*options); });
}

void add_report(CLI::App& app, const std::string& command_line, Command& chosen) {
  const auto folder = std::make_shared<fs::path>("results");
  const auto options = std::make_shared<commands::ReportOptions>();
  options->command = command_line;
  CLI::App* report = app.add_subcommand(
      "report",
      "One page of everything in a folder of results, as one file that opens offline: cases,\n"
      "studies, error budgets, convergence, loads from readings, the ledger of claims, pictures.");
  report->footer(report_help);
  report->add_option("DIR", *folder, "Folder of results")->capture_default_str();
  report
      ->add_option("-o,--output", options->output,
                   "File to write; left out: DIR/report.html. One that is there is replaced")
      ->type_name("FILE.html");
  choose(report, chosen, [folder, options] { return commands::write_report(*folder, *options); });
}

}  // namespace

void add_commands(CLI::App& app, const std::string& command_line, Command& chosen) {
  add_run(app, command_line, chosen);
  add_validate(app, chosen);
  add_mesh(app, command_line, chosen);
  add_check(app, command_line, chosen);
  add_converge(app, command_line, chosen);
  add_budget(app, command_line, chosen);
  add_sense(app, command_line, chosen);
  add_study(app, command_line, chosen);
  add_claims(app, command_line, chosen);
  add_report(app, command_line, chosen);
  choose(app.add_subcommand("list", "List models, loads, shipped cases, studies and benches"),
         chosen, [] {
           commands::list();
           return commands::ExitCode::pass;
         });
}

}  // namespace ciliaval::compare::app
