// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/app/commands/commands.h"

#include <fmt/core.h>

#include "compare/app/python.h"
#include "compare/app/terminal.h"
#include "compare/output/output_file.h"
#include "compare/output/provenance.h"
#include "problem/error.h"

namespace ciliaval::compare::app::commands {
namespace {

constexpr const char* report_help = R"(
The page shows what lies in DIR and in the folders in it, whatever the files are called:

  ciliaval run CASE.toml -o DIR                      DIR/<case>/summary.json
  ciliaval study NAME.study.toml -o DIR              DIR/<study>/study.json
  ciliaval budget CASE.toml --json DIR/NAME.budget.json
  ciliaval converge CASE.toml --json DIR/NAME.converge.json
  ciliaval sense NAME.sense.toml --json DIR/NAME.sense.json
  ciliaval claims --json DIR/claims.json
  ciliaval check --json DIR/check.json
  pvpython DIR/<case>/vtk/open.py DIR/pictures/NAME.png

What is not there is named in the page with its command. No number is computed: each is from a
file that the page names. A file that is damaged is named, the others are shown, and the exit code
is 4. The page is made by the Python package: `python3 -m ciliaval.report DIR` does the same
(docs/guide/meshes.md).)";

struct ReportOptions {
  std::filesystem::path folder = "results";
  OptionalFile output;  ///< else report.html in the folder
};

/// If a result file is damaged, the page is written without the damaged parts and `input_output` is
/// returned.
ExitCode execute_report(const ReportOptions& options, const std::string& words) {
  const std::filesystem::path& folder = options.folder;
  require_one_rank("report");
  if (!std::filesystem::is_directory(folder))
    throw InputError(fmt::format(
        "there is no folder `{}`: name the one that `ciliaval run` wrote to", folder.string()));
  const std::filesystem::path file = options.output.value_or(folder / "report.html");
  if (std::filesystem::is_regular_file(file) && file.extension() != ".html")
    throw InputError(fmt::format(
        "`{}` is there and may be a result: the page replaces .html files only", file.string()));
  output::check_outputs({file}, {});
  const output::Provenance maker = output::provenance(words);
  const std::vector<std::string> warnings = run_python_module(
      "ciliaval.report", {folder},
      {"--output=" + file.string(),
       fmt::format("--made-by={} on {}: {}", output::version_line(), maker.date, maker.command)});
  for (const std::string& what : warnings) warn(what);
  print(fmt::format("Report: {}\n", file.string()));
  return warnings.empty() ? ExitCode::pass : ExitCode::input_output;
}

}  // namespace

void add_report(CommandLine& line) {
  const auto options = std::make_shared<ReportOptions>();
  CLI::App* report = line.add(
      "report",
      "One page of everything in a folder of results, as one file that opens offline: cases,\n"
      "studies, error budgets, convergence, loads from readings, the ledger of claims, pictures.",
      options, execute_report);
  report->footer(report_help);
  report->add_option("DIR", options->folder, "Folder of results")->capture_default_str();
  add_output(report, "-o,--output", options->output,
             "File to write; left out: DIR/report.html. One that is there is replaced",
             "FILE.html");
}

}  // namespace ciliaval::compare::app::commands
