// SPDX-License-Identifier: LGPL-2.1-or-later
#include <fmt/core.h>
#include <fmt/ranges.h>

#include <string_view>
#include <vector>

#include "compare/app/case_files.h"
#include "compare/app/commands/commands.h"
#include "compare/app/terminal.h"
#include "compare/input/case.h"
#include "compare/input/schema/json_schema.h"
#include "compare/input/schema/starter.h"
#include "compare/models/registry.h"
#include "compare/output/output_file.h"
#include "problem/error.h"
#include "problem/load.h"
#include "problem/support/words.h"

namespace ciliaval::compare::app::commands {
namespace {

namespace fs = std::filesystem;

struct NewOptions {
  fs::path name;
  std::string load{load_types().front()->name};
};

const LoadType& load_type(const std::string& name) {
  if (const LoadType* type = find_load_type(name)) return *type;
  std::vector<std::string_view> names;
  for (const LoadType* type : load_types()) names.push_back(type->name);
  throw InputError(fmt::format("--load: there is no load type `{}`; the types are {}{}", name,
                               fmt::join(names, ", "), support::did_you_mean(name, names)));
}

/// Writes a case file, which is one that can be read, where there is none.
ExitCode write_new(const NewOptions& options, const std::string&) {
  fs::path file = options.name;
  if (file.extension() != ".toml") file += ".toml";
  if (is_study_file(file) || is_bench_file(file))
    throw InputError(file.string() + ": is called like a study or a test bench, not like a case");
  const std::string text =
      input::schema::starter_case(file.stem().string(), load_type(options.load), models::known());
  input::read_case(text, file.string(), models::known());  // refuses a name that is none
  std::error_code error;
  if (fs::exists(fs::symlink_status(file, error)))
    throw InputError(file.string() + ": there is such a file, which is not replaced");
  output::write_file(file, text);
  print(fmt::format("{0}: edit it, then `ciliaval validate {0}`\n", file.string()));
  return ExitCode::pass;
}

struct None {};

ExitCode print_schema(const None&, const std::string&) {
  print(input::schema::json_schema(models::known()));
  return ExitCode::pass;
}

}  // namespace

void add_new(CommandLine& line) {
  const auto options = std::make_shared<NewOptions>();
  CLI::App* command =
      line.add("new", "Write a commented case file to start from: NAME.toml", options, write_new);
  command->add_option("NAME", options->name, "Name of the case; the file is NAME.toml")->required();
  command->add_option("--load", options->load, "Type of the load; `ciliaval list` names all")
      ->type_name("TYPE")
      ->capture_default_str();
}

void add_schema(CommandLine& line) {
  line.add("schema",
           "Print the JSON schema of case files, by which an editor completes and checks them",
           std::make_shared<None>(), print_schema);
}

}  // namespace ciliaval::compare::app::commands
