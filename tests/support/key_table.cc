// SPDX-License-Identifier: LGPL-2.1-or-later
#include "tests/support/key_table.h"

#include <fmt/format.h>

#include <vector>

#include "compare/input/case_toml.h"
#include "compare/input/schema/keys.h"

namespace ciliaval::test {
namespace {

using namespace compare::input;
using schema::Key;

/// "`contact`, `flow` or `probe`".
std::string in_code(const std::vector<std::string_view>& names, std::string_view last) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i)
    text += fmt::format("{}`{}`", i == 0 ? "" : i + 1 < names.size() ? ", " : last, names[i]);
  return text;
}

/// Values that a key may have.
std::string value_of(const Key& key) {
  switch (key.kind) {
    case Key::Kind::text:
      return key.example.empty() ? "text" : fmt::format("text, `{}`", key.example);
    case Key::Kind::file:
      return "file name";
    case Key::Kind::files:
      return "list of file names";
    case Key::Kind::choice:
      return in_code(key.choices, " or ");
    case Key::Kind::choices:
      return "list of " + in_code(key.choices, ", ");
    case Key::Kind::flag:
      return "`true` or `false`";
    case Key::Kind::whole_number:
      return "whole number";
    case Key::Kind::pair:
      return key.quantity.unit.empty() ? "two plain numbers"
                                       : fmt::format("two of {} {}, `\"{}\"`", key.quantity.article,
                                                     key.quantity.name, key.quantity.example);
    case Key::Kind::any_pair:
      return fmt::format("two quantities, `{}`", key.example);
    case Key::Kind::any:
      return fmt::format("quantity, `\"{}\"`", key.example);
    case Key::Kind::quantity:
    case Key::Kind::quantities:
    case Key::Kind::point:
    case Key::Kind::points:
      break;
  }
  if (!key.word.empty()) return fmt::format("{}, or `\"{}\"`", key.quantity.name, key.word);
  return key.quantity.unit.empty()
             ? std::string(key.quantity.name)
             : fmt::format("{}, `\"{}\"`", key.quantity.name, key.quantity.example);
}

}  // namespace

std::string key_table(const Models& models) {
  std::string table =
      "| key | value | range | default | meaning |\n| --- | --- | --- | --- | --- |\n";
  for (const Key& key : schema::all_keys(models)) {
    const bool has_range = key.range.lower != key.range.upper;
    table += fmt::format("| `{}.{}` | {} | {} | {} | {} |\n", key.table, key.name, value_of(key),
                         has_range ? describe(key.range, key.quantity) : "",
                         key.fallback.empty() ? "required" : key.fallback, key.text);
  }
  return table;
}

}  // namespace ciliaval::test
