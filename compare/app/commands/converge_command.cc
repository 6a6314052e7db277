// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/app/commands/converge_command.h"

#include <vector>

#include "compare/app/case_files.h"
#include "compare/convergence/plot.h"
#include "compare/convergence/study.h"
#include "compare/output/provenance.h"
#include "compare/output/results.h"
#include "compare/app/terminal.h"
#include "fem/parallel.h"
#include "problem/error.h"

namespace ciliaval::compare {

ExitCode converge_case(const std::filesystem::path& file, const ConvergeOptions& options) {
  if (fem::rank_count() > 1)
    throw InputError("`ciliaval converge` runs on one rank: start it without mpirun");
  const Case problem = read_cases({file}).front();
  if (!problem.options.solid.mesh.empty())
    throw InputError(
        file.string() +
        ": a mesh of the user has no levels of refinement: leave out models.solid.mesh");
  std::vector<RefinementStudy> studies;
  bool failed = false;
  for (const Refinement& refinement : refinements(problem)) {
    ProgressLine line;
    studies.push_back(refinement_study(problem, refinement, options.levels, line.callback()));
    failed = failed || !studies.back().failure.empty();
  }
  if (options.json)
    replace_text(*options.json, study_json(problem.name, studies, provenance(options.command)));
  if (options.csv) replace_text(*options.csv, study_csv(studies));
  if (studies.empty()) {
    print("The case has no model that can be refined: `dipole` is a closed form.\n");
    return ExitCode::undecided;
  }
  print(study_text(studies));
  if (options.plot) {
    const ConvergencePlot drawing = convergence_plot(problem, studies);
    if (drawing.script.empty())
      print("Nothing to plot: at no load step do the levels' values differ.\n");
    else
      plot::write_svg(*options.plot, drawing.script, drawing.size);
  }
  return failed ? ExitCode::solver : ExitCode::pass;
}

}  // namespace ciliaval::compare
