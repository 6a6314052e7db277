// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/models/entries/values.h"

namespace ciliaval::compare::models::entries {
namespace {

using analytic::rod::LineOptions;
using analytic::rod::Method;

/// The moments R·M have no closed form and are integrated.
bool is_line_integrated(const input::ModelOptions& all) {
  const auto& o = all.of<LineOptions>();
  return o.method == Method::quadrature ||
         (o.method == Method::closed_form && o.push_forward == analytic::sources::PushForward::R);
}

}  // namespace

input::FieldEntry line() {
  const input::Option elements = only_with(
      &LineOptions::method, Method::uniform, "method = \"uniform\"",
      input::option(&LineOptions::elements, "elements", {1, 1e6, false, "more take gigabytes"},
                    "`uniform`: n dipoles in each magnetic segment."));
  input::Refinement sums =
      pieces({16, 32, 64, 128, 256, 512, 1024, 2048, 4096}, "length of the pieces, in segments");
  sums.applies = elements.condition;
  input::Refinement integrals = tolerances({1e-2, 1e-4, 1e-6, 1e-8, 1e-10});
  integrals.applies = is_line_integrated;
  return {
      .id = "line",
      .description = "dipoles along the centreline (Eq. 5-7, the paper's single-dipole model)",
      .make = input::make<analytic::rod::LineField, LineOptions>,
      .options = {input::choice(&LineOptions::push_forward, "push_forward", push_forwards(),
                                rod_push_forward),
                  input::choice(&LineOptions::method, "method", methods(),
                                "`closed_form`: two poles; `quadrature`: its check; `uniform`: "
                                "the paper's sum over slices of equal height."),
                  input::option(&LineOptions::tolerance, "tolerance", tolerance_range,
                                "Relative to the field, of the quadrature."),
                  elements},
      .refinements = {sums, integrals},
      .takes_sections = true,
      .budget_stages =
          [](const input::ModelOptions&) {
            return std::vector<input::BudgetStage>{
                {.physics = "dipoles along the centreline",
                 .set = set(&LineOptions::push_forward, analytic::sources::PushForward::F)}};
          },
      .hasten = set(&LineOptions::method, Method::closed_form),
  };
}

}  // namespace ciliaval::compare::models::entries
