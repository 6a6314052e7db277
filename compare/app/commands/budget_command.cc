// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/app/commands/commands.h"

#include <fmt/core.h>

#include "compare/app/case_files.h"
#include "compare/app/python.h"
#include "compare/app/terminal.h"
#include "compare/budget/budget.h"
#include "compare/budget/report.h"
#include "compare/models/registry.h"
#include "compare/output/output_file.h"
#include "compare/output/provenance.h"
#include "compare/output/sweep.h"
#include "problem/error.h"

namespace ciliaval::compare::app::commands {
namespace {

struct BudgetOptions {
  std::filesystem::path file;
  std::vector<std::string> without;  ///< models left out, "sensitivity"
  Outputs outputs;
  bool explain = false;  ///< print the footnotes
};

budget::Budget run_budget(const input::Case& problem, const std::vector<std::string>& without) {
  ProgressLine line;
  return budget::error_budget(problem, models::mechanics_models(), models::field_models(), without,
                              line.callback());
}

/// Splits the difference between the paper's model and the best one into the parts of its
/// assumptions, whatever models the case lists. Returns `solver` if a model failed somewhere,
/// `undecided` if no link could be judged.
ExitCode execute_budget(const BudgetOptions& options, const std::string& words) {
  require_one_rank("budget");
  const input::Case problem = read_cases({options.file}).front();
  if (output::is_sweep(problem))
    throw InputError(
        fmt::format("{}: an error budget needs a load with a magnitude, such as "
                    "'contact'; the case is a sweep, which `ciliaval run` follows",
                    options.file.string()));
  options.outputs.check(input_files(options.file, problem));
  const budget::Budget budget = run_budget(problem, options.without);
  print(budget::budget_text(budget, footnotes_of(options.explain)));
  options.outputs.write([&] { return budget::budget_json(budget, output::provenance(words)); },
                        [&] { return budget::budget_csv(budget); });
  if (budget.failed) return ExitCode::solver;
  return budget.decided() ? ExitCode::pass : ExitCode::undecided;
}

}  // namespace

void add_budget(CommandLine& line) {
  const auto options = std::make_shared<BudgetOptions>();
  CLI::App* budget = line.add(
      "budget",
      "Error budget: split what lies between the paper's model and the best one into the parts of\n"
      "its assumptions, each with its numerical uncertainty, for tip, B, dB and dB/dF.",
      options, execute_budget);
  add_file(budget, "CASE", options->file, "Case file (TOML); its lists of models do not matter");
  budget
      ->add_option(
          "--without", options->without,
          "Leave out beam, solid, volume, mesh, potential, dipole or sensitivity (dB/dF);\n"
          "may be repeated. Without solid and potential it takes a second.")
      ->type_name("MODEL")
      ->expected(1)
      ->take_all();
  options->outputs.declare(budget, "the budget", true,
                           "Plot tip and dB of the last step as a waterfall: SVG, PDF or PNG");
  add_explain(budget, options->explain);
}

}  // namespace ciliaval::compare::app::commands
