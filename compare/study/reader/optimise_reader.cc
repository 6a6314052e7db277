// SPDX-License-Identifier: LGPL-2.1-or-later
// What a study file says of an optimisation.
#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "compare/study/reader/reading.h"

namespace ciliaval::compare::study::reader {
namespace {

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

}  // namespace

void read_optimisation(input::Section& table, Reading& reading) {
  input::Faults& faults = table.faults();
  Optimisation& optimisation = reading.study.optimisation.emplace();
  // Of the resolution the smallest would be wanted, which is the largest sensitivity.
  std::vector<std::string_view> goals;
  for (const Output output : all_outputs())
    if (output != Output::resolution) goals.push_back(id(output));
  if (const toml::node* node = table.require("maximise"))
    if (const auto goal = input::read_choice(*node, "maximise", goals, faults))
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

}  // namespace ciliaval::compare::study::reader
