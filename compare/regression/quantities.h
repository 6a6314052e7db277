// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compare/models/run.h"

namespace ciliaval::compare::regression {

/// One number that a case's models have computed. Its id is its place in summary.json:
/// `steps/1/mechanics/elastica/tip/x`, `steps/1/fields/elastica/line/dB/0/y` (sensor 0).
struct Measurement {
  std::string id;
  std::string mechanics;  ///< the mechanics model that it rests on
  std::string field;      ///< the field model; empty for a number of the mechanics model itself
  std::string unit;       ///< "m", "rad", "N", "T"
  double value = 0;       ///< in `unit`, may be NaN
  double scale = 0;  ///< the size that its rounding is a part of: the length of the cilium, 1 rad,
                     ///< the largest |B| of the pair at this sensor, the largest force
  double group = 0;  ///< the largest of its group, which a tolerance guards: of the model's
                     ///< deflections or angles, of the pair's |ΔB| at this sensor; else `scale`
  std::optional<double> uncertainty;  ///< the model's own estimate, in `unit`

  /// Size of the group; of one that vanishes a thousandth of `scale`.
  double size() const { return std::max(group, 1e-3 * scale); }
};

/// How a model ended a step: `steps/1/mechanics/solid/status`: "converged", "slipped_off",
/// "pulled_in", "failed"; of a field "computed" or "failed".
struct Outcome {
  std::string id;
  std::string value;
};

/// The models that a quantity or an outcome is of, as its id says: the one behind `mechanics` or
/// `energy_balance`, the two behind `fields`.
std::vector<std::string> models_of(std::string_view id);

struct Measurements {
  std::vector<Measurement> quantities;
  std::vector<Outcome> outcomes;
};

/// Everything that a run of a case has computed, but for times and iterations: of each mechanics
/// model at each step the status and, where it converged, the positions at S = L/4, L/2, 3L/4 and
/// L, the tip's angle, applied force, contact arc length and tip uncertainty, or the slip-off; of
/// each pair B and ΔB at each sensor, B of the straight cilium too. No means, in which errors could
/// cancel. Of a sweep 27 of its steps, evenly chosen, with state and forces of the contact, and the
/// number of jumps of the whole path.
Measurements measurements(const models::CaseResult& result);

}  // namespace ciliaval::compare::regression
