// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/app/commands/report_command.h"

#include <fmt/core.h>

#include <cstdio>

#include "compare/output/provenance.h"
#include "compare/report/report.h"
#include "compare/output/results.h"
#include "compare/app/terminal.h"
#include "fem/parallel.h"
#include "problem/error.h"

namespace ciliaval::compare {

ExitCode write_report(const std::filesystem::path& folder, const ReportOptions& options) {
  if (fem::rank_count() > 1)
    throw InputError("`ciliaval report` runs on one rank: start it without mpirun");
  if (!std::filesystem::is_directory(folder))
    throw InputError(fmt::format(
        "there is no folder `{}`: name the one that `ciliaval run` wrote to", folder.string()));
  report::Figures figures;
  const report::Report made = report::results_page(folder, provenance(options.command), figures);
  const std::filesystem::path file = options.output.value_or(folder / "report.html");
  replace_text(file, made.html);
  for (const std::string& what : made.damaged) fmt::print(stderr, "ciliaval: {}\n", what);
  if (!figures.failure().empty()) fmt::print(stderr, "ciliaval: {}\n", figures.failure());
  print(fmt::format("Report: {}\n", file.string()));
  return made.damaged.empty() && figures.failure().empty() ? ExitCode::pass
                                                           : ExitCode::input_output;
}

}  // namespace ciliaval::compare
