// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/input/case_toml.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>
#include <utility>

#include "compare/input/units.h"
#include "problem/error.h"
#include "problem/support/words.h"

namespace ciliaval::compare::input {
namespace {

constexpr std::size_t most_faults = 50;  ///< that a report lists

Place start_of(const toml::source_region& region) {
  if (region.begin.line == 0) return {};
  return {region.begin.line, region.begin.column};
}

template <typename Texts>
std::string valid(const Texts& texts) {
  return fmt::format(" (valid: {})", fmt::join(texts, ", "));
}

/// The number as the file states it.
std::optional<double> number(const toml::node& node) {
  if (const auto* integer = node.as_integer()) return static_cast<double>(integer->get());
  if (const auto* real = node.as_floating_point()) return real->get();
  return std::nullopt;
}

/// The value in SI units. Throws InputError.
double to_si(const toml::node& node, const Quantity& quantity) {
  const auto* text = node.as_string();
  if (quantity.unit.empty()) {
    if (text != nullptr)
      throw InputError(fmt::format("write a plain number without quotes and unit, such as {}",
                                   quantity.example));
    const std::optional<double> value = number(node);
    if (!value) throw InputError(fmt::format("expected a number, found {}", describe(node)));
    if (!std::isfinite(*value)) throw InputError("the number must be finite");
    return *value;
  }
  if (text != nullptr) return parse_quantity(text->get(), quantity);
  if (number(node))
    throw InputError(fmt::format("{} has no unit: write {} {}, such as \"{}\"", describe(node),
                                 quantity.article, quantity.name, quantity.example));
  throw InputError(fmt::format("expected {} {}, such as \"{}\", found {}", quantity.article,
                               quantity.name, quantity.example, describe(node)));
}

/// "'length' is 200 m, but must be from 1e-09 m to 100 m: why".
std::string out_of_range(const toml::node& node, std::string_view name, double value,
                         const Quantity& quantity, const Range& range) {
  const std::string unit = quantity.unit.empty() ? "" : fmt::format(" {}", quantity.unit);
  const auto* text = node.as_string();
  const std::string given = text != nullptr ? fmt::format(" ({})", in_quotes(text->get())) : "";
  return fmt::format("'{}' is {:g}{}{}, but must be {}: {}", name, value, unit, given,
                     describe(range, quantity), range.reason);
}

}  // namespace

Place place(const toml::node& node) {
  return start_of(node.source());
}

Place place(const toml::key& key) {
  return start_of(key.source());
}

std::string describe(const Range& range, const Quantity& quantity) {
  const bool is_angle = quantity.unit == quantity::angle.unit;
  const std::string_view name = is_angle ? "deg" : quantity.unit;
  const double factor = is_angle ? 180 / std::numbers::pi : 1;
  const std::string unit = name.empty() ? "" : fmt::format(" {}", name);
  const std::string lower = fmt::format("{:g}{}", range.lower * factor, unit);
  const std::string upper = fmt::format("{:g}{}", range.upper * factor, unit);
  if (range.excludes_ends) return fmt::format("between {} and {}, both excluded", lower, upper);
  return fmt::format("from {} to {}", lower, upper);
}

std::string Faults::report(std::string_view file) const {
  std::vector<Fault> sorted = faults_;
  std::stable_sort(sorted.begin(), sorted.end(), [](const Fault& a, const Fault& b) {
    return std::pair(a.where.line, a.where.column) < std::pair(b.where.line, b.where.column);
  });
  std::string text;
  for (std::size_t i = 0; i < sorted.size() && i < most_faults; ++i)
    text += fmt::format("{}{}:{}:{}: {}", i == 0 ? "" : "\n", file, sorted[i].where.line,
                        sorted[i].where.column, sorted[i].what);
  if (sorted.size() > most_faults)
    text += fmt::format("\n{}: {} more faults", file, sorted.size() - most_faults);
  return text;
}

Section::Section(const toml::table* table, std::string name, std::string path, Place where,
                 Faults& faults)
    : table_(table),
      name_(std::move(name)),
      path_(std::move(path)),
      where_(where),
      faults_(&faults) {}

const toml::node* Section::find(std::string_view key) {
  if (std::find(valid_.begin(), valid_.end(), key) == valid_.end()) valid_.emplace_back(key);
  return table_ == nullptr ? nullptr : table_->get(key);
}

const toml::node* Section::require(std::string_view key, std::string_view needed) {
  const toml::node* node = find(key);
  if (node == nullptr && exists())
    missing_.push_back(
        {std::string(key), needed.empty() ? fmt::format("'{}'", key) : std::string(needed)});
  return node;
}

Section Section::section(std::string_view key) {
  const toml::node* node = find(key);
  const std::string path = path_.empty() ? std::string(key) : fmt::format("{}.{}", path_, key);
  const std::string name = fmt::format("[{}]", path);
  if (node == nullptr) return {nullptr, name, path, where_, *faults_};
  if (!node->is_table())
    faults_->add(place(*node),
                 fmt::format("expected the table {}, found {}", name, describe(*node)));
  return {node->as_table(), name, path, place(*node), *faults_};
}

void Section::read(std::string_view key, const Range& range, unsigned int& value) {
  if (const toml::node* node = find(key))
    value = read_whole_number(*node, key, range, *faults_).value_or(value);
}

void Section::tables(std::string_view key, std::size_t fewest, std::size_t most,
                     const std::function<void(Section&)>& f) {
  const toml::node* node = find(key);
  if (node == nullptr) return;
  const std::string path = path_.empty() ? std::string(key) : fmt::format("{}.{}", path_, key);
  const toml::array* list = node->as_array();
  if (list == nullptr || list->size() < fewest || list->size() > most)
    return faults_->add(
        place(*node),
        fmt::format("expected {} to {} tables [[{}]], found {}", fewest, most, path,
                    list == nullptr ? describe(*node) : fmt::format("{}", list->size())));
  for (const toml::node& element : *list) {
    if (!element.is_table()) {
      faults_->add(place(element),
                   fmt::format("expected a table [[{}]], found {}", path, describe(element)));
      continue;
    }
    Section table(element.as_table(), fmt::format("[[{}]]", path), path, place(element), *faults_);
    f(table);
    table.finish();
  }
}

void Section::finish() const {
  if (table_ == nullptr) return;
  const std::vector<std::string_view> candidates(valid_.begin(), valid_.end());
  std::vector<Missing> missing = missing_;
  for (const auto& [key, node] : *table_) {
    if (std::find(valid_.begin(), valid_.end(), key.str()) != valid_.end()) continue;
    std::erase_if(missing, [near = support::nearest(key.str(), candidates)](const Missing& m) {
      return m.key == near;
    });
    faults_->add(place(key),
                 fmt::format("unknown key {} in {}{}{}", in_quotes(key.str()), name_, valid(valid_),
                             support::did_you_mean(key.str(), candidates)));
  }
  for (const auto& [key, needed] : missing)
    faults_->add(where_, fmt::format("{} needs {}", name_, needed));
}

bool has_control_character(std::string_view text) {
  return std::ranges::any_of(
      text, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; });
}

