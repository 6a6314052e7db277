// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/app/commands/report_command.h"

#include <fmt/core.h>

#include "compare/app/terminal.h"
#include "compare/output/output_file.h"
#include "compare/output/provenance.h"
#include "compare/report/report.h"
#include "fem/parallel.h"
#include "problem/error.h"

namespace ciliaval::compare::app::commands {

ExitCode write_report(const std::filesystem::path& folder, const ReportOptions& options) {
  if (fem::rank_count() > 1)
    throw InputError("`ciliaval report` runs on one rank: start it without mpirun");
  if (!std::filesystem::is_directory(folder))
    throw InputError(fmt::format(
        "there is no folder `{}`: name the one that `ciliaval run` wrote to", folder.string()));
  const std::filesystem::path file = options.output.value_or(folder / "report.html");
  if (std::filesystem::is_regular_file(file) && file.extension() != ".html")
    throw InputError(fmt::format(
        "`{}` is there and may be a result: the page replaces .html files only", file.string()));
  output::check_outputs({file}, {});
  report::Figures figures;
  const report::Report made =
      report::results_page(folder, output::provenance(options.command), figures);
  output::write_file(file, made.html);
  for (const std::string& what : made.damaged) warn(what);
  if (!figures.failure().empty()) warn(figures.failure());
  print(fmt::format("Report: {}\n", file.string()));
  return made.damaged.empty() && figures.failure().empty() ? ExitCode::pass
                                                           : ExitCode::input_output;
}

}  // namespace ciliaval::compare::app::commands
