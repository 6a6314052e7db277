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

/// Reads the keys of the struct. Which keys belong is not known where one that always does has a
/// fault or is a choice that is missing: they must then be right by themselves alone. The table is
/// the caller's to finish.
template <class Owner>
void read(Section& table, const description::Fields<Owner>& fields, Owner& owner) {
  using description::Key;
  for (const description::Field<Owner>& field : fields) table.find(field.name);  // their order
  const std::size_t before = table.faults().size();
  const auto read_one = [&](const description::Field<Owner>& field, bool is_required) {
    const toml::node* node = is_required ? table.require(field.name) : table.find(field.name);
    const auto value = node != nullptr ? read_value(*node, field, table.faults()) : std::nullopt;
    if (value) field.set(owner, *value);
    return node != nullptr;
  };
  bool is_known = true;
  for (const description::Field<Owner>& field : fields)
    if (!field.condition) {
      const bool is_required = field.absence == Key::Absence::fault;
      const bool is_there = read_one(field, is_required);
      if (is_required && !is_there && !field.choices.empty()) is_known = false;
    }
  is_known = is_known && table.faults().size() == before;
  for (const description::Field<Owner>& field : fields) {
    if (!field.condition) continue;
    const bool belongs = field.belongs(owner);
    const toml::node* node = table.find(field.name);
    if (is_known && !belongs && node != nullptr)
      table.faults().add(place(*node),
                         fmt::format("'{}' goes with {} only", field.name, field.goes_with));
    else
      read_one(field, is_known && belongs && field.absence == Key::Absence::fault);
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
