// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/input/described.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <span>
#include <tuple>
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
  if (key.file == Key::File::data && text->empty()) {
    faults.add(place(node), fmt::format("'{}' must name a file", key.name));
    return std::nullopt;
  }
  if (!has_control_character(*text)) return *text;
  faults.add(place(node), fmt::format("'{}' must not have control characters", key.name));
  return std::nullopt;
}

/// A fixed number of plain numbers or quantities.
template <std::size_t count>
std::optional<Value> read_as_list(const toml::node& node, const Key& key, Faults& faults) {
  constexpr std::array words{"", "", "two", "three", "four"};
  const toml::array* list = node.as_array();
  if (list == nullptr || list->size() != count) {
    faults.add(
        place(node),
        fmt::format("'{}' must be a list of {} numbers, such as {}, found {}", key.name,
                    words.at(count), to_toml(key, key.initial),
                    list == nullptr ? describe(node) : fmt::format("a list of {}", list->size())));
    return std::nullopt;
  }
  std::array<double, count> values{};
  bool is_right = true;
  for (std::size_t i = 0; i < count; ++i) {
    const auto value = read_value((*list)[i], key.name, key.quantity, key.range, faults);
    values.at(i) = value.value_or(0);
    is_right = is_right && value;
  }
  return is_right ? std::optional<Value>(values) : std::nullopt;
}

template <class T>
std::optional<Value> as_value(std::optional<T> value) {
  return value ? std::optional<Value>(*value) : std::nullopt;
}

/// A number, or the word that may stand in its place.
std::optional<Value> read_number(const toml::node& node, const Key& key, Faults& faults) {
  if (const auto* text = node.as_string(); text != nullptr && !key.word.empty()) {
    if (text->get() == key.word) return Key::stands_for_word;
    if (text->get().find_first_of("0123456789") == std::string::npos) {
      faults.add(place(node), fmt::format("'{}' must be a number or \"{}\", found {}", key.name,
                                          key.word, describe(node)));
      return std::nullopt;
    }
  }
  return as_value(read_value(node, key.name, key.quantity, key.range, faults));
}

/// A number, quoted if it has a unit.
std::string number_text(const Key& key, double value) {
  if (key.is_word(value)) return fmt::format("\"{}\"", key.word);
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
          return read_number(node, key, faults);
        } else if constexpr (std::is_same_v<T, Vector3>) {
          if (!key.may_be_axial || node.is_array()) return as_value(read_point(node, key, faults));
          const auto axial = read_value(node, key.name, key.quantity, key.range, faults);
          return axial ? std::optional<Value>(Vector3(0, 0, *axial)) : std::nullopt;
        } else {
          return read_as_list<std::tuple_size_v<T>>(node, key, faults);
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
        if constexpr (std::is_same_v<T, std::array<double, 2>> ||
                      std::is_same_v<T, std::array<double, 4>>)
          return list_text(key, v);
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

std::string line_of(const Key& key, const std::vector<std::string>& values, bool is_list) {
  const bool is_one = std::ranges::all_of(
      values, [&](const std::string& value) { return value == values.front(); });
  if (is_one && !is_list) return fmt::format("{} = {}\n", key.name, values.front());
  return fmt::format("{} = [{}]\n", key.name, fmt::join(values, ", "));
}

std::vector<Value> read_values(const toml::node& node, const Key& key, PathLength& length,
                               Faults& faults) {
  const bool is_vector = std::holds_alternative<Vector3>(key.initial);
  const toml::array* list = key.is_along_path ? node.as_array() : nullptr;
  if (list != nullptr && is_vector && !list->empty() && !list->front().is_array()) list = nullptr;
  std::vector<Value> values;
  const auto read_one = [&](const toml::node& element) {
    if (const auto value = read_value(element, key, faults)) values.push_back(*value);
  };
  if (list == nullptr) {
    read_one(node);
    return values;
  }
  const std::size_t count = list->size();
  const std::size_t before = faults.size();
  if (count == 1 && length.takes_one_for_all) {
    read_one(list->front());
    return values;
  }
  if (count == 0 || count > PathLength::most) {
    faults.add(place(node), fmt::format("'{}' lists {} values: a load path has 1 to {} steps",
                                        key.name, count, PathLength::most));
    return {};
  }
  if (!length.listed.empty() && count != length.steps)
    faults.add(place(node), fmt::format("'{}' lists {} values, but '{}' lists {}: all lists of a "
                                        "load path have the same length",
                                        key.name, count, length.listed, length.steps));
  if (faults.size() == before) length = {length.takes_one_for_all, count, key.name, place(node)};
  for (const toml::node& element : *list) read_one(element);
  return faults.size() == before ? values : std::vector<Value>{};
}

const toml::node* find_stated(Section& table, const Key& key, std::span<const Key* const> all,
                              bool is_required) {
  if (!key.in_place_of.empty()) {
    const toml::node* node = table.find(key.name);
    if (node == nullptr || table.find(key.in_place_of) == nullptr) return node;
    table.faults().add(place(*node), fmt::format("'{}' contradicts '{}': give one of them",
                                                 key.name, key.in_place_of));
    return nullptr;
  }
  std::string needed = fmt::format("'{}'", key.name);
  for (const Key* other : all) {
    if (other->in_place_of != key.name) continue;
    if (table.find(other->name) != nullptr) is_required = false;
    needed += fmt::format(" or '{}'", other->name);
  }
  return is_required ? table.require(key.name, needed) : table.find(key.name);
}

}  // namespace ciliaval::compare::input
