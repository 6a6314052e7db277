// SPDX-License-Identifier: LGPL-2.1-or-later
// What a study file says of an optimisation.
#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "compare/study/reader/reading.h"

namespace ciliaval::compare::study::reader {
namespace {

constexpr std::size_t most_searched = 8;
constexpr Range evaluations_range{0, 1e6, false, "a search must end"};
constexpr Range starts_range{0, 1000, false, "a search must end"};

/// [optimise.at_least] or [optimise.at_most].
void read_limits(input::Section& parent, std::string_view key, bool is_lower, Reading& reading) {
  static constexpr Range positive{0, 1e12, true, "magnitudes are limited, and they are positive"};
  input::Section table = parent.section(key);
  if (!table.exists()) return;
  std::vector<Limit>& limits = reading.study.optimisation->limits;
  for (const Output output : all_outputs()) {
    const toml::node* node = table.find(id(output));
    if (node == nullptr || reading.numbers.empty()) continue;
    const auto value =
        input::read_value(*node, id(output), quantity_of(output, reading.base.load_path.front()),
                          positive, table.faults());
    if (!value) continue;
    for (const Limit& other : limits)
      if (other.output == output && other.value >= *value)
        table.faults().add(input::place(*node),
                           fmt::format("'{}' cannot be at least {:g} and at most {:g}", id(output),
                                       other.value, *value));
    limits.push_back({output, is_lower, *value});
  }
  table.finish();
}

/// Where the search starts: `start`, or the case's own value, brought within the bounds.
void read_start(input::Section& table, const input::Case& nominal, const Parameter& parameter,
                Optimisation& optimisation) {
  const double from = parameter.values.front();
  const double to = parameter.values.back();
  double start = std::clamp(parameter.number.get(nominal), from, to);
  if (const toml::node* node = table.find("start")) {
    const auto value = read_number(*node, "start", parameter.number, table.faults());
    if (value && (*value < from || *value > to))
      table.faults().add(input::place(*node), "'start' must lie between 'from' and 'to'");
    start = value.value_or(start);
  }
  optimisation.start.push_back(start);
}

void read_searched_parameter(input::Section& table, const input::Case& nominal, Reading& reading) {
  input::Faults& faults = table.faults();
  const std::size_t before = faults.size();
  std::optional<Parameter> parameter = read_parameter_name(table, reading);
  for (const std::string_view key : {"values", "count"})
    if (const toml::node* node = table.find(key))
      faults.add(input::place(*node),
                 fmt::format("with [optimise] a parameter has its bounds, 'from' and 'to', and no "
                             "'{}'",
                             key));
  if (!parameter) {  // which values it may have cannot be told
    for (const std::string_view key : {"from", "to", "spacing", "start"}) table.find(key);
    return table.finish();
  }
  if (parameter->number.is_whole)
    faults.add(table.where(), fmt::format("'{}' is a whole number: list its values in a study of "
                                          "its own",
                                          parameter->number.path));
  const auto ends = read_ends(table, *parameter);
  if (ends && ends->from > ends->to)
    faults.add(input::place(*table.find("from")), "the bound 'from' must be below 'to'");
  if (ends && faults.size() == before) {
    parameter->values = {ends->from, ends->to};
    read_start(table, nominal, *parameter, *reading.study.optimisation);
  }
  table.find("start");
  table.finish();
  if (faults.size() == before)
    add_parameter(std::move(*parameter), reading.study.optimisation->parameters);
}

}  // namespace

void read_optimisation(input::Section& table, Reading& reading) {
  input::Faults& faults = table.faults();
  Optimisation& optimisation = reading.study.optimisation.emplace();
  // Of the resolution the smallest would be wanted, which is the largest sensitivity.
  std::vector<std::string_view> goals;
  for (const Output output : all_outputs())
    if (output != Output::resolution) goals.push_back(id(output));
  if (const toml::node* node = table.require("maximise"))
    if (const auto goal = input::read_choice(*node, "maximise", goals, {}, faults))
      for (const Output output : all_outputs())
        if (id(output) == *goal) optimisation.goal = output;
  if (const toml::node* node = table.find("global_evaluations"))
    optimisation.global_evaluations =
        input::read_whole_number(*node, "global_evaluations", evaluations_range, faults)
            .value_or(optimisation.global_evaluations);
  if (const toml::node* node = table.find("starts"))
    optimisation.starts = input::read_whole_number(*node, "starts", starts_range, faults)
                              .value_or(optimisation.starts);
  read_limits(table, "at_least", true, reading);
  read_limits(table, "at_most", false, reading);
  table.finish();
}

void read_searched_parameters(input::Section& root, Reading& reading) {
  const input::Case nominal = with_settings(reading.base, reading.study.fixed);
  for_parameters(root,
                 "an optimisation searches one parameter or more: write [[parameter]] with "
                 "'path', 'from' and 'to'",
                 [&](input::Section& table) { read_searched_parameter(table, nominal, reading); });
  if (reading.study.optimisation->parameters.size() > most_searched)
    root.faults().add(root.where(),
                      fmt::format("an optimisation searches at most {} parameters", most_searched));
}

}  // namespace ciliaval::compare::study::reader
