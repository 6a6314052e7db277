// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/app/commands/study_command.h"

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
#include "fem/parallel.h"
#include "problem/error.h"

namespace ciliaval::compare::app::commands {
namespace {

namespace fs = std::filesystem;

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

}  // namespace

ExitCode run_study(const fs::path& file, const StudyOptions& options) {
  if (fem::rank_count() > 1)
    throw InputError(
        "`ciliaval study` runs on one rank, its points on all cores: start it without "
        "mpirun");
  const study::Study study = study::read_study(file);
  const fs::path folder = options.directory / study.name;
  std::vector<fs::path> inputs = input_files(file, study.base);
  inputs.push_back(folder / journal_name);
  output::check_outputs({options.json}, inputs);
  make_folder(folder);
  study::Journal journal(folder / journal_name, options.fresh);
  open_journal(study, folder, journal);
  const study::StudyResult result = solve(study, journal);
  const std::string json = study::json(result, output::provenance(options.command));
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

}  // namespace ciliaval::compare::app::commands
