// SPDX-License-Identifier: LGPL-2.1-or-later
// What the parts of the study reader share.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compare/input/case_toml.h"
#include "compare/study/study.h"

namespace ciliaval::compare::study::reader {

/// The points of a study, at most.
inline constexpr std::size_t most_points = 1'000'000;

/// What is read of a study while its faults are gathered.
struct Reading {
  Study study;
  input::Case base;  ///< the case file's
  std::vector<CaseNumber> numbers;
};

/// The number of this path, or a fault.
const CaseNumber* find_number(const Reading& reading, const std::string& path, input::Place where,
                              input::Faults& faults);

/// A value of a number of the case, or a fault.
std::optional<double> read_number(const toml::node& node, std::string_view name,
                                  const CaseNumber& number, input::Faults& faults);

/// Adds a fault if something else sets the same already.
void check_contradiction(const Study& study, const CaseNumber& number, input::Place where,
                         input::Faults& faults);

/// The unit of a quantity that has been read: what follows the number.
std::string unit_of(const toml::node& node);

/// `path` and `name` of a [[parameter]]; none, with a fault, if there is no such number.
std::optional<Parameter> read_parameter_name(input::Section& table, Reading& reading);

/// The two ends of a range.
struct Ends {
  double from = 0;
  double to = 0;
};
/// `from`, `to` and `spacing` of a [[parameter]], whose unit and spacing are set; none if there is
/// a fault.
std::optional<Ends> read_ends(input::Section& table, Parameter& parameter);

/// Adds the parameter with the size of its unit.
void add_parameter(Parameter parameter, std::vector<Parameter>& all);

/// Each table [[parameter]]; a fault, with the advice, if there is none.
void for_parameters(input::Section& root, std::string_view advice,
                    const std::function<void(input::Section& table)>& read);

/// [[parameter]] of a study that varies them.
void read_parameters(input::Section& root, Reading& reading);

/// [optimise]: the goal, the limits and the search's knobs. The case has been read.
void read_optimisation(input::Section& table, Reading& reading);

/// [[parameter]] of a study that optimises: their bounds and where the search starts.
void read_searched_parameters(input::Section& root, Reading& reading);

}  // namespace ciliaval::compare::study::reader
