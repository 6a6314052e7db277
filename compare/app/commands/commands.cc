// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/app/commands/commands.h"

#include <fmt/core.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <optional>
#include <system_error>

#include "compare/app/case_files.h"
#include "compare/app/commands/mesh_command.h"
#include "compare/app/terminal.h"
#include "compare/input/case.h"
#include "compare/models/errors.h"
#include "compare/models/registry.h"
#include "compare/models/run.h"
#include "compare/output/checkpoint_folder.h"
#include "compare/output/field_grid.h"
#include "compare/output/output_file.h"
#include "compare/output/output_folder.h"
#include "compare/output/provenance.h"
#include "compare/output/results.h"
#include "compare/output/table.h"
#include "compare/output/vtk/output.h"
#include "compare/report/report.h"
#include "compare/sensing/bench.h"
#include "compare/study/study.h"
#include "fem/parallel.h"
#include "problem/error.h"

namespace ciliaval::compare::app::commands {
namespace {

namespace fs = std::filesystem;

/// A case of `ciliaval run` and what it may write to.
struct Prepared {
  input::Case problem;
  output::OutputFolder folder;
  std::optional<output::CheckpointFolder> checkpoints;  ///< if a model of the case keeps one
};

Checkpoint checkpoint(const fs::path& directory, const input::Case& problem) {
  return {output::checkpoint_path(directory, problem.name), version_line()};
}

/// Makes the folders. Says what the case goes on from, or deletes it if options.fresh.
Prepared prepare(const fs::path& file, const input::Case& problem, const RunOptions& options) {
  Prepared result{problem,
                  output::OutputFolder(options.directory, problem.name, input_files(file, problem)),
                  std::nullopt};
  if (models::kept_checkpoints(problem, models::mechanics_models(), {}).empty()) return result;
  result.checkpoints.emplace(options.directory, problem.name);
  if (options.fresh) result.checkpoints->clear();
  const Checkpoint saved = checkpoint(options.directory, problem);
  const std::size_t steps = problem.load_path.size();
  for (const models::Kept& kept :
       models::kept_checkpoints(problem, models::mechanics_models(), saved))
    if (fs::exists(saved.path / kept.model))
      warn(fmt::format("case \"{}\": {} {}, as `{}` says; --fresh starts anew", problem.name,
                       kept.model,
                       kept.finished_steps < steps
                           ? fmt::format("goes on at step {}/{}", kept.finished_steps + 1, steps)
                           : fmt::format("has solved all {} steps", steps),
                       (saved.path / kept.model).string()));
  return result;
}

/// Deletes the checkpoints, unless a model that keeps one has failed: says how to go on from there.
void end_checkpoints(output::CheckpointFolder& folder, const models::CaseResult& result) {
  bool needed = false;
  for (const models::MechanicsRun& run : result.mechanics) {
    const fs::path file = folder.path() / run.model;
    if (!fs::exists(file) || models::all_solved(run)) continue;
    needed = true;
    warn(fmt::format(
        "case \"{0}\": the last state of {1} that converged is kept in `{2}`: run the case again, "
        "with a larger models.{1}.max_iterations or max_cutbacks, to go on from there, or with "
        "--fresh",
        result.problem.name, run.model, file.string()));
  }
  if (!needed) folder.clear();
}

/// report.html beside summary.json. Figures that cannot be drawn are named, on the page and here:
/// the results are as good without them.
void write_case_report(const fs::path& folder) {
  report::Figures figures;
  output::write_file(folder / "report.html", report::case_page(folder, figures));
  if (!figures.failure().empty())
    warn(fmt::format("report.html is without its figures: {}", figures.failure()));
}

ExitCode run_one(Prepared& prepared, const RunOptions& options) {
  ProgressLine line;
  const Progress progress = line.callback();
  const input::Case& problem = prepared.problem;
  output::OutputFolder& folder = prepared.folder;
  const models::CaseResult result =
      models::run(problem, models::mechanics_models(), models::field_models(), progress,
                  checkpoint(options.directory, problem));
  const std::vector<models::Comparison> comparisons = models::compare_models(result);
  const auto grid = output::field_grid(result, models::field_models(), progress);
  const output::Provenance origin = output::provenance(options.command);
  output::write_file(folder.path() / "case.toml", input::to_toml(problem));
  output::write_results(result, comparisons, origin, folder.path());
  tbb::parallel_invoke([&] { output::vtk::write_vtk(result, grid, origin, folder.path() / "vtk"); },
                       [&] { write_case_report(folder.path()); });
  folder.commit();
  line.clear();
  print(output::table(result, comparisons));
  if (prepared.checkpoints) end_checkpoints(*prepared.checkpoints, result);
  return models::all_solved(result) ? ExitCode::pass : ExitCode::solver;
}

/// The part of the ranks beyond the first in a case: the solid and the potential, which share their
/// work with them, and CalculiX, whose result they are given. For the potential each rank has the
/// rods' deformations from its own solution, which is the same on all.
void take_part(input::Case problem, const RunOptions& options) {
  std::erase_if(problem.fields, [](const std::string& id) { return id != "potential"; });
  if (problem.fields.empty())
    std::erase_if(problem.mechanics,
                  [](const std::string& id) { return id != "solid" && id != "calculix"; });
  models::run(problem, models::mechanics_models(), models::field_models(), {},
              checkpoint(options.directory, problem));
}

std::string title_of(const fs::path& file) {
  try {
    if (is_study_file(file)) return study::read_study(file).title;
    if (is_bench_file(file)) return sensing::read_bench(file).title;
    return input::read_case(file).title;
  } catch (const Error&) {
    return "(cannot be read: see `ciliaval validate`)";
  }
}

std::string list_of_cases() {
  const ShippedCases shipped = shipped_cases();
  if (shipped.files.empty()) return "Shipped cases: none found beside the program\n";
  std::string text;
  const auto add = [&](const char* kind, const std::vector<fs::path>& files) {
    if (files.empty()) return;
    text += fmt::format("{}Shipped {}, in {}\n", text.empty() ? "" : "\n", kind,
                        shipped.folder.string());
    for (const fs::path& file : files)
      text += fmt::format("  {:<28} {}\n", file.lexically_relative(shipped.folder).string(),
                          title_of(file));
  };
  add("cases", shipped.files);
  add("studies", shipped.studies);
  add("test benches", shipped.benches);
  return text;
}

}  // namespace

ExitCode run_cases(const std::vector<fs::path>& files, const RunOptions& options) {
  const std::vector<input::Case> cases = read_cases(files);
  if (fem::rank() > 0) {
    for (const input::Case& problem : cases) take_part(problem, options);
    return ExitCode::pass;  // rank 0 knows
  }
  std::vector<Prepared> prepared;
  prepared.reserve(cases.size());
  for (std::size_t i = 0; i < cases.size(); ++i)
    prepared.push_back(prepare(files[i], cases[i], options));
  ExitCode code = ExitCode::pass;
  for (std::size_t i = 0; i < prepared.size(); ++i) {
    const ExitCode one = run_one(prepared[i], options);
    if (one != ExitCode::pass) code = one;
    print(fmt::format("Results: {}\n{}", prepared[i].folder.target().string(),
                      i + 1 < prepared.size() ? "\n" : ""));
  }
  return code;
}

void validate_cases(const std::vector<fs::path>& all_files) {
  std::vector<fs::path> files;
  for (const fs::path& file : all_files) {
    if (is_bench_file(file)) {
      const sensing::Bench bench = sensing::read_bench(file);
      print(fmt::format("{}: the test bench is valid: {} loads at {} azimuths, {} draws\n",
                        file.string(), bench.problem.load_path.size(), bench.azimuths,
                        bench.draws));
      continue;
    }
    if (!is_study_file(file)) {
      files.push_back(file);
      continue;
    }
    const study::Study study = study::read_study(file);
    const std::string what = study.optimisation ? fmt::format("an optimum over {} numbers",
                                                              study.optimisation->parameters.size())
                                                : fmt::format("{} points", study.point_count());
    print(fmt::format("{}: study \"{}\" is valid: {}, {} pairs of models\n", file.string(),
                      study.name, what, study.pairs.size()));
  }
  const std::vector<input::Case> cases = read_cases(files);
  for (std::size_t i = 0; i < cases.size(); ++i)
    print(
        fmt::format("{}: case \"{}\" is valid: {} load steps, {} sensors, mechanics {}, fields "
                    "{}\n",
                    files[i].string(), cases[i].name, cases[i].load_path.size(),
                    cases[i].sensors.size(), cases[i].mechanics.size(), cases[i].fields.size()));
}

void write_mesh(const fs::path& file, const fs::path& output,
                std::optional<unsigned int> refinement, const std::string& command) {
  const input::Case problem = input::read_case(file);
  output::check_outputs({output}, input_files(file, problem));
  print(write_case_mesh(problem, output, refinement, command));
}

void list() {
  std::string text = "Mechanics models (in a comparison the later one is the reference)\n";
  for (const models::MechanicsEntry& entry : models::mechanics_models())
    text += fmt::format("  {:<10} {}\n", entry.id, entry.description);
  text += fmt::format(
      "  {:<10} {}\n", "(external)",
      "[[models.external]]: centrelines and readings from CSV files (docs/guide/referees.md)");
  text += "\nField models\n";
  for (const models::FieldEntry& entry : models::field_models())
    text += fmt::format("  {:<10} {}\n", entry.id, entry.description);
  text +=
      "\nLoads\n"
      "  contact    horizontal force that stays at a height while the cilium slides under it\n"
      "  flow       horizontal force per unit of current height: drag\n"
      "  section    dead force on one material cross-section\n"
      "  dead       dead force per unit of reference length\n"
      "  probe      displacement of the contact point at a height: the contact force is a result\n"
      "\n";
  print(text + list_of_cases());
}

std::string version_line() {
  const output::Provenance origin = output::provenance("");
  return fmt::format("ciliaval {} (git {})", origin.version, origin.git);
}

}  // namespace ciliaval::compare::app::commands
