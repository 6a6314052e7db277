// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "compare/input/case_toml.h"
#include "problem/description/field.h"

/// Described structs (problem/description/field.h) from and to tables of a case file.
namespace ciliaval::compare::input {

/// The value of a key in its range, or a fault.
std::optional<description::Value> read_value(const toml::node& node, const description::Key& key,
                                             Faults& faults);

/// The value as a file would state it: `"0.0005 m"`, `1`, `false`, `"wedge"`, `[0.1, 0.2]`.
std::string to_toml(const description::Key& key, const description::Value& value);

/// True if a case file states the value when it is written.
bool is_written(const description::Key& key, const description::Value& value);

/// `name = value`, or all of the values as a list if there are several and they differ.
std::string line_of(const description::Key& key, const std::vector<std::string>& values,
                    bool is_list);

/// The number of steps of a load path, which any of its keys may tell by a list.
struct PathLength {
  static constexpr std::size_t most = 1000;  ///< each writes files of every model, 1 MB and more
  bool takes_one_for_all = false;            ///< a list of one value stands for every step
  std::size_t steps = 1;
  std::string_view listed{};  ///< the key whose list told it
  Place where{};              ///< its list
};

/// The values of a key: one, or those of the steps; none if one has a fault, or if there are not as
/// many as another key lists.
std::vector<description::Value> read_values(const toml::node& node, const description::Key& key,
                                            PathLength& length, Faults& faults);

/// The key's node, or null. A key that is required and not there, nor what may take its place, is a
/// fault; so is what takes the place of one that is there.
const toml::node* find_stated(Section& table, const description::Key& key,
                              std::span<const description::Key* const> all, bool is_required);

template <class Owner>
std::vector<const description::Key*> keys_of(const description::Fields<Owner>& fields) {
  std::vector<const description::Key*> keys;
  for (const description::Field<Owner>& field : fields) keys.push_back(&field);
  return keys;
}

/// Reads the keys of the steps of a path: `path` has one element, whose values stand for what is
/// not stated, and one for each step if a key lists its values. Which keys belong is not known
/// where one that always does has a fault or is a choice that is missing: they must then be right
/// by themselves alone. The table is the caller's to finish.
template <class Owner>
void read(Section& table, const description::Fields<Owner>& fields, std::vector<Owner>& path,
          PathLength& length) {
  using description::Key;
  for (const description::Field<Owner>& field : fields) table.find(field.name);  // their order
  const std::vector<const Key*> all = keys_of(fields);
  const std::size_t before = table.faults().size();
  const auto read_one = [&](const description::Field<Owner>& field, bool is_required) {
    const toml::node* node = find_stated(table, field, all, is_required);
    if (node == nullptr) return false;
    const auto values = read_values(*node, field, length, table.faults());
    path.resize(std::max(path.size(), values.size()), path.front());
    for (std::size_t i = 0; i < path.size() && !values.empty(); ++i)
      field.set(path[i], values[values.size() == 1 ? 0 : i]);
    return true;
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
    const bool belongs = field.belongs(path.front());
    const toml::node* node = table.find(field.name);
    if (is_known && !belongs && node != nullptr)
      table.faults().add(place(*node),
                         fmt::format("'{}' goes with {} only", field.name, field.goes_with));
    else
      read_one(field, is_known && belongs && field.absence == Key::Absence::fault);
  }
}

/// The same of a struct that no list varies.
template <class Owner>
void read(Section& table, const description::Fields<Owner>& fields, Owner& owner) {
  std::vector<Owner> path{std::move(owner)};
  PathLength alone;
  read(table, fields, path, alone);
  owner = std::move(path.front());
}

/// The key that tells the number of steps is a list even if its values are all the same.
enum class Listed { if_they_differ, first_key };

/// `name = value`, or a list of values; a line for each key that a file states.
template <class Owner>
std::string lines(const description::Fields<Owner>& fields, std::span<const Owner> path,
                  Listed listed = Listed::if_they_differ) {
  std::string text;
  for (const description::Field<Owner>& field : fields) {
    if (!field.in_place_of.empty() || !field.belongs(path.front())) continue;
    bool is_there = false;
    std::vector<std::string> values;
    for (const Owner& owner : path) {
      const description::Value value = field.get(owner);
      is_there = is_there || is_written(field, value);
      values.push_back(to_toml(field, value));
    }
    const bool is_list = listed == Listed::first_key && &field == &fields.front();
    if (is_there) text += line_of(field, values, is_list);
  }
  return text;
}

template <class Owner>
std::string lines(const description::Fields<Owner>& fields, const Owner& owner) {
  return lines(fields, std::span(&owner, 1));
}

}  // namespace ciliaval::compare::input
