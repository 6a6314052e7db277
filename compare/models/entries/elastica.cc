// SPDX-License-Identifier: LGPL-2.1-or-later
#include "analytic/elastica/elastica.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "compare/input/case.h"
#include "compare/models/entries/joints.h"
#include "compare/models/entries/values.h"
#include "problem/surroundings/plane.h"

namespace ciliaval::compare::models::entries {
namespace {

using analytic::elastica::CiliumEnd;
using analytic::elastica::Elastica;
using analytic::elastica::ElasticaOptions;

bool has_environment(const Load& load) {
  return !surroundings::is_empty(load.environment());
}

/// The form `height` takes the paper's loads, without an environment.
void check_height_form(const input::CaseCheck& check) {
  constexpr const char* option = "models.elastica.form";
  const LoadPath& path = check.problem.load_path;
  const Load& load = path.front();
  if (!load.is<ContactLoad>() && !load.is<FlowLoad>() && !load.is<ProbeLoad>())
    check.report(option,
                 fmt::format("the elastica's form 'height' (Eq. 1-4) takes the load types "
                             "'contact', 'flow' and 'probe', not '{}': use the form 'arclength'",
                             type(load)));
  else if (std::ranges::any_of(path, has_environment))
    check.report(option,
                 "the elastica's form 'height' (Eq. 1-4) takes no [environment]: use the form "
                 "'arclength'");
}

/// The elastica bends in the plane of the load, in which the environment must lie.
void check_plane(const input::CaseCheck& check) {
  constexpr double degree = std::numbers::pi / 180;
  for (const Load& load : check.problem.load_path) {
    const bool is_planar = surroundings::lies_in_plane(load.environment(), direction(load));
    if (surroundings::lies_in_plane(load.environment(), check.problem.cilium, direction(load)))
      continue;
    const auto at = std::ranges::find(check.problem.mechanics, "elastica");
    return check.report(
        fmt::format("models.mechanics[{}]", at - check.problem.mechanics.begin()),
        fmt::format("the elastica bends in the plane of the load, along the azimuth {:g} deg, and "
                    "the {} out of it: change the azimuth, or use 'beam' or 'solid'",
                    azimuth(load) / degree,
                    is_planar ? "magnetisation in the field points" : "environment points"));
  }
}

/// It is integrated from the tip, whose place it does not know: a field that depends on the place
/// does not fit.
void refuse_magnets(const input::CaseCheck& check) {
  const auto at = std::ranges::find(check.problem.mechanics, "elastica");
  check.report(fmt::format("models.mechanics[{}]", at - check.problem.mechanics.begin()),
               "the elastica takes no [[environment.magnet]]: use 'beam' or 'solid'");
}

/// The equations of the corrected joints are those of the arc-length form without an environment.
void check_corrected(const input::CaseCheck& check) {
  const auto& options = check.problem.options.of<ElasticaOptions>();
  check_joints(check, "elastica", options.joints);
  if (options.joints == joints::Correction::none) return;
  constexpr const char* option = "models.elastica.joints";
  if (options.form == ElasticaOptions::Form::height)
    check.report(option,
                 "the elastica's form 'height' (Eq. 1-4) takes no corrected joints: use the form "
                 "'arclength'");
  else if (std::ranges::any_of(check.problem.load_path, has_environment))
    check.report(option,
                 "the elastica takes no corrected joints in an [environment]: use 'beam', or "
                 "joints = 'none'");
}

/// The equations of a touch are those of the plain rod without an environment.
void check_touch(const input::CaseCheck& check) {
  const auto& options = check.problem.options.of<ElasticaOptions>();
  if (check.problem.load_path.front().touch().is_plain()) return;
  if (std::ranges::any_of(check.problem.load_path, has_environment) ||
      options.form == ElasticaOptions::Form::height || options.joints != joints::Correction::none)
    check.report("load.touch",
                 "the elastica takes a touch in its form 'arclength' with joints = 'none', without "
                 "an [environment]: leave out 'elastica', or change that");
}

void check_elastica(const input::CaseCheck& check) {
  if (!check.is_asked_for || !check.load_is_right) return;
  check_touch(check);
  if (!check.problem.load_path.front().environment().magnets.empty()) return refuse_magnets(check);
  check_plane(check);
  check_rim(check);
  if (check.problem.options.of<ElasticaOptions>().form == ElasticaOptions::Form::height)
    check_height_form(check);
  check_corrected(check);
}

}  // namespace

input::MechanicsEntry elastica() {
  return {
      .id = "elastica",
      .description = "the paper's inextensible, shear-rigid elastica (Eq. 1-4)",
      .make = input::make<Elastica, ElasticaOptions>,
      .options = {input::choice(&ElasticaOptions::form, "form",
                                {{"arclength", ElasticaOptions::Form::arclength},
                                 {"height", ElasticaOptions::Form::height}},
                                "`arclength`: dθ/dS = M/(EI), any load; `height`: the paper's "
                                "quadrature in z (Eq. 1-4), `contact`, `flow` and `probe` only."),
                  input::choice(&ElasticaOptions::tip, "tip",
                                {{"rim", CiliumEnd::disc}, {"point", CiliumEnd::point}},
                                "`sweep`: `rim`, the end is a disc with a rim and a mantle that "
                                "touch; `point`, the end of the centreline does."),
                  input::choice(&ElasticaOptions::joints, "joints", corrections(), joints_doc),
                  input::option(&ElasticaOptions::tolerance, "tolerance", tolerance_range,
                                "Relative, of position over length and of angle.")},
      .refinements = {tolerances({1e-4, 1e-6, 1e-8, 1e-10, 1e-12})},
      .takes_environment = true,
      .takes_touch = true,
      .takes_sections = true,
      .check = check_elastica,
      .budget_stages =
          [](const input::ModelOptions&) {
            return std::vector<input::BudgetStage>{
                {.physics = "elastica",
                 .set = set(&ElasticaOptions::joints, joints::Correction::none)}};
          },
      .correct = set(&ElasticaOptions::joints, joints::Correction::corrected),
      .hasten = set(&ElasticaOptions::error_estimate, false),
      .skip_range = set(&ElasticaOptions::slip_off, false),
  };
}

}  // namespace ciliaval::compare::models::entries
