// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/input/described.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <span>
#include <type_traits>
#include <vector>

#include "compare/input/case_sections.h"
#include "compare/input/units.h"

namespace ciliaval::compare::input {
namespace {

using description::Key;
using description::Value;

std::optional<Value> read_as_text(const toml::node& node, const Key& key, Faults& faults) {
  std::optional<std::string> text;
  if (!key.choices.empty())
    text = read_choice(node, key.name, key.choices, faults);
  else if (key.longest > 0)
    text = read_line(node, key.name, key.longest, faults);
  else
    text = read_text(node, key.name, faults);
  if (!text) return std::nullopt;
  if (!has_control_character(*text)) return *text;
  faults.add(place(node), fmt::format("'{}' must not have control characters", key.name));
  return std::nullopt;
}

std::optional<Value> read_as_pair(const toml::node& node, const Key& key, Faults& faults) {
  const toml::array* list = node.as_array();
  if (list == nullptr || list->size() != 2) {
    faults.add(
        place(node),
        fmt::format("'{}' must be a list of two numbers, such as {}, found {}", key.name,
                    to_toml(key, key.initial),
                    list == nullptr ? describe(node) : fmt::format("a list of {}", list->size())));
    return std::nullopt;
  }
  const auto first = read_value((*list)[0], key.name, key.quantity, key.range, faults);
  const auto second = read_value((*list)[1], key.name, key.quantity, key.range, faults);
  if (!first || !second) return std::nullopt;
  return std::array{*first, *second};
}

/// A number, quoted if it has a unit.
std::string number_text(const Key& key, double value) {
  const std::string text = format_quantity(value, key.quantity);
  return key.quantity.unit.empty() ? text : fmt::format("\"{}\"", text);
}

std::string list_text(const Key& key, std::span<const double> values) {
  std::vector<std::string> texts;
  for (const double value : values) texts.push_back(number_text(key, value));
  return fmt::format("[{}]", fmt::join(texts, ", "));
}

/// A TOML string in double quotes; the text has no control characters.
std::string in_toml_quotes(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + '"';
}

template <class T>
std::optional<Value> as_value(std::optional<T> value) {
  return value ? std::optional<Value>(*value) : std::nullopt;
}

}  // namespace

std::optional<Value> read_value(const toml::node& node, const Key& key, Faults& faults) {
  return std::visit(
      [&](const auto& kind) -> std::optional<Value> {
        using T = std::decay_t<decltype(kind)>;
        if constexpr (std::is_same_v<T, std::string>) {
          return read_as_text(node, key, faults);
        } else if constexpr (std::is_same_v<T, bool>) {
          if (const auto* flag = node.as_boolean()) return flag->get();
          faults.add(place(node),
                     fmt::format("'{}' must be true or false, found {}", key.name, describe(node)));
          return std::nullopt;
        } else if constexpr (std::is_same_v<T, unsigned int>) {
          return as_value(read_whole_number(node, key.name, key.range, faults));
        } else if constexpr (std::is_same_v<T, double>) {
          return as_value(read_value(node, key.name, key.quantity, key.range, faults));
        } else if constexpr (std::is_same_v<T, Vector3>) {
          if (!key.may_be_axial || node.is_array()) return as_value(read_point(node, key, faults));
          const auto axial = read_value(node, key.name, key.quantity, key.range, faults);
          return axial ? std::optional<Value>(Vector3(0, 0, *axial)) : std::nullopt;
        } else {
          return read_as_pair(node, key, faults);
        }
      },
      key.initial);
}

std::string to_toml(const Key& key, const Value& value) {
  return std::visit(
      [&key](const auto& v) -> std::string {
        using T = std::decay_t<decltype(v)>;
        if constexpr (std::is_same_v<T, std::string>)
          return key.longest > 0 ? toml_text(v) : in_toml_quotes(v);
        if constexpr (std::is_same_v<T, bool>) return v ? "true" : "false";
        if constexpr (std::is_same_v<T, unsigned int>) return fmt::format("{}", v);
        if constexpr (std::is_same_v<T, double>) return number_text(key, v);
        if constexpr (std::is_same_v<T, std::array<double, 2>>) return list_text(key, v);
        if constexpr (std::is_same_v<T, Vector3>)
          return key.may_be_axial && v.template head<2>().isZero(0)
                     ? number_text(key, v.z())
                     : list_text(key, std::span(v.data(), 3));
      },
      value);
}

bool is_written(const Key& key, const Value& value) {
  return key.absence != Key::Absence::nothing || value != key.initial;
}

}  // namespace ciliaval::compare::input
