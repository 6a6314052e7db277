// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "compare/models/run.h"
#include "compare/results/observation.h"

namespace ciliaval::compare::regression {

/// End of a model's step, `steps/1/mechanics/solid/status`: "converged", "slipped_off",
/// "pulled_in", "failed"; of a field "computed" or "failed".
struct Outcome {
  std::string id;
  std::string value;
};

/// The models that a quantity or an outcome is of, as its id says: the one behind `mechanics` or
/// `energy_balance`, the two behind `fields`.
std::vector<std::string> models_of(std::string_view id);

struct Measurements {
  std::vector<results::Observation> quantities;
  std::vector<Outcome> outcomes;
};

/// Numbers of a run that a baseline keeps: all but times and iterations. A sweep keeps 27 of its
/// steps, evenly chosen, with the state of the contact, and the number of jumps of the whole path.
/// The works are left out: the division of a jump's energy between friction and loss depends on the
/// steps of its damped motion (1e-3 of it), far more than on rounding.
Measurements measurements(const models::CaseResult& result);

}  // namespace ciliaval::compare::regression
