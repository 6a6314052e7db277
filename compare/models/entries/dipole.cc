// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/models/entries/values.h"

namespace ciliaval::compare::models::entries {

input::FieldEntry dipole() {
  using analytic::rod::DipoleOptions;
  return {
      .id = "dipole",
      .description = "each magnetic segment as one dipole at its centroid",
      .make = input::make<analytic::rod::DipoleField, DipoleOptions>,
      .options = {input::choice(&DipoleOptions::push_forward, "push_forward", push_forwards(),
                                rod_push_forward)},
      .takes_sections = true,
      .budget_stages =
          [](const input::ModelOptions&) {
            return std::vector<input::BudgetStage>{
                {.physics = "the whole magnet as one dipole at its centroid", .is_beside = true}};
          },
  };
}

}  // namespace ciliaval::compare::models::entries
