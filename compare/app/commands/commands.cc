// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/app/commands/commands.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <string_view>
#include <vector>

#include "compare/app/case_files.h"
#include "compare/app/python.h"
#include "compare/app/terminal.h"
#include "compare/output/output_file.h"
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
            if (word != names.back() && word != stem &&
                word != file.lexically_relative(shipped.folder).string())
              continue;
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

void Outputs::declare(CLI::App* command, const std::string& what, bool has_csv,
                      const char* figure) {
  add_output(command, "--json", json, fmt::format("Write {} as JSON too", what).c_str());
  if (has_csv) add_output(command, "--csv", csv, fmt::format("Write {} as CSV too", what).c_str());
  if (figure != nullptr) add_plot(command, plot, figure);
}

void Outputs::check(const std::vector<fs::path>& inputs, const OptionalFile& other) const {
  output::check_outputs({json, csv, plot, other}, inputs);
}

void Outputs::write(const std::function<std::string()>& to_json,
                    const std::function<std::string()>& to_csv) const {
  if (json) output::write_file(*json, to_json());
  if (csv && to_csv) output::write_file(*csv, to_csv());
  if (plot) draw_figure(to_json(), *plot);
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

void add_help(CommandLine& line) {
  const auto command = std::make_shared<std::string>();
  line.add("help", "Help, of one command or of all", command,
           [&program = line.program](const std::string& name, const std::string&) {
             // App::help() would be that of the command that was parsed, which is this one.
             print(name.empty() ? program.get_formatter()->make_help(&program, program.get_name(),
                                                                     CLI::AppFormatMode::Normal)
                                : program.get_subcommand(name)->help(program.get_name()));
             return ExitCode::pass;
           })
      ->add_option("COMMAND", *command, "Which; none: all")
      ->check([&program = line.program](const std::string& name) -> std::string {
        std::vector<std::string> names;
        for (const CLI::App* known : program.get_subcommands({})) {
          names.push_back(known->get_name());
          if (name == names.back()) return {};
        }
        return fmt::format("there is no command `{}`; the commands are {}", name,
                           fmt::join(names, ", "));
      });
}

}  // namespace ciliaval::compare::app::commands
