// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/app/commands/commands.h"

#include <vector>

#include "compare/app/case_files.h"
#include "compare/app/python.h"
#include "compare/app/terminal.h"
#include "compare/convergence/study.h"
#include "compare/models/registry.h"
#include "compare/output/output_file.h"
#include "compare/output/provenance.h"
#include "problem/error.h"

namespace ciliaval::compare::app::commands {
namespace {

struct ConvergeOptions {
  std::filesystem::path file;
  unsigned int levels = 3;
  bool list = false;  ///< print the numbers
  Outputs outputs;
};

/// Refines each model of a case through the levels of its meshes, degrees, sums and tolerances.
/// Returns `solver` if a model failed on a level, `undecided` if the case has no model that can be
/// refined.
ExitCode execute_converge(const ConvergeOptions& options, const std::string& words) {
  require_one_rank("converge");
  const input::Case problem = read_cases({options.file}).front();
  options.outputs.check(input_files(options.file, problem));
  for (const auto& [option, mesh] : input::user_meshes(models::known(), problem.options))
    throw InputError(options.file.string() +
                     ": a mesh of the user has no levels of refinement: leave out " + option);
  std::vector<convergence::RefinementStudy> studies;
  bool failed = false;
  for (const convergence::ModelRefinement& refinement : convergence::refinements(problem)) {
    ProgressLine line;
    studies.push_back(
        convergence::refinement_study(problem, refinement, options.levels, line.callback()));
    failed = failed || !studies.back().failure.empty();
  }
  print(studies.empty()
            ? "The case has no model that can be refined: a closed form has no levels.\n"
            : convergence::study_text(studies, options.list));
  Outputs outputs = options.outputs;
  if (studies.empty()) outputs.plot.reset();
  outputs.write(
      [&] { return convergence::study_json(problem.name, studies, output::provenance(words)); },
      [&] { return convergence::study_csv(studies); });
  if (studies.empty()) return ExitCode::undecided;
  return failed ? ExitCode::solver : ExitCode::pass;
}

}  // namespace

void add_converge(CommandLine& line) {
  const auto options = std::make_shared<ConvergeOptions>();
  CLI::App* converge = line.add(
      "converge",
      "Refinement study: refine meshes, element degrees, sums and tolerances of each model of a\n"
      "case; give the observed order, the extrapolated value and its interval of each result, or\n"
      "say why there is none.",
      options, execute_converge);
  add_file(converge, "CASE", options->file, "Case file (TOML)");
  converge
      ->add_option("--levels", options->levels,
                   "How many levels of each refinement, from the coarsest, or as many as there are")
      ->capture_default_str();
  converge->add_flag("--all", options->list,
                     "Print each number with its order, extrapolated value and interval");
  options->outputs.declare(
      converge, "the study", true,
      "Plot the errors over the levels' sizes, with the fitted orders: SVG, PDF or PNG");
}

}  // namespace ciliaval::compare::app::commands
