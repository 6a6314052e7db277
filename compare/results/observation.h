// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "compare/models/run.h"

namespace ciliaval::compare::results {

/// One number that a case's models have computed: a row of the table.
struct Observation {
  std::optional<std::size_t> step;    ///< of the load path; none: of the straight cilium
  std::string mechanics;              ///< the mechanics model that it rests on
  std::string field;                  ///< the field model; empty: of the mechanics model itself
  std::optional<std::size_t> sensor;  ///< of a field
  std::string quantity;               ///< Quantity::name, "B" or "dB"
  std::string component;              ///< "x", "y", "z", of a field "norm"; empty: a number
  std::string unit;                   ///< SI
  double value = 0;                   ///< in `unit`, may be NaN
  std::optional<double> uncertainty;  ///< the model's own estimate, in `unit`
  double scale = 0;                   ///< the size that its rounding is a part of
  double group = 0;                   ///< the largest of its group, which a tolerance guards
  bool is_estimate = false;           ///< as the quantity has them
  bool is_accepted = true;
  bool is_converged = true;
  bool is_looked_at = false;
  bool is_change = false;  ///< the difference of two values

  /// Place of the number in summary.json: `steps/1/mechanics/elastica/tip/x`,
  /// `steps/1/fields/elastica/line/dB/0/y` (sensor 0).
  std::string id() const;
  /// Size of the group; of one that vanishes a thousandth of `scale`.
  double size() const;
};

/// The steps of the table: all, of a sweep 27, evenly chosen.
std::vector<std::size_t> steps_of_table(const LoadPath& path);

/// The table: of each mechanics model at each of these steps its quantities, where they are more
/// than rounding; of each pair B and ΔB at each sensor, and the length of ΔB, B of the straight
/// cilium too. No means, in which errors could cancel.
std::vector<Observation> observations(const models::CaseResult& result);

}  // namespace ciliaval::compare::results
