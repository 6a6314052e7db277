// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/beam/beam.h"

#include "compare/input/case.h"
#include "compare/models/entries/joints.h"
#include "compare/models/entries/values.h"

namespace ciliaval::compare::models::entries {
namespace {

using fem::beam::BeamOptions;

std::vector<input::BudgetStage> budget_stages(const input::ModelOptions& options) {
  using joints::Correction;
  std::vector<input::BudgetStage> stages{{.physics = "shear and extension of the rod",
                                          .set = set(&BeamOptions::joints, Correction::none)}};
  if (options.of<BeamOptions>().joints == Correction::corrected)
    stages.push_back(
        {.physics = "joints as stiff as bonded sections make them", .variant = "joints corrected"});
  return stages;
}

}  // namespace

input::MechanicsEntry beam() {
  return {
      .id = "beam",
      .description =
          "geometrically exact Simo-Reissner beam FEM: bending, shear, extension, torsion",
      .make = input::make<fem::beam::Beam, BeamOptions>,
      .options = {input::option(&BeamOptions::degree, "degree",
                                {1, 20, false, "higher elements gain nothing here"},
                                "Degree of the interpolation of position and rotation."),
                  input::option(&BeamOptions::refinement, "refinement",
                                {0, 12, false, "finer beams exceed the memory of a machine"},
                                "Each step halves the elements."),
                  input::flag(&BeamOptions::shear_rigid, "shear_rigid",
                              "No shear and no extension: the elastica's assumptions."),
                  input::choice(&BeamOptions::joints, "joints", corrections(), joints_doc),
                  input::choice(
                      &BeamOptions::tip, "tip",
                      {{"rim", fem::beam::TipShape::rim}, {"point", fem::beam::TipShape::point}},
                      "What a sweeping surface touches: the end section, a disc, or the "
                      "end of the centreline."),
                  input::option(&BeamOptions::tolerance, "tolerance", tolerance_range,
                                "Of the residual and the increment, relative."),
                  input::option(&BeamOptions::max_iterations, "max_iterations", iterations_range,
                                "Newton iterations of a load increment."),
                  input::option(&BeamOptions::max_cutbacks, "max_cutbacks", cutbacks_range,
                                "Halvings of a load increment that does not converge.")},
      // 2^-degree as the size: the order is the number of bits gained per degree.
      .refinements = {halvings("refinement", {0, 1, 2, 3, 4, 5},
                               "length of the elements, in segments"),
                      halvings("degree", {2, 3, 4, 5, 6}, "2^-degree")},
      .takes_environment = true,
      .takes_touch = true,
      .takes_sections = true,
      .check =
          [](const input::CaseCheck& check) {
            check_rim(check);
            check_joints(check, "beam", check.problem.options.of<BeamOptions>().joints);
          },
      .budget_stages = budget_stages,
      .correct = set(&BeamOptions::joints, joints::Correction::corrected),
      .hasten = set(&BeamOptions::error_estimate, false),
  };
}

}  // namespace ciliaval::compare::models::entries
