// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string>
#include <vector>

#include "compare/regression/check.h"

namespace ciliaval::compare::regression {

/// A line for each case, below it one for each failure, and a line that sums up.
std::string report_text(const std::vector<CheckReport>& reports);

/// {"schema": 1, "passed": …, "cases": [{"case", "passed", "compared", "failures", "left_out",
/// "findings": [{"id", "against", "passed", "message", "unit", "measured", "expected", "limit",
/// "uncertainty"}]}]}; an unknown or infinite value is null.
std::string report_json(const std::vector<CheckReport>& reports);

/// JUnit's XML as continuous integration reads it: a test suite for each case, a test case for each
/// finding with measured value, expected value, limit and uncertainty as its properties.
std::string report_junit(const std::vector<CheckReport>& reports);

}  // namespace ciliaval::compare::regression
