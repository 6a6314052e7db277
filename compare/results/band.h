// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <array>
#include <optional>

#include "compare/models/run.h"

/// The ± of a number: numerical error, what a model leaves out, and what the inputs make
/// (docs/theory/band.md).
namespace ciliaval::compare::results {

/// Standard uncertainties count so many times in a band of 95 %.
inline constexpr double two_sided_95 = 1.959963984540054;

/// The parts of a number's ±, in its unit; none where one is not known.
struct Band {
  std::optional<double> numerical;  ///< bound
  std::optional<double> model;      ///< bound: what the model leaves out
  std::optional<double> input;      ///< standard: of [[input_uncertainty]]; 0 if none is stated
  std::optional<double> total;      ///< about 95 %

  /// The total, or its parts that are known, of which the numerical one is.
  std::optional<double> known() const {
    if (total || !numerical) return total;
    return *numerical + two_sided_95 * input.value_or(0);
  }
};

enum class ShapeQuantity { tip, tip_angle, applied_force, slip_off };
/// Names of the quantities in that order, as summary.json has them.
inline constexpr std::array<const char*, 4> shape_quantities{"tip", "tip_angle", "applied_force",
                                                             "slip_off"};
Band shape_band(const models::MechanicsRun& run, std::size_t step, ShapeQuantity quantity);

/// Bands of B or ΔB, at each sensor by components, T.
struct FieldBands {
  models::AtSensors model;
  models::AtSensors input;
  models::AtSensors total;
};
FieldBands field_bands(const models::CaseResult& result, const models::FieldRun& run,
                       std::size_t step, bool change);

}  // namespace ciliaval::compare::results
