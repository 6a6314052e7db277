// SPDX-License-Identifier: LGPL-2.1-or-later
#include <fmt/core.h>

#include <vector>

#include "compare/app/case_files.h"
#include "compare/app/commands/commands.h"
#include "compare/app/python.h"
#include "compare/app/terminal.h"
#include "compare/models/preview.h"
#include "compare/study/reader/study_reader.h"

namespace ciliaval::compare::app::commands {
namespace {

namespace fs = std::filesystem;

struct ValidateOptions {
  std::vector<fs::path> files;
};

ExitCode validate(const ValidateOptions& options, const std::string&) {
  std::vector<fs::path> files;
  std::vector<std::string> benches{"--validate", "--"};
  for (const fs::path& file : options.files) {
    if (is_bench_file(file)) {
      benches.push_back(file.string());
      continue;
    }
    if (!is_study_file(file)) {
      files.push_back(file);
      continue;
    }
    const study::Study study = study::reader::read_study(file);
    const std::string what = study.optimisation ? fmt::format("an optimum over {} numbers",
                                                              study.optimisation->parameters.size())
                                                : fmt::format("{} points", study.point_count());
    print(fmt::format("{}: study \"{}\" is valid: {}, {} pairs of models\n", file.string(),
                      study.name, what, study.pairs.size()));
  }
  const std::vector<input::Case> cases = read_cases(files);
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const auto counted = [](std::size_t count, std::string_view what) {
      return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
    };
    print(fmt::format("{}: case \"{}\" is valid: {}, {}, {}, {}\n", files[i].string(),
                      cases[i].name, counted(cases[i].load_path.size(), "load step"),
                      counted(cases[i].sensors.size(), "sensor"),
                      counted(cases[i].mechanics.size(), "mechanics model"),
                      counted(cases[i].fields.size(), "field model")));
    for (const std::string& remark : cases[i].measured.remarks) print("  " + remark + "\n");
    const models::Preview preview = models::preview(cases[i]);
    for (const std::string& text : preview.signal) print("  " + text + "\n");
    for (const std::string& text : preview.warnings) print("  warning: " + text + "\n");
  }
  if (benches.size() > 2) become_python_module("ciliaval.sensing", benches);
  return ExitCode::pass;
}

}  // namespace

void add_validate(CommandLine& line) {
  const auto options = std::make_shared<ValidateOptions>();
  line.add("validate",
           "Read and check case files, and say what to expect of them: the signal by the elastica "
           "of the case, and what is odd",
           options, validate)
      ->add_option("CASE", options->files, "Case, study and test bench files (TOML)")
      ->required()
      ->transform(input_file());
}

}  // namespace ciliaval::compare::app::commands
