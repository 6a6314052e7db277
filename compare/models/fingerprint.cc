// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/models/fingerprint.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>

#include "compare/input/case_syntax.h"
#include "compare/input/measurement/measurement.h"
#include "compare/models/registry.h"

namespace ciliaval::compare::models {
namespace {

/// Each value under its dotted key; the tables of a list are counted from 1.
void append_values(const toml::node& node, const std::string& name, support::Fingerprint& all) {
  const auto inner = [&](std::string_view key) {
    return name.empty() ? std::string(key) : fmt::format("{}.{}", name, key);
  };
  const toml::array* list = node.as_array();
  if (const toml::table* table = node.as_table()) {
    for (const auto& [key, value] : *table) append_values(value, inner(key.str()), all);
  } else if (list != nullptr && list->is_array_of_tables()) {
    for (std::size_t i = 0; i < list->size(); ++i)
      append_values((*list)[i], inner(std::to_string(i + 1)), all);
  } else {
    std::ostringstream text;
    node.visit([&](const auto& value) { text << value; });
    all.emplace_back(name, std::move(text).str());
  }
}

/// The case with the content of its files in place of their names: a file may lie anywhere.
input::Case with_contents(input::Case c) {
  input::change_files(models::known(), c.options,
                      [](input::Option::File kind, std::filesystem::path& file) {
                        if (kind == input::Option::File::mesh)
                          file = support::describe_content(file);
                      });
  if (c.surface && !c.surface->file.empty())
    c.surface->file = support::describe_content(c.surface->file);
  return c;
}

/// True if a dotted key is the table's or lies in it.
bool is_in(std::string_view name, std::string_view table) {
  return name.starts_with(table) && (name.size() == table.size() || name[table.size()] == '.');
}

}  // namespace

support::Fingerprint fingerprint(const input::Case& problem) {
  toml::table all =
      input::parse_toml(input::to_toml(with_contents(problem), models::known()), problem.name);
  all.erase("case");
  support::Fingerprint result;
  append_values(all, "", result);
  return result;
}

std::optional<support::Fingerprint> fingerprint(const input::Case& problem,
                                                const input::MechanicsEntry& entry) {
  if (!entry.checkpoint_without) return std::nullopt;
  const input::ErrorLimit limit =
      entry.error_limit ? entry.error_limit(problem.options) : input::ErrorLimit{};
  const bool needs_field = limit.percent > 0 && limit.of == input::ErrorLimit::Of::field;
  const std::string own = "models." + entry.id;
  const auto cannot_matter = [&](const std::string& name) {
    for (const std::string_view table :
         {std::string_view("signal"), std::string_view("readings"),
          input::measurement::measurement_table, input::measurement::input_table})
      if (is_in(name, table)) return true;
    if (is_in(name, own))
      return std::ranges::any_of(*entry.checkpoint_without, [&](std::string_view option) {
        return is_in(name, fmt::format("{}.{}", own, option));
      });
    return !needs_field && (is_in(name, "sensor") || is_in(name, "models"));
  };
  support::Fingerprint all = fingerprint(problem);
  std::erase_if(all, [&](const auto& value) { return cannot_matter(value.first); });
  return all;
}

}  // namespace ciliaval::compare::models
