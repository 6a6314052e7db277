// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/app/commands/budget_command.h"

#include <stdexcept>

#include "compare/app/case_files.h"
#include "compare/app/terminal.h"
#include "compare/budget/budget.h"
#include "compare/budget/report.h"
#include "compare/models/registry.h"
#include "compare/output/output_file.h"
#include "compare/output/provenance.h"
#include "fem/parallel.h"
#include "problem/error.h"

namespace ciliaval::compare::app::commands {
namespace {

budget::Budget run_budget(const input::Case& problem, const std::vector<std::string>& without) {
  ProgressLine line;
  return budget::error_budget(problem, models::mechanics_models(), models::field_models(), without,
                              line.callback());
}

}  // namespace

ExitCode budget_case(const std::filesystem::path& file, const BudgetOptions& options) {
  if (fem::rank_count() > 1)
    throw InputError("`ciliaval budget` runs on one rank: start it without mpirun");
  const input::Case problem = read_cases({file}).front();
  output::check_outputs({options.json, options.csv, options.plot}, input_files(file, problem));
  const budget::Budget budget = run_budget(problem, options.without);
  for (const budget::BudgetRow& row : budget.rows)
    if (const std::string message = budget::fault(row); !message.empty())
      throw std::logic_error("the error budget is wrong, please report it: " + message);
  print(budget::budget_text(budget));
  if (options.json)
    output::write_file(*options.json,
                       budget::budget_json(budget, output::provenance(options.command)));
  if (options.csv) output::write_file(*options.csv, budget::budget_csv(budget));
  if (options.plot) {
    const budget::Waterfall drawing = budget::waterfall(budget);
    if (drawing.script.empty())
      print("Nothing to plot.\n");
    else
      plot::write_svg(*options.plot, drawing.script, drawing.size);
  }
  if (budget.failed) return ExitCode::solver;
  return budget.decided() ? ExitCode::pass : ExitCode::undecided;
}

}  // namespace ciliaval::compare::app::commands
