// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compare/input/case.h"
#include "compare/study/case_number.h"

namespace ciliaval::compare::validation {

/// An input of the case that is not known exactly.
struct Input {
  study::CaseNumber number;
  double uncertainty = 0;  ///< standard, SI; of a relative one the part of the value
  bool is_relative = false;
  bool at_each_step = false;  ///< of load and environment: shifted at each step from its own value
  /// Of a range: the middle, from which is shifted in place of the case's own value.
  std::optional<double> middle{};
  std::string source;
  /// The shift for central differences, in standard uncertainties: a tenth, or what the number's
  /// range leaves; of a stated range to its ends.
  double step = 0.1;
};

/// The tables [[input_uncertainty]]. Throws InputError with each fault and its place: a number that
/// the case does not have, that is an option of a model or that another row sets, a wrong unit, an
/// uncertainty that is not above zero, a value at the end of its range, or outside the one stated.
std::vector<Input> read_inputs(const input::Case& c);

/// The case with an input shifted by so many of its standard uncertainties, and without external
/// models. Along a path of loads or fields each step is shifted from its own value. A section that
/// is loaded at a segment's end stays there.
input::Case shifted(const input::Case& c, const Input& input, double deviations);

}  // namespace ciliaval::compare::validation
