// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/app/commands/budget_command.h"

#include <stdexcept>

#include "compare/budget/budget.h"
#include "compare/budget/report.h"
#include "compare/app/case_files.h"
#include "compare/output/provenance.h"
#include "compare/models/registry.h"
#include "compare/output/results.h"
#include "compare/app/terminal.h"
#include "fem/parallel.h"
#include "problem/error.h"

namespace ciliaval::compare {
namespace {

Budget run_budget(const Case& problem, const std::vector<std::string>& without) {
  ProgressLine line;
  return error_budget(problem, mechanics_models(), field_models(), without, line.callback());
}

}  // namespace

ExitCode budget_case(const std::filesystem::path& file, const BudgetOptions& options) {
  if (fem::rank_count() > 1)
    throw InputError("`ciliaval budget` runs on one rank: start it without mpirun");
  const Case problem = read_cases({file}).front();
  const Budget budget = run_budget(problem, options.without);
  for (const BudgetRow& row : budget.rows)
    if (const std::string message = fault(row); !message.empty())
      throw std::logic_error("the error budget is wrong, please report it: " + message);
  print(budget_text(budget));
  if (options.json) replace_text(*options.json, budget_json(budget, provenance(options.command)));
  if (options.csv) replace_text(*options.csv, budget_csv(budget));
  if (options.plot) {
    const Waterfall drawing = waterfall(budget);
    if (drawing.script.empty())
      print("Nothing to plot.\n");
    else
      plot::write_svg(*options.plot, drawing.script, drawing.size);
  }
  if (budget.failed) return ExitCode::solver;
  return budget.decided() ? ExitCode::pass : ExitCode::undecided;
}

}  // namespace ciliaval::compare
