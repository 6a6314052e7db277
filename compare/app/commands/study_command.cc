// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/app/commands/commands.h"

#include "compare/app/python.h"

namespace ciliaval::compare::app::commands {
namespace {

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
  std::filesystem::path file;
  Outputs outputs;
  CLI::App* command = nullptr;
};

ExitCode execute_study(const StudyOptions& options, const std::string& words) {
  require_one_rank("study");
  become_python_command("ciliaval.design", *options.command, words, {options.file.string()});
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
  options->command = study;
  study
      ->add_option_function<std::string>(
          "-o,--output", [](const std::string&) {},
          "Folder for the results: study.csv, study.json, figures and the store of what\n"
          "is solved, in a subfolder of the study's name")
      ->type_name("DIR")
      ->default_str("results");
  options->outputs.declare(study, "the results");
  study->add_flag_callback(
      "--fresh", [] {}, "Start anew: forget what an earlier run of the study has solved");
}

}  // namespace ciliaval::compare::app::commands
