// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/app/commands/commands.h"

#include <fmt/core.h>

#include <string_view>
#include <vector>

#include "compare/app/case_files.h"
#include "fem/parallel.h"
#include "problem/error.h"
#include "problem/support/words.h"

namespace ciliaval::compare::app::commands {

namespace fs = std::filesystem;

CLI::Validator input_file() {
  return {
      [](std::string& word) -> std::string {
        if (std::string fault = CLI::ExistingFile(word); fault.empty() || fs::exists(word))
          return fault;
        const ShippedCases shipped = shipped_cases();
        std::vector<std::string> names;
        for (const auto* files : {&shipped.files, &shipped.studies, &shipped.benches})
          for (const fs::path& file : *files) {
            const std::string stem = file.stem().string();  // fig5, fig5.sense
            names.push_back(stem.substr(0, stem.find('.')));
            if (word != names.back() && word != stem) continue;
            word = file.string();
            return {};
          }
        return fmt::format(
            "there is no file `{}`, and no such case comes with the program{}", word,
            support::did_you_mean(word, std::vector<std::string_view>(names.begin(), names.end())));
      },
      "FILE"};
}

CLI::Option* add_file(CLI::App* command, const char* name, std::filesystem::path& file,
                      const char* description) {
  return command->add_option(name, file, description)->required()->transform(input_file());
}

void add_output(CLI::App* command, const char* name, OptionalFile& file, const char* description,
                const char* type) {
  command->add_option(name, file, description)->type_name(type);
}

void add_plot(CLI::App* command, OptionalFile& file, const char* description, const char* name) {
  command->add_option(name, file, description)
      ->type_name("FILE.svg")
      ->check([](const std::string& value) -> std::string {
        for (const char* kind : {".svg", ".pdf", ".png"})
          if (fs::path(value).extension() == kind) return {};
        return fmt::format("`{}`: a figure's name ends in .svg, .pdf or .png", value);
      });
}

void add_explain(CLI::App* command, bool& explain) {
  command->add_flag("--explain", explain, "Say below the tables what is divided by what");
}

output::Footnotes footnotes_of(bool explain) {
  return explain ? output::Footnotes::text : output::Footnotes::reference;
}

void require_one_rank(const char* command) {
  if (fem::rank_count() > 1)
    throw InputError(
        fmt::format("`ciliaval {}` runs on one rank: start it without mpirun", command));
}

}  // namespace ciliaval::compare::app::commands
