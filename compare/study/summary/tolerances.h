// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "compare/study/sweep.h"

namespace ciliaval::compare::study::summary {

/// What the tolerances do to one output y of one pair at the case with its fixed numbers.
struct Propagation {
  /// By one number p with the standard deviation σ_p.
  struct Share {
    std::optional<double> slope;  ///< ∂y/∂p = (4 D(h) − D(2h))/3, central differences, h = σ_p/4
    double error = 0;             ///< |∂y/∂p − D(h)|: its truncation, seen from below
    std::optional<double> spread;  ///< |∂y/∂p| σ_p
  };
  std::optional<double> nominal;  ///< y
  std::vector<Share> shares;      ///< in the order of the study's tolerances
  std::optional<double> deviation;  ///< σ_y = √Σ (∂y/∂p σ_p)²: first order, independent numbers;
                                    ///< none if a slope is missing
};
Propagation propagate(const StudyResult& result, std::size_t pair, std::size_t output);

/// For a terminal: for each pair a table of the spreads and their sum; empty without tolerances.
std::string tolerance_text(const StudyResult& result);

/// A line for each pair, output and number: path, deviation, slope, its error, spread; SI units.
std::string tolerance_csv(const StudyResult& result);

/// {"numbers": [{"path", "nominal", "deviation", "unit"}], "pairs": {PAIR: {OUTPUT: {"nominal",
/// "deviation", "slopes": […], "errors": […]}}}}, SI units.
nlohmann::ordered_json tolerance_json(const StudyResult& result);

}  // namespace ciliaval::compare::study::summary
