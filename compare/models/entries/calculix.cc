// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/input/case.h"
#include "compare/models/entries/values.h"
#include "fem/calculix/calculix_model.h"

namespace ciliaval::compare::models::entries {
namespace {

using fem::calculix::CalculixOptions;

input::Refinement meshes() {
  input::Refinement result = solid_meshes();
  result.also = [](input::ModelOptions& o) { o.of<CalculixOptions>().error_estimate = false; };
  return result;
}

}  // namespace

input::MechanicsEntry calculix() {
  using File = input::Option::File;
  return {
      .id = "calculix",
      .description = "CalculiX's 3D solid, another program (needs `ccx`; loads section and dead)",
      .make = input::make<fem::calculix::Calculix, CalculixOptions>,
      .options = {input::option(&CalculixOptions::refinement, "refinement", solid_mesh_range,
                                "Mesh: that of the solid with this refinement."),
                  input::flag(&CalculixOptions::error_estimate, "error_estimate",
                              "Solve the next coarser mesh too, for `tip_uncertainty`."),
                  input::option(
                      &CalculixOptions::first_increment, "first_increment",
                      {1e-6, 1, false, "it is a part of the load"},
                      "Part of the load that CalculiX tries first; it goes on by itself."),
                  input::option(&CalculixOptions::threads, "threads",
                                {1, 1024, false, "a machine has no more"}, "Threads of CalculiX."),
                  input::option(&CalculixOptions::time_limit, "time_limit", quantity::time,
                                {1e-3, 1e7, false, unit_slip},
                                "Of one run of CalculiX, of which each step takes one, or two with "
                                "`error_estimate`; then it is ended, and the step has failed."),
                  input::file(&CalculixOptions::program, "program", File::program,
                              "The program: a name that is looked for in PATH, or with a slash a "
                              "file, beside the case file unless absolute."),
                  input::file(
                      &CalculixOptions::keep, "keep", File::folder,
                      "Folder, beside the case file unless absolute, in which CalculiX's files "
                      "stay, one subfolder for each run. Empty: they are removed.")},
      .refinements = {meshes()},
      .loads = {&SectionLoad::type(), &DeadLoad::type()},
      .takes_sections = true,
      .has_body = true,
      .is_collective = true,
      .is_slow = true,
      .accuracy = 1e-5,  // it prints seven digits, and has its own tolerances for equilibrium
      .check =
          [](const input::CaseCheck& check) {
            if (!check.problem.options.of<CalculixOptions>().program.has_filename())
              check.report("models.calculix.program",
                           "'program' must name a program, such as \"ccx\"");
          },
  };
}

}  // namespace ciliaval::compare::models::entries
