// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <fmt/format.h>
#include <toml++/toml.h>

#include <optional>
#include <string>

#include "compare/input/case_toml.h"
#include "problem/description/field.h"

/// Described structs (problem/description/field.h) from and to tables of a case file.
namespace ciliaval::compare::input {

/// The value of a key in its range, or a fault.
std::optional<description::Value> read_value(const toml::node& node, const description::Key& key,
                                             Faults& faults);

/// The value as a file would state it: `"0.0005 m"`, `1`, `false`, `"wedge"`, `[0.1, 0.2]`.
std::string to_toml(const description::Key& key, const description::Value& value);

/// Whether a file states the value.
bool is_written(const description::Key& key, const description::Value& value);

/// Reads the keys of the struct. Keys that go with a value that has a fault are allowed, and not
/// read. The table is the caller's to finish.
template <class Owner>
void read(Section& table, const description::Fields<Owner>& fields, Owner& owner) {
  for (const description::Field<Owner>& field : fields) table.find(field.name);  // their order
  bool is_known = true;  // which keys belong
  for (const description::Field<Owner>& field : fields) {
    if (!field.condition) {
      const bool is_required = field.absence == description::Key::Absence::fault;
      const toml::node* node = is_required ? table.require(field.name) : table.find(field.name);
      const auto value = node != nullptr ? read_value(*node, field, table.faults()) : std::nullopt;
      if (value) field.set(owner, *value);
      if (!field.choices.empty() && !value && (node != nullptr || is_required)) is_known = false;
    }
  }
  for (const description::Field<Owner>& field : fields) {
    if (!field.condition) continue;
    const bool belongs = is_known && field.belongs(owner);
    const bool is_required = belongs && field.absence == description::Key::Absence::fault;
    const toml::node* node = is_required ? table.require(field.name) : table.find(field.name);
    if (node == nullptr || !is_known) continue;
    if (!belongs)
      table.faults().add(place(*node),
                         fmt::format("'{}' goes with {} only", field.name, field.goes_with));
    else if (const auto value = read_value(*node, field, table.faults()))
      field.set(owner, *value);
  }
}

/// A line `name = value` for each key that a file states.
template <class Owner>
std::string lines(const description::Fields<Owner>& fields, const Owner& owner) {
  std::string text;
  for (const description::Field<Owner>& field : fields) {
    if (!field.belongs(owner)) continue;
    const description::Value value = field.get(owner);
    if (is_written(field, value))
      text += fmt::format("{} = {}\n", field.name, to_toml(field, value));
  }
  return text;
}

}  // namespace ciliaval::compare::input
