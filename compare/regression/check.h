// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "compare/input/case.h"
#include "compare/models/run.h"
#include "compare/regression/baseline.h"

namespace ciliaval::compare::regression {

/// One thing that was checked.
struct Finding {
  bool passed = false;
  std::string id;       ///< of the quantity or outcome, or "case", "comparison", …
  std::string against;  ///< "baseline", or the label of the reference
  std::string message;  ///< of a failure
  std::string unit;
  std::optional<double> measured;     ///< in `unit`
  std::optional<double> expected;     ///< in `unit`
  std::optional<double> limit;        ///< of |measured − expected|, in `unit`
  std::optional<double> uncertainty;  ///< the model's own estimate, in `unit`
};

struct CheckReport {
  std::string case_name;
  std::vector<Finding> findings;
  std::size_t left_out = 0;   ///< entries of the baseline whose models were not run
  bool model_failed = false;  ///< a model did not converge that did so in the baseline
  double seconds = 0;         ///< wall time of the models
  std::size_t failures() const;
  /// Numbers that were held against numbers.
  std::size_t compared() const;
  bool passed() const { return failures() == 0 && compared() > 0; }
};

/// Holds a run of a case against its baseline. Each of these is a failure that names what is wrong:
/// another case's baseline or one of another version of the case; an entry of the baseline that was
/// not computed, or a result that has no entry; another unit or status; a number that is not
/// finite, or differs by more than its tolerance from the accepted value or from the reference; a
/// tolerance wider than its models' accuracy class, a reference's wider than a tenth of its
/// group; no number at all. `asked` is the case as the file states it. Models of it that `result`
/// leaves out on purpose are in `left_out`; all others must be there.
CheckReport check(const input::Case& asked, const models::CaseResult& result,
                  const Baseline& baseline, const std::vector<std::string>& left_out = {});

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
