// SPDX-License-Identifier: LGPL-2.1-or-later
// Declarations that the parts of the study reader share.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compare/input/case_toml.h"
#include "compare/study/study.h"

namespace ciliaval::compare::study::reader {

/// The points of a study, at most.
inline constexpr std::size_t most_points = 1'000'000;

/// Content of a study that is read while its faults are gathered.
struct Reading {
  Study study;
  input::Case base;  ///< the case file's
  std::vector<CaseNumber> numbers;
};

/// The number of this path, or a fault, also if it is an option of a model that no pair runs.
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

/// [[parameter]]: what is varied, or searched if the study optimises.
void read_parameters(input::Section& root, Reading& reading);

}  // namespace ciliaval::compare::study::reader
