// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/app/commands/converge_command.h"

#include <vector>

#include "compare/app/case_files.h"
#include "compare/app/terminal.h"
#include "compare/convergence/plot.h"
#include "compare/convergence/study.h"
#include "compare/output/output_file.h"
#include "compare/output/provenance.h"
#include "fem/parallel.h"
#include "problem/error.h"

namespace ciliaval::compare::app::commands {

ExitCode converge_case(const std::filesystem::path& file, const ConvergeOptions& options) {
  if (fem::rank_count() > 1)
    throw InputError("`ciliaval converge` runs on one rank: start it without mpirun");
  const input::Case problem = read_cases({file}).front();
  output::check_outputs({options.json, options.csv, options.plot}, input_files(file, problem));
  if (!problem.options.solid.mesh.empty())
    throw InputError(
        file.string() +
        ": a mesh of the user has no levels of refinement: leave out models.solid.mesh");
  std::vector<convergence::RefinementStudy> studies;
  bool failed = false;
  for (const convergence::Refinement& refinement : convergence::refinements(problem)) {
    ProgressLine line;
    studies.push_back(
        convergence::refinement_study(problem, refinement, options.levels, line.callback()));
    failed = failed || !studies.back().failure.empty();
  }
  if (options.json)
    output::write_file(*options.json, convergence::study_json(problem.name, studies,
                                                              output::provenance(options.command)));
  if (options.csv) output::write_file(*options.csv, convergence::study_csv(studies));
  if (studies.empty()) {
    print("The case has no model that can be refined: `dipole` is a closed form.\n");
    return ExitCode::undecided;
  }
  print(convergence::study_text(studies));
  if (options.plot) {
    const convergence::ConvergencePlot drawing = convergence::convergence_plot(problem, studies);
    if (drawing.script.empty())
      print("Nothing to plot: at no load step do the levels' values differ.\n");
    else
      plot::write_svg(*options.plot, drawing.script, drawing.size);
  }
  return failed ? ExitCode::solver : ExitCode::pass;
}

}  // namespace ciliaval::compare::app::commands
