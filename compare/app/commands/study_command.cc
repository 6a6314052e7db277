// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/app/commands/commands.h"

#include <fmt/core.h>

#include <algorithm>
#include <system_error>

#include "compare/app/case_files.h"
#include "compare/app/terminal.h"
#include "compare/models/registry.h"
#include "compare/output/output_file.h"
#include "compare/output/provenance.h"
#include "compare/study/report.h"
#include "compare/study/sweep.h"
#include "compare/study/tolerances.h"
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

struct Options {
  fs::path file;
  fs::path directory = "results";
  OptionalFile json;
  bool fresh = false;  ///< forget what an earlier run of the study has computed
};

constexpr const char* journal_name = "points.journal";

/// Makes the study's folder if it is not there. Throws FileError if something else lies there.
void make_folder(const fs::path& folder) {
  try {
    fs::create_directories(folder);
    if (!fs::exists(folder / journal_name) && !fs::is_empty(folder))
      throw FileError(
          fmt::format("`{}` is not the folder of a study: it has other files in it; "
                      "move it away or choose another folder with -o DIR",
                      folder.string()));
  } catch (const fs::filesystem_error& error) {
    throw FileError(
        fmt::format("cannot write to the output folder `{}`: {}; choose another with "
                    "-o DIR",
                    folder.string(), error.code().message()));
  }
}

/// Says what the study goes on from. Throws FileError if the journal is another's.
void open_journal(const study::Study& study, const fs::path& folder, study::Journal& journal) {
  const std::string header = study::journal_header(study, version_line());
  if (journal.damaged() > 0)
    fmt::print(stderr, "ciliaval: {} damaged line{} of `{}` left out: computed again\n",
               journal.damaged(), journal.damaged() == 1 ? "" : "s",
               (folder / journal_name).string());
  if (journal.header().empty()) return journal.append(header);
  if (const std::string what = study::difference(journal.header(), header); !what.empty())
    throw FileError(
        fmt::format("the results in `{}` are not of this study: {}. Choose another "
                    "folder with -o DIR, or start anew with --fresh, which deletes them",
                    folder.string(), what));
  if (study.optimisation) {
    if (const std::size_t kept = study::kept_evaluations(study, journal); kept > 0)
      fmt::print(stderr,
                 "ciliaval: study \"{}\": {} evaluations are there already; --fresh starts anew\n",
                 study.name, kept);
    return;
  }
  const study::Extent extent = study::extent(study, journal);
  if (extent.kept > 0)
    fmt::print(stderr,
               "ciliaval: study \"{}\": {} of {} solutions are there already; --fresh "
               "starts anew\n",
               study.name, extent.kept, extent.all);
}

study::StudyResult solve(const study::Study& study, study::Journal& journal) {
  ProgressLine line;
  if (study.optimisation)
    return {study,
            {},
            study::run_optimisation(study, journal, models::mechanics_models(),
                                    models::field_models(), line.callback())};
  return study::run_study(study, journal, models::mechanics_models(), models::field_models(),
                          line.callback());
}

ExitCode exit_code(const study::StudyResult& result) {
  const auto failed = [](const study::PairResult& r) { return r.status == Status::failed; };
  const auto all_failed = [&](const std::vector<study::PairResult>& pairs) {
    return std::all_of(pairs.begin(), pairs.end(), failed);
  };
  if (result.optimum) {
    if (result.optimum->found()) return ExitCode::pass;
    return all_failed(result.optimum->designs.front().pairs) ? ExitCode::solver
                                                             : ExitCode::undecided;
  }
  return std::all_of(result.points.begin(), result.points.end(), all_failed) ? ExitCode::solver
                                                                             : ExitCode::pass;
}

/// Computes the outputs of each pair of models at each point, from where an earlier call was
/// stopped. The plots come last: without gnuplot, everything else is there. Returns `solver` if
/// every point failed.
ExitCode execute(const Options& options, const std::string& words) {
  require_one_rank("study");
  const study::Study study = study::read_study(options.file);
  const fs::path folder = options.directory / study.name;
  std::vector<fs::path> inputs = input_files(options.file, study.base);
  inputs.push_back(folder / journal_name);
  output::check_outputs({options.json}, inputs);
  make_folder(folder);
  study::Journal journal(folder / journal_name, options.fresh);
  open_journal(study, folder, journal);
  const study::StudyResult result = solve(study, journal);
  const std::string json = study::json(result, output::provenance(words));
  if (!study.parameters.empty()) output::write_file(folder / "study.csv", study::csv(result));
  if (!study.tolerances.empty())
    output::write_file(folder / "tolerances.csv", study::tolerance_csv(result));
  if (result.optimum)
    output::write_file(folder / "optimum.csv", study::optimum_csv(study, *result.optimum));
  output::write_file(folder / "study.json", json);
  if (options.json) output::write_file(*options.json, json);
  print(study::text(result) + study::tolerance_text(result) +
        (result.optimum ? study::optimum_text(study, *result.optimum) : "") +
        fmt::format("\nResults: {}\n", folder.string()));
  for (const study::StudyPlot& drawing : study::plots(result))
    plot::write_svg(folder / drawing.name, drawing.script, drawing.size);
  return exit_code(result);
}

}  // namespace

void add_study(CommandLine& line) {
  const auto options = std::make_shared<Options>();
  CLI::App* study = line.add(
      "study",
      "Parameter study: vary numbers of a case, alone or together, run pairs of models at each\n"
      "point, and write tables and plots of the signal, its sensitivity and its range; propagate\n"
      "tolerances to their standard deviations; find the best design within limits.",
      options, execute);
  study->footer(study_help);
  add_file(study, "STUDY", options->file, "Study file (TOML)");
  study
      ->add_option("-o,--output", options->directory,
                   "Folder for the results: study.csv, study.json, plots and the journal of what\n"
                   "is solved, in a subfolder of the study's name")
      ->type_name("DIR")
      ->capture_default_str();
  add_output(study, "--json", options->json, "Write study.json to this file too");
  study->add_flag("--fresh", options->fresh,
                  "Start anew: forget what an earlier run of the study has solved");
}

}  // namespace ciliaval::compare::app::commands
