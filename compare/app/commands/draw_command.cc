// SPDX-License-Identifier: LGPL-2.1-or-later
#include <fmt/core.h>

#include "compare/app/case_files.h"
#include "compare/app/commands/commands.h"
#include "compare/app/python.h"
#include "compare/app/terminal.h"
#include "compare/output/output_file.h"

namespace ciliaval::compare::app::commands {
namespace {

namespace fs = std::filesystem;

struct DrawOptions {
  fs::path file;
  OptionalFile figure;
};

/// Draws a case that is right: cilium, load, sensors and axes, to scale.
ExitCode draw(const DrawOptions& options, const std::string&) {
  const input::Case problem = read_cases({options.file}).front();
  const fs::path figure = options.figure.value_or(problem.name + ".svg");
  output::check_outputs({figure}, input_files(options.file, problem));
  run_python_module("ciliaval.plot", {options.file, figure});
  print(fmt::format("{}: {}\n", options.file.string(), figure.string()));
  return ExitCode::pass;
}

}  // namespace

void add_draw(CommandLine& line) {
  const auto options = std::make_shared<DrawOptions>();
  CLI::App* command = line.add(
      "draw", "Draw a case to scale: cilium, load, sensors and axes, before anything is solved",
      options, draw);
  add_file(command, "CASE", options->file, "Case file (TOML)");
  add_plot(command, options->figure, "Figure to write: SVG, PDF or PNG; left out: NAME.svg",
           "-o,--output");
}

}  // namespace ciliaval::compare::app::commands