std::string toml_text(const std::string& text) {
  std::ostringstream out;
  const toml::table holder{{"t", text}};
  // toml_formatter writes `t = '…'`; the value is what follows.
  out << toml::toml_formatter(holder);
  return out.str().substr(4);
}

std::string describe(const toml::node& node) {
  if (const auto* v = node.as_integer()) return fmt::format("the number {}", v->get());
  if (const auto* v = node.as_floating_point()) return fmt::format("the number {:g}", v->get());
  if (const auto* v = node.as_boolean()) return v->get() ? "true" : "false";
  if (const auto* v = node.as_string()) return fmt::format("the text {}", in_quotes(v->get()));
  if (node.is_array()) return "a list";
  if (node.is_table()) return "a table";
  return "a date or time";
}

std::optional<std::string> read_text(const toml::node& node, std::string_view name,
                                     Faults& faults) {
  if (const auto* text = node.as_string()) return text->get();
  faults.add(place(node),
             fmt::format("'{}' must be a text in quotes, found {}", name, describe(node)));
  return std::nullopt;
}

std::optional<std::string> read_choice(const toml::node& node, std::string_view name,
                                       std::span<const std::string_view> choices, Faults& faults) {
  std::optional<std::string> text = read_text(node, name, faults);
  if (!text) return std::nullopt;
  if (std::find(choices.begin(), choices.end(), *text) != choices.end()) return text;
  faults.add(place(node), fmt::format("'{}' cannot be {}{}{}", name, in_quotes(*text),
                                      valid(choices), support::did_you_mean(*text, choices)));
  return std::nullopt;
}

std::vector<std::string> read_choices(const toml::node& node, std::string_view name,
                                      std::span<const std::string_view> choices, Faults& faults) {
  std::vector<std::string> result;
  const toml::array* list = node.as_array();
  if (list == nullptr) {
    faults.add(place(node), fmt::format("'{}' must be a list, such as [\"{}\"], found {}", name,
                                        choices.front(), describe(node)));
    return result;
  }
  for (const toml::node& element : *list) {
    const std::optional<std::string> text = read_choice(element, name, choices, faults);
    if (!text) continue;
    if (std::find(result.begin(), result.end(), *text) != result.end())
      faults.add(place(element), fmt::format("'{}' lists {} twice", name, in_quotes(*text)));
    else
      result.push_back(*text);
  }
  return result;
}

std::optional<double> read_value(const toml::node& node, std::string_view name,
                                 const Quantity& quantity, const Range& range, Faults& faults) {
  try {
    const double value = to_si(node, quantity);
    if (range.contains(value)) return value;
    faults.add(place(node), out_of_range(node, name, value, quantity, range));
  } catch (const InputError& fault) {
    faults.add(place(node), fmt::format("'{}': {}", name, fault.what()));
  }
  return std::nullopt;
}

std::optional<unsigned int> read_whole_number(const toml::node& node, std::string_view name,
                                              const Range& range, Faults& faults) {
  const auto* integer = node.as_integer();
  if (integer == nullptr) {
    faults.add(place(node),
               fmt::format("'{}' must be a whole number, found {}", name, describe(node)));
    return std::nullopt;
  }
  const auto value = static_cast<double>(integer->get());
  if (range.contains(value)) return static_cast<unsigned int>(integer->get());
  faults.add(place(node), out_of_range(node, name, value, quantity::number, range));
  return std::nullopt;
}

}  // namespace ciliaval::compare::input
