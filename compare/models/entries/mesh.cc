// SPDX-License-Identifier: LGPL-2.1-or-later
#include "analytic/body/mesh_field.h"
#include "compare/models/entries/values.h"

namespace ciliaval::compare::models::entries {

input::FieldEntry mesh() {
  using analytic::body::MeshOptions;
  return {
      .id = "mesh",
      .description = "a solid's own deformed magnet (needs its body: `solid`, `calculix`)",
      .make = input::make<analytic::body::MeshField, MeshOptions>,
      .options = {input::choice(&MeshOptions::push_forward, "push_forward", push_forwards(),
                                "`F`: m = F·M/J (ideal hard magnet); `R`: m = R·M (rigid "
                                "sections)."),
                  input::option(&MeshOptions::tolerance, "tolerance", tolerance_range,
                                "Relative to the field.")},
      .refinements = {tolerances({1e-2, 1e-4, 1e-6, 1e-8})},
      .takes_sections = true,
      .has_body = true,
      .accuracy = 1e-8,
      .budget_stages =
          [](const input::ModelOptions&) {
            using analytic::sources::PushForward;
            return std::vector<input::BudgetStage>{
                {.physics = "the solid's own sections, warped and stretched, with rotated moments",
                 .variant = "R",
                 .set = set(&MeshOptions::push_forward, PushForward::R)},
                {.physics = "moments carried along by F, in place of the rotation R",
                 .variant = "F",
                 .set = set(&MeshOptions::push_forward, PushForward::F)}};
          },
  };
}

}  // namespace ciliaval::compare::models::entries
