// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/app/commands/commands.h"

#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

#include "compare/app/case_files.h"
#include "compare/app/python.h"
#include "compare/app/terminal.h"
#include "compare/models/registry.h"
#include "compare/output/json_file.h"
#include "compare/output/output_file.h"
#include "compare/output/provenance.h"
#include "compare/output/store/store.h"
#include "compare/study/folder.h"
#include "compare/study/optimum/optimise.h"
#include "compare/study/reader/study_reader.h"
#include "compare/study/summary/report.h"
#include "compare/study/sweep.h"
#include "problem/error.h"

namespace ciliaval::compare::app::commands {
namespace {

namespace fs = std::filesystem;

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

struct StudyOptions {
  fs::path file;
  fs::path directory = "results";
  Outputs outputs;
  bool fresh = false;  ///< forget what an earlier run of the study has computed
};

/// Says what the study goes on from.
void announce(const study::Study& study, std::size_t kept) {
  if (kept == 0) return;
  const std::string what =
      study.optimisation
          ? fmt::format("{} evaluations", kept)
          : fmt::format("{} of {} solutions", kept, study.all_points() * study.mechanics().size());
  warn(fmt::format("study \"{}\": {} are there already; --fresh starts anew", study.name, what));
}

/// What a study computes: an optimum, or the points.
struct Results {
  study::StudyResult sweep;
  std::optional<study::optimum::Optimum> optimum;
};

Results solve(const study::Study& study, study::Solutions& solutions) {
  ProgressLine line;
  const Progress progress = line.callback();
  const auto& mechanics = models::mechanics_models();
  const auto& fields = models::field_models();
  if (!study.optimisation)
    return {run_study(study, solutions, mechanics, fields, progress), std::nullopt};
  return {{study, {}},
          study::optimum::run_optimisation(study, solutions, mechanics, fields, progress)};
}

ExitCode exit_code(const Results& result) {
  const auto failed = [](const study::PairResult& r) { return r.status == Status::failed; };
  const auto all_failed = [&](const std::vector<study::PairResult>& pairs) {
    return std::all_of(pairs.begin(), pairs.end(), failed);
  };
  if (result.optimum) {
    if (result.optimum->found()) return ExitCode::pass;
    return all_failed(result.optimum->designs.front().pairs) ? ExitCode::solver
                                                             : ExitCode::undecided;
  }
  const auto& points = result.sweep.points;
  return std::all_of(points.begin(), points.end(), all_failed) ? ExitCode::solver : ExitCode::pass;
}

/// Computes the outputs of each pair of models at each point, from where an earlier call was
/// stopped. The figures come last: without Python, everything else is there. Returns `solver` if
/// every point failed.
ExitCode execute_study(const StudyOptions& options, const std::string& words) {
  require_one_rank("study");
  const study::Study study = study::reader::read_study(options.file);
  const fs::path folder = options.directory / study.name;
  std::vector<fs::path> inputs = input_files(options.file, study.base);
  inputs.push_back(folder / study::store_name);
  options.outputs.check(inputs);
  study::make_folder(folder);
  output::store::Store store(folder / study::store_name, {study::store_owner}, options.fresh);
  output::remove_unfinished(folder);
  study::Solutions solutions(store, study, output::version_line());
  announce(study, solutions.size());
  const Results result = solve(study, solutions);
  std::string text = study::summary::text(result.sweep);
  auto json = study::summary::json(result.sweep, output::provenance(words));
  if (!study.parameters.empty())
    output::write_file(folder / "study.csv", study::summary::csv(result.sweep));
  if (!study.tolerances.empty()) {
    output::write_file(folder / "tolerances.csv", study::summary::tolerance_csv(result.sweep));
    json["tolerances"] = study::summary::tolerance_json(result.sweep);
    text += study::summary::tolerance_text(result.sweep);
  }
  if (result.optimum) {
    output::write_file(folder / "optimum.csv", study::optimum::csv(study, *result.optimum));
    json["optimum"] = study::optimum::json(study, *result.optimum);
    text += study::optimum::text(study, *result.optimum);
  }
  const std::string json_text = output::to_text(json);
  output::write_file(folder / "study.json", json_text);
  print(text + fmt::format("\nResults: {}\n", folder.string()));
  options.outputs.write([&] { return json_text; });
  try {
    draw_figure(folder / "study.json", folder);
  } catch (const FileError& error) {
    warn(fmt::format("the study is without its figures: {}", error.what()));
  }
  return exit_code(result);
}

}  // namespace

void add_study(CommandLine& line) {
  const auto options = std::make_shared<StudyOptions>();
  CLI::App* study = line.add(
      "study",
      "Parameter study: vary numbers of a case, alone or together, run pairs of models at each\n"
      "point, and write tables and figures of the signal, its sensitivity and its range; "
      "propagate\n"
      "tolerances to their standard deviations; find the best design within limits.",
      options, execute_study);
  study->footer(study_help);
  add_file(study, "STUDY", options->file, "Study file (TOML)");
  study
      ->add_option("-o,--output", options->directory,
                   "Folder for the results: study.csv, study.json, figures and the store of what\n"
                   "is solved, in a subfolder of the study's name")
      ->type_name("DIR")
      ->capture_default_str();
  options->outputs.declare(study, "the results");
  study->add_flag("--fresh", options->fresh,
                  "Start anew: forget what an earlier run of the study has solved");
}

}  // namespace ciliaval::compare::app::commands
