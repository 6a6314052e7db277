// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/app/commands/study_command.h"

#include <fmt/core.h>

#include <algorithm>
#include <system_error>

#include "compare/output/provenance.h"
#include "compare/models/registry.h"
#include "compare/output/results.h"
#include "compare/study/report.h"
#include "compare/study/sweep.h"
#include "compare/study/tolerances.h"
#include "compare/app/terminal.h"
#include "fem/parallel.h"
#include "problem/error.h"

namespace ciliaval::compare {
namespace {

namespace fs = std::filesystem;

constexpr const char* journal_name = "points.journal";

/// DIRECTORY/NAME, made if it is not there. Throws FileError if something else lies there.
fs::path make_folder(const fs::path& directory, const std::string& name) {
  fs::path folder = directory / name;
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
  return folder;
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
            study::run_optimisation(study, journal, mechanics_models(), field_models(),
                                    line.callback())};
  return study::run_study(study, journal, mechanics_models(), field_models(), line.callback());
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
  const fs::path folder = make_folder(options.directory, study.name);
  study::Journal journal(folder / journal_name, options.fresh);
  open_journal(study, folder, journal);
  const study::StudyResult result = solve(study, journal);
  const std::string json = study::json(result, provenance(options.command));
  if (!study.parameters.empty()) replace_text(folder / "study.csv", study::csv(result));
  if (!study.tolerances.empty())
    replace_text(folder / "tolerances.csv", study::tolerance_csv(result));
  if (result.optimum)
    replace_text(folder / "optimum.csv", study::optimum_csv(study, *result.optimum));
  replace_text(folder / "study.json", json);
  if (options.json) replace_text(*options.json, json);
  print(study::text(result) + study::tolerance_text(result) +
        (result.optimum ? study::optimum_text(study, *result.optimum) : "") +
        fmt::format("\nResults: {}\n", folder.string()));
  for (const study::StudyPlot& drawing : study::plots(result))
    plot::write_svg(folder / drawing.name, drawing.script, drawing.size);
  return exit_code(result);
}

}  // namespace ciliaval::compare
