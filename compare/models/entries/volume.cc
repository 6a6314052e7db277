// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/input/case.h"
#include "compare/models/entries/values.h"
#include "problem/cilium.h"

namespace ciliaval::compare::models::entries {
namespace {

using analytic::rod::Method;
using analytic::rod::VolumeOptions;

/// The stack of loops is integrated along the centreline, with closed forms too.
bool is_volume_integrated(const input::ModelOptions& all) {
  const auto& o = all.of<VolumeOptions>();
  return o.method == Method::quadrature ||
         (o.method == Method::closed_form && o.slices == VolumeOptions::Slices::stacked);
}

/// A rectangle and a tube have the closed form of their charged faces alone, and a stack of loops
/// is magnetised along its axis.
void check_volume(const input::CaseCheck& to) {
  const auto& o = to.problem.options.of<VolumeOptions>();
  if (!to.is_asked_for || !to.cilium_is_right) return;
  if (o.method == Method::closed_form && o.slices == VolumeOptions::Slices::stacked &&
      has_transverse_magnetization(to.problem.cilium))
    to.report("models.volume.slices",
              "the slices \"stacked\" have a closed form for an axial magnetisation only: take "
              "\"wedge\", or the method \"quadrature\"");
  if (to.problem.cilium.section.shape == CrossSection::Shape::circle) return;
  if (o.method != Method::closed_form)
    to.report("models.volume.method", "a rectangle or a tube has the method \"closed_form\" only");
  else if (o.slices != VolumeOptions::Slices::wedge)
    to.report("models.volume.slices", "a rectangle or a tube has the slices \"wedge\" only");
}

}  // namespace

input::FieldEntry volume() {
  using Slices = VolumeOptions::Slices;
  const input::Option elements =
      only_with(&VolumeOptions::method, Method::uniform, "method = \"uniform\"",
                input::option(&VolumeOptions::elements, "elements",
                              {1, 400, false, "more than 400^3 dipoles take too long"},
                              "`uniform`: n³ dipoles in each magnetic segment, n in z, r and φ."));
  input::Refinement sums = pieces({16, 32, 64, 128, 256}, "height of the slices, in segments");
  sums.applies = elements.condition;
  input::Refinement integrals = tolerances({1e-2, 1e-4, 1e-6, 1e-8, 1e-10});
  integrals.applies = is_volume_integrated;
  return {
      .id = "volume",
      .description = "volume of the bent rod (Eq. 8-9, the paper's multi-dipole model)",
      .make = input::make<analytic::rod::VolumeField, VolumeOptions>,
      .options = {input::choice(
                      &VolumeOptions::slices, "slices",
                      {{"wedge", Slices::wedge}, {"stacked", Slices::stacked}},
                      "`wedge`: the true volume of the bent rod; `stacked`: the paper's Eq. "
                      "8-9, flat slices of equal thickness."),
                  input::choice(
                      &VolumeOptions::method, "method", methods(),
                      "`closed_form`: charged discs or current loops; `quadrature`: their "
                      "check; `uniform`: the paper's sum over slices of equal height."),
                  input::option(&VolumeOptions::tolerance, "tolerance", tolerance_range,
                                "Relative to the field."),
                  elements},
      .refinements = {sums, integrals},
      .takes_sections = true,
      .check = check_volume,
      .budget_stages =
          [](const input::ModelOptions&) {
            return std::vector<input::BudgetStage>{
                {.physics = "the magnet's thickness, in flat slices (Eq. 8-9)",
                 .variant = "stacked",
                 .set = set(&VolumeOptions::slices, Slices::stacked)},
                {.physics = "wedges in place of flat slices: Jacobian 1 - kappa*offset",
                 .variant = "wedge",
                 .set = set(&VolumeOptions::slices, Slices::wedge)}};
          },
      .hasten = set(&VolumeOptions::method, Method::closed_form),
  };
}

}  // namespace ciliaval::compare::models::entries
