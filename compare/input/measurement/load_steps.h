// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "compare/input/case_toml.h"
#include "problem/parameter.h"

namespace ciliaval::compare::input {
struct Case;
}

/// The load steps to which measured values belong.
namespace ciliaval::compare::input::measurement {

/// A number of the load at each step of a path, SI.
struct LoadNumber {
  std::string name;  ///< "force", "uniform_field x"
  Quantity quantity;
  std::vector<double> values;
};

/// The numbers that tell the steps of the case's path apart; of a path whose steps are alike all
/// that are not zero: parameters of the load's type, what the file states in their place (a flow's
/// velocity), components and amount of the uniform field, coordinates of the magnets.
std::vector<LoadNumber> load_numbers(const Case& c);

/// A column of a file whose unit is that of a load.
struct LoadColumn {
  std::string header;
  Place place;
  std::optional<std::string> unit;  ///< none: plain numbers
  std::vector<double> values;       ///< in this unit
};

/// True if the unit measures the number's quantity; a plain number has none.
bool is_unit_of(const std::optional<std::string>& unit, const LoadNumber& number);

/// The rows of a file by their loads.
struct LoadMatch {
  std::vector<std::size_t> steps;  ///< of each row
  std::string by;                  ///< "'x [mT]' (uniform_field x)"
};

/// Matches rows and load steps by value, to 1e-6 of the largest, in any order: each row has its
/// step and each step its row. Where several steps have one value, the rows stand in the steps'
/// order. Faults: none of the columns fits, or two fit otherwise than each other.
std::optional<LoadMatch> match_loads(const std::vector<LoadColumn>& columns,
                                     const std::vector<LoadNumber>& numbers,
                                     const std::vector<Place>& rows, Faults& faults);

}  // namespace ciliaval::compare::input::measurement
