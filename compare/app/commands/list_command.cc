// SPDX-License-Identifier: LGPL-2.1-or-later
#include <fmt/core.h>
#include <toml++/toml.h>

#include <vector>

#include "compare/app/case_files.h"
#include "compare/app/commands/commands.h"
#include "compare/app/terminal.h"
#include "compare/models/registry.h"
#include "compare/study/reader/study_reader.h"
#include "problem/error.h"
#include "problem/load.h"

namespace ciliaval::compare::app::commands {
namespace {

namespace fs = std::filesystem;

struct ListOptions {};

std::string title_of(const fs::path& file) {
  try {
    if (is_study_file(file)) return study::reader::read_study(file).title;
    if (is_bench_file(file))
      return toml::parse_file(file.string())["bench"]["title"].value_or(std::string());
    return input::read_case(file, models::known()).title;
  } catch (const std::exception&) {
    return "(cannot be read: see `ciliaval validate`)";
  }
}

std::string list_of_cases() {
  const ShippedCases shipped = shipped_cases();
  if (shipped.files.empty()) return "Shipped cases: none found beside the program\n";
  std::string text;
  const auto add = [&](const char* kind, const std::vector<fs::path>& files) {
    if (files.empty()) return;
    text += fmt::format("{}Shipped {}, in {}\n", text.empty() ? "" : "\n", kind,
                        shipped.folder.string());
    for (const fs::path& file : files)
      text += fmt::format("  {:<28} {}\n", file.lexically_relative(shipped.folder).string(),
                          title_of(file));
  };
  add("cases", shipped.files);
  add("studies", shipped.studies);
  add("test benches", shipped.benches);
  return text;
}

ExitCode list(const ListOptions&, const std::string&) {
  std::string text =
      "Mechanics models (in a comparison the later one is the reference,\nof rods the one with "
      "corrected joints)\n";
  const auto add = [&](const auto& entries) {
    for (const auto& entry : entries)
      text += fmt::format("  {:<10} {}{}\n", entry.id, entry.description,
                          entry.is_slow ? "; slow" : "");
  };
  add(models::mechanics_models());
  text += fmt::format(
      "  {:<10} {}\n", "(external)",
      "[[models.external]]: centrelines and readings from CSV files (docs/guide/referees.md)");
  text += "\nField models\n";
  add(models::field_models());
  text += "\nLoads\n";
  for (const LoadType* type : load_types())
    text += fmt::format("  {:<10} {}\n", type->name, type->description);
  print(text + "\n" + list_of_cases());
  return ExitCode::pass;
}

}  // namespace

void add_list(CommandLine& line) {
  line.add("list", "List models, loads, shipped cases, studies and benches",
           std::make_shared<ListOptions>(), list);
}

}  // namespace ciliaval::compare::app::commands
