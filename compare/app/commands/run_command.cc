// SPDX-License-Identifier: LGPL-2.1-or-later
#include <fmt/core.h>
#include <tbb/parallel_invoke.h>

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "compare/app/case_files.h"
#include "compare/app/commands/commands.h"
#include "compare/app/python.h"
#include "compare/app/terminal.h"
#include "compare/models/errors.h"
#include "compare/models/fingerprint.h"
#include "compare/models/model_part.h"
#include "compare/models/registry.h"
#include "compare/models/run.h"
#include "compare/models/unstated_touch.h"
#include "compare/output/field_grid.h"
#include "compare/output/output_file.h"
#include "compare/output/output_folder.h"
#include "compare/output/provenance.h"
#include "compare/output/results.h"
#include "compare/output/store/store.h"
#include "compare/output/table.h"
#include "compare/output/vtk/output.h"
#include "compare/validation/input_part.h"
#include "compare/validation/report.h"
#include "compare/validation/validation.h"
#include "fem/parallel.h"
#include "problem/error.h"

namespace ciliaval::compare::app::commands {
namespace {

namespace fs = std::filesystem;

struct RunOptions {
  std::vector<fs::path> files;
  fs::path directory = "results";
  bool fresh = false;              ///< empty the stores of runs that were killed
  bool all_vtk = false;            ///< VTK files of every step of a long path
  bool own_sensitivities = false;  ///< u_input of slow models by themselves
  bool all = false;                ///< print the tables of every step
  bool explain = false;            ///< print the footnotes
};

/// A case of `ciliaval run`, what it may write to, and what it goes on from.
struct Prepared {
  input::Case problem;
  output::OutputFolder folder;
  std::unique_ptr<output::store::Store> store;  ///< if a model of the case keeps a checkpoint
  std::map<std::string, Checkpoint> checkpoints;
};

/// Makes the folders and the store, which is emptied if options.fresh. Says what the case goes on
/// from.
Prepared prepare(const fs::path& file, const input::Case& problem, const RunOptions& options) {
  Prepared result{problem,
                  output::OutputFolder(options.directory, problem.name, input_files(file, problem)),
                  nullptr,
                  {}};
  for (const std::string& id : problem.mechanics) {
    const models::MechanicsEntry& entry = models::entry_of(models::mechanics_models(), id);
    auto fingerprint = models::fingerprint(problem, entry);
    if (!fingerprint) continue;
    if (!result.store)
      result.store = std::make_unique<output::store::Store>(
          options.directory / ("." + problem.name + ".sqlite"),
          input::ids(models::mechanics_models()), options.fresh);
    fingerprint->emplace_back("program", output::version_line());
    output::store::Store& store = *result.store;
    store.require_fingerprint(id, *fingerprint);
    const Checkpoint& checkpoint =
        result.checkpoints
            .emplace(id, Checkpoint{store.read(id),
                                    [&store, owner = id](const Checkpoint::Entries& entries) {
                                      store.write(owner, entries);
                                    }})
            .first->second;
    if (checkpoint.kept.empty()) continue;
    const std::size_t steps = problem.load_path.size();
    const std::size_t finished = checkpoint.finished_steps();
    warn(fmt::format("case \"{}\": {} {}, as `{}` says; --fresh starts anew", problem.name, id,
                     entry.error_limit && entry.error_limit(problem.options).percent > 0
                         ? "goes on with the refinement that was under way"
                     : finished < steps ? fmt::format("goes on at step {}/{}", finished + 1, steps)
                                        : fmt::format("has solved all {} steps", steps),
                     store.file().string()));
  }
  return result;
}

/// Deletes the store, unless a model that has kept something has failed: says how to go on from
/// there.
void end_store(output::store::Store& store, const models::CaseResult& result) {
  bool needed = false;
  for (const models::MechanicsRun& run : result.mechanics) {
    if (models::all_solved(run) || store.read(run.model).empty()) continue;
    needed = true;
    warn(fmt::format(
        "case \"{0}\": the last state of {1} that converged is kept in `{2}`: run the case again, "
        "with a larger models.{1}.max_iterations or max_cutbacks, to go on from there, or with "
        "--fresh",
        result.problem.name, run.model, store.file().string()));
  }
  if (!needed) store.remove();
}

/// A file that the Python package makes beside summary.json. The results are as good without it.
void add_by_python(const fs::path& folder, const char* name, const std::string& module,
                   const std::vector<std::string>& options = {}) {
  try {
    for (const std::string& what : run_python_module(module, {folder}, options)) warn(what);
  } catch (const FileError& error) {
    warn(fmt::format("there is no {}: {}", name, error.what()));
  }
}

ExitCode run_one(Prepared& prepared, const RunOptions& options, const std::string& words) {
  ProgressLine line;
  const Progress progress = line.callback();
  const input::Case& problem = prepared.problem;
  output::OutputFolder& folder = prepared.folder;
  models::CaseResult result = models::run(problem, models::mechanics_models(),
                                          models::field_models(), progress, prepared.checkpoints);
  models::add_model_parts(result, models::mechanics_models(), models::field_models(), progress);
  validation::add_input_parts(result, models::mechanics_models(), models::field_models(), progress);
  result.unstated_touch = models::unstated_touch(problem.cilium, problem.load_path);
  const std::vector<models::Comparison> comparisons = models::compare_models(result);
  const auto grid = output::field_grid(result, models::field_models(), progress);
  const std::optional<validation::Validation> measured =
      validation::validate(result, models::mechanics_models(), models::field_models(), progress,
                           options.own_sensitivities ? validation::Sensitivities::own
                                                     : validation::Sensitivities::quick);
  const output::Provenance origin = output::provenance(words);
  output::write_file(folder.path() / "case.toml", input::to_toml(problem, models::known()));
  output::write_results(result, comparisons, origin, folder.path(),
                        measured ? validation::json(*measured) : "");
  const std::vector<std::size_t> drawn =
      output::vtk::drawn_steps(problem.load_path.size(), options.all_vtk);
  tbb::parallel_invoke(
      [&] { output::vtk::write_vtk(result, grid, origin, drawn, folder.path() / "vtk"); },
      [&] {
        if (problem.signal) add_by_python(folder.path(), "signal.csv", "ciliaval.sensing.signal");
        add_by_python(folder.path(), "report.html", "ciliaval.report", {"--case"});
      });
  folder.commit();
  line.clear();
  const output::Footnotes footnotes = footnotes_of(options.explain);
  print(output::table(result, comparisons, footnotes,
                      options.all ? output::Steps::all : output::Steps::last));
  if (measured) print('\n' + validation::text(*measured, footnotes));
  if (drawn.size() < problem.load_path.size())
    print(fmt::format("VTK files of {} of the {} steps; --all-vtk writes all.\n", drawn.size(),
                      problem.load_path.size()));
  if (prepared.store) end_store(*prepared.store, result);
  return models::all_solved(result) ? ExitCode::pass : ExitCode::solver;
}

/// The part of the ranks beyond the first in a case: the models that all ranks call. For a field
/// model each rank has the rods' deformations from its own solution, which is the same on all.
void take_part(input::Case problem) {
  const auto leave_collective = [](std::vector<std::string>& ids, const auto& entries) {
    std::erase_if(
        ids, [&](const std::string& id) { return !models::entry_of(entries, id).is_collective; });
  };
  leave_collective(problem.fields, models::field_models());
  if (problem.fields.empty()) leave_collective(problem.mechanics, models::mechanics_models());
  models::run(problem, models::mechanics_models(), models::field_models());
}

/// Checks all case files, output folders and stores before anything runs. Then runs each case,
/// from its store if there is one, and writes its results to DIRECTORY/name.
ExitCode execute_run(const RunOptions& options, const std::string& words) {
  if (options.own_sensitivities && fem::rank_count() > 1)
    throw InputError("--own-sensitivities: of one process alone, without mpirun");
  const std::vector<input::Case> cases = read_cases(options.files);
  if (fem::rank() > 0) {
    for (const input::Case& problem : cases) take_part(problem);
    return ExitCode::pass;  // rank 0 knows
  }
  std::vector<Prepared> prepared;
  prepared.reserve(cases.size());
  for (std::size_t i = 0; i < cases.size(); ++i)
    prepared.push_back(prepare(options.files[i], cases[i], options));
  ExitCode code = ExitCode::pass;
  for (std::size_t i = 0; i < prepared.size(); ++i) {
    const ExitCode one = run_one(prepared[i], options, words);
    if (one != ExitCode::pass) code = one;
    print(fmt::format("Results: {}\n{}", prepared[i].folder.target().string(),
                      i + 1 < prepared.size() ? "\n" : ""));
  }
  return code;
}

}  // namespace

void add_run(CommandLine& line) {
  const auto options = std::make_shared<RunOptions>();
  CLI::App* run =
      line.add("run", "Run cases, compare the models, write the results", options, execute_run);
  run->add_option("CASE", options->files, "Case files (TOML)")->required()->transform(input_file());
  run->add_option("-o,--output", options->directory,
                  "Folder for the results, one subfolder for each case")
      ->type_name("DIR")
      ->capture_default_str();
  run->add_flag("--fresh", options->fresh,
                "Start anew: forget what a run that was killed or did not converge has solved");
  run->add_flag("--all-vtk", options->all_vtk,
                "Write VTK files of every step of a long path, not of 200, evenly chosen");
  run->add_flag(
      "--own-sensitivities", options->own_sensitivities,
      "With measurements: u_input of slow models by themselves, not by a rod; solves each\n"
      "twice for each input");
  run->add_flag("--all", options->all, "Print the tables of every load step, not of the last");
  add_explain(run, options->explain);
}

}  // namespace ciliaval::compare::app::commands
