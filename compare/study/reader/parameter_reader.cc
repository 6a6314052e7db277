// SPDX-License-Identifier: LGPL-2.1-or-later
// The parameters of a study file.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "compare/input/case_sections.h"
#include "compare/study/reader/reading.h"
#include "problem/support/words.h"

namespace ciliaval::compare::study::reader {
namespace {

constexpr std::size_t most_searched = 8;
constexpr std::size_t longest_name = 40;  ///< of a parameter, bytes
constexpr Range count_range{2, 100'000, false, "a range has two ends, and a study must end"};

/// The model of an option "models.MODEL.NAME" if no pair of the study runs it; else empty.
std::string idle_model(const Study& study, std::string_view path) {
  constexpr std::string_view prefix = "models.";
  if (!path.starts_with(prefix) || study.pairs.empty()) return {};
  path.remove_prefix(prefix.size());
  const std::string_view model = path.substr(0, path.find('.'));
  const bool is_run = std::any_of(
      study.pairs.begin(), study.pairs.end(),
      [&](const ModelPair& pair) { return pair.mechanics == model || pair.field == model; });
  return is_run ? std::string() : std::string(model);
}

/// The value with 15 significant digits, which a person would have written: 0.3, not
/// 0.30000000000000004.
double rounded(double value) {
  return std::stod(fmt::format("{:.15g}", value));
}

/// The values from one end to the other, both included.
std::vector<double> spaced(double from, double to, unsigned int count, bool logarithmic) {
  std::vector<double> values(count);
  for (unsigned int i = 0; i < count; ++i) {
    const double t = static_cast<double>(i) / (count - 1);
    values[i] = rounded(logarithmic ? from * std::pow(to / from, t) : from + t * (to - from));
  }
  values.front() = from;
  values.back() = to;
  return values;
}

/// `path` and `name`; none, with a fault, if there is no such number.
std::optional<Parameter> read_name(input::Section& table, const Reading& reading) {
  input::Faults& faults = table.faults();
  const toml::node* path_node = table.require("path");
  const toml::node* name = table.find("name");
  const std::optional<std::string> path =
      path_node != nullptr ? input::read_text(*path_node, "path", faults) : std::nullopt;
  const CaseNumber* number =
      path ? find_number(reading, *path, input::place(*path_node), faults) : nullptr;
  if (number == nullptr) return std::nullopt;
  Parameter parameter{*number, path->substr(path->find_last_of('.') + 1), {}, 1, {}, false};
  check_contradiction(reading.study, *number, input::place(*path_node), faults);
  if (name != nullptr)
    parameter.name = input::read_line(*name, "name", longest_name, faults).value_or(parameter.name);
  return parameter;
}

/// The two ends of a range.
struct Ends {
  double from = 0;
  double to = 0;
};

/// `from`, `to` and `spacing`, with the parameter's unit and spacing; none if there is a fault.
std::optional<Ends> read_ends(input::Section& table, Parameter& parameter) {
  input::Faults& faults = table.faults();
  const std::size_t before = faults.size();
  const auto end = [&](std::string_view key) {
    const toml::node* node = table.require(key);
    if (node == nullptr) return std::optional<double>();
    if (parameter.unit.empty()) parameter.unit = unit_of(*node);
    return read_number(*node, key, parameter.number, faults);
  };
  const auto from = end("from");
  const auto to = end("to");
  if (const toml::node* node = table.find("spacing")) {
    constexpr std::array<std::string_view, 2> spacings{"linear", "logarithmic"};
    parameter.is_logarithmic =
        input::read_choice(*node, "spacing", spacings, faults) == spacings[1];
  }
  if (!from || !to || faults.size() != before) return std::nullopt;
  if (*from == *to)
    faults.add(input::place(*table.find("to")),
               "'from' and 'to' are the same: there is nothing to vary");
  else if (parameter.is_logarithmic && !(*from * *to > 0))
    faults.add(input::place(*table.find("spacing")),
               "a logarithmic range has both ends of one sign, and none at zero");
  else
    return Ends{*from, *to};
  return std::nullopt;
}

/// `from`, `to`, `count`, `spacing`.
void read_range(input::Section& table, Parameter& parameter) {
  input::Faults& faults = table.faults();
  const toml::node* node = table.require("count");
  const auto count = node != nullptr ? input::read_whole_number(*node, "count", count_range, faults)
                                     : std::optional<unsigned int>();
  const auto ends = read_ends(table, parameter);
  if (!ends || !count) return;
  parameter.values = spaced(ends->from, ends->to, *count, parameter.is_logarithmic);
  for (const double v : parameter.values)
    if (parameter.number.is_whole_number() && v != std::floor(v)) {
      faults.add(input::place(*node),
                 fmt::format("'{}' is a whole number, but the range has {:g}: list its 'values'",
                             parameter.number.path, v));
      return;
    }
}

/// `values`.
void read_values(const toml::node& node, Parameter& parameter, input::Faults& faults) {
  const toml::array* list = node.as_array();
  if (list == nullptr || list->empty() || list->size() > most_points) {
    faults.add(input::place(node),
               fmt::format("'values' must be a list of 1 to {} values, found {}", most_points,
                           input::describe(node)));
    return;
  }
  parameter.unit = unit_of(list->front());
  for (const toml::node& element : *list) {
    const auto value = read_number(element, "values", parameter.number, faults);
    if (!value) continue;
    if (std::find(parameter.values.begin(), parameter.values.end(), *value) !=
        parameter.values.end())
      faults.add(input::place(element), "the value is listed twice");
    parameter.values.push_back(*value);
  }
}

/// The bounds of a parameter that is searched, and where the search starts: `start`, or the case's
/// own value, brought within the bounds.
void read_bounds(input::Section& table, Parameter& parameter, Reading& reading) {
  input::Faults& faults = table.faults();
  for (const std::string_view key : {"values", "count"})
    if (const toml::node* node = table.find(key))
      faults.add(input::place(*node),
                 fmt::format("with [optimise] a parameter has its bounds, 'from' and 'to', and no "
                             "'{}'",
                             key));
  if (parameter.number.is_whole_number())
    faults.add(table.where(), fmt::format("'{}' is a whole number: list its values in a study of "
                                          "its own",
                                          parameter.number.path));
  const auto ends = read_ends(table, parameter);
  if (!ends) return;
  if (ends->from > ends->to)
    return faults.add(input::place(*table.find("from")), "the bound 'from' must be below 'to'");
  parameter.values = {ends->from, ends->to};
  const input::Case nominal = with_settings(reading.base, reading.study.fixed);
  double start = std::clamp(parameter.number.number(nominal), ends->from, ends->to);
  if (const toml::node* node = table.find("start")) {
    start = read_number(*node, "start", parameter.number, faults).value_or(start);
    if (start < ends->from || start > ends->to)
      faults.add(input::place(*node), "'start' must lie between 'from' and 'to'");
  }
  reading.study.optimisation->start.push_back(start);
}

/// A parameter with its values, or with its bounds if the study optimises.
void read_parameter(input::Section& table, Reading& reading) {
  input::Faults& faults = table.faults();
  const std::size_t before = faults.size();
  const bool is_searched = reading.study.optimisation.has_value();
  std::optional<Parameter> parameter = read_name(table, reading);
  for (const std::string_view key : {"from", "to", "count", "spacing"}) table.find(key);
  if (is_searched) table.find("start");
  const toml::node* values = table.find("values");
  const bool has_range = table.table()->contains("from") || table.table()->contains("to");
  if (!parameter) {
    // The values that an unknown parameter may have cannot be told.
  } else if (is_searched) {
    read_bounds(table, *parameter, reading);
  } else if (values != nullptr) {
    if (has_range)
      faults.add(input::place(*values), "'values' contradicts 'from' and 'to': give one of them");
    read_values(*values, *parameter, faults);
  } else if (has_range) {
    read_range(table, *parameter);
  } else {
    faults.add(table.where(), "[[parameter]] needs 'values', or 'from', 'to' and 'count'");
  }
  if (!parameter || faults.size() != before) return;
  if (!parameter->unit.empty())
    parameter->unit_size =
        input::parse_quantity("1 " + parameter->unit, parameter->number.quantity);
  Study& study = reading.study;
  (is_searched ? study.optimisation->parameters : study.parameters).push_back(*parameter);
}

}  // namespace

const CaseNumber* find_number(const Reading& reading, const std::string& path, input::Place where,
                              input::Faults& faults) {
  std::vector<std::string_view> paths;
  for (const CaseNumber& number : reading.numbers) {
    paths.push_back(number.path);
    if (number.path != path) continue;
    if (const std::string model = idle_model(reading.study, path); !model.empty())
      faults.add(where,
                 fmt::format("'{}' has no effect: no pair of the study runs {}", path, model));
    return &number;
  }
  std::string advice = support::did_you_mean(path, paths);
  if (advice.empty()) advice = fmt::format(" (there are {})", fmt::join(paths, ", "));
  faults.add(where, fmt::format("the case has no number {}{}", input::in_quotes(path), advice));
  return nullptr;
}

std::optional<double> read_number(const toml::node& node, std::string_view name,
                                  const CaseNumber& number, input::Faults& faults) {
  if (!number.is_whole_number())
    return input::read_value(node, name, number.quantity, number.range, faults);
  const auto whole = input::read_whole_number(node, name, number.range, faults);
  return whole ? std::optional<double>(*whole) : std::nullopt;
}

void check_contradiction(const Study& study, const CaseNumber& number, input::Place where,
                         input::Faults& faults) {
  const auto refuse = [&](const CaseNumber& other) {
    if (other.sets == number.sets)
      faults.add(where, other.path == number.path
                            ? fmt::format("'{}' is set twice", number.path)
                            : fmt::format("'{}' contradicts '{}': set one of them", number.path,
                                          other.path));
  };
  for (const Setting& setting : study.fixed) refuse(setting.number);
  for (const Parameter& parameter : study.parameters) refuse(parameter.number);
  if (study.optimisation)
    for (const Parameter& parameter : study.optimisation->parameters) refuse(parameter.number);
}

std::string unit_of(const toml::node& node) {
  const auto* text = node.as_string();
  if (text == nullptr) return {};
  std::string_view rest = text->get();
  const auto skip = [&](std::string_view characters) {
    rest.remove_prefix(std::min(rest.find_first_not_of(characters), rest.size()));
  };
  skip(" +-0123456789._");
  if (rest.size() > 1 && (rest[0] == 'e' || rest[0] == 'E') &&
      std::string_view("+-0123456789").find(rest[1]) != std::string_view::npos) {
    rest.remove_prefix(1);
    skip("+-0123456789");
  }
  skip(" ");
  return std::string(rest);
}

void read_parameters(input::Section& root, Reading& reading) {
  input::Faults& faults = root.faults();
  const bool is_searched = reading.study.optimisation.has_value();
  const toml::node* node = root.find("parameter");
  const toml::array* list = node != nullptr ? node->as_array() : nullptr;
  if (list == nullptr || list->empty())
    return faults.add(node != nullptr ? input::place(*node) : input::Place{},
                      is_searched
                          ? "an optimisation searches one parameter or more: write [[parameter]] "
                            "with 'path', 'from' and 'to'"
                          : "a study varies one parameter or more: write [[parameter]] with 'path' "
                            "and 'values', or [tolerances]");
  root.tables("parameter", 1, list->size(),
              [&](input::Section& table) { read_parameter(table, reading); });
  if (is_searched && reading.study.optimisation->parameters.size() > most_searched)
    faults.add(root.where(),
               fmt::format("an optimisation searches at most {} parameters", most_searched));
}

}  // namespace ciliaval::compare::study::reader
