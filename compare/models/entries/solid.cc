// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/solid.h"

#include <fmt/format.h>

#include <optional>

#include "compare/input/case.h"
#include "compare/models/entries/values.h"
#include "fem/solid/material/hyperelastic.h"
#include "meshes/plain_mesh.h"
#include "problem/cilium.h"
#include "problem/error.h"

namespace ciliaval::compare::models::entries {
namespace {

namespace fs = std::filesystem;
using fem::solid::SolidOptions;
using input::ErrorLimit;
using input::option;

/// The contact kernel must fit between the base and the tip.
void check_kernel(const input::CaseCheck& check) {
  const double w = check.problem.options.of<SolidOptions>().kernel_width;
  const double length = check.problem.cilium.length();
  for (std::size_t i = 0; i < check.problem.load_path.size(); ++i) {
    const std::optional<double> h = contact_height(check.problem.load_path[i]);
    if (h && *h > 0 && *h < length && !(*h - w > 0 && *h + w < length))
      check.report(fmt::format("load.height[{}]", i),
                   fmt::format("the solid's contact kernel, {:g} m below and above the contact "
                               "height {:g} m, must lie between the base and the tip at {:g} m: "
                               "move the contact or set a smaller 'kernel_width' in "
                               "[models.solid]",
                               w, *h, length));
  }
}

/// A rigid pin slides on the mantle; it moves one way.
void check_touch(const input::CaseCheck& check) {
  const LoadPath& path = check.problem.load_path;
  const TouchLaw& touch = path.front().touch();
  if (touch.law != TouchLaw::Law::coulomb || touch.at != TouchLaw::At::mantle || touch.radius <= 0)
    check.report("load.touch",
                 "the solid takes a pin with a 'radius' that slides on it: law = 'coulomb', at = "
                 "'mantle'; or leave out 'solid'");
  if (std::ranges::any_of(
          path, [](const Load& load) { return !surroundings::is_empty(load.environment()); }))
    check.report("load.touch",
                 "the solid takes a touch without an [environment]: leave out 'solid' or the "
                 "environment");
  if (std::ranges::any_of(path, [&](const Load& load) {
        return with_magnitude(load, 0) != with_magnitude(path.front(), 0);
      }))
    check.report("load.touch",
                 "the solid takes a path of one touch, with one 'height' and one 'azimuth': make a "
                 "case of each, or leave out 'solid'");
}

/// The mesh is turned to the azimuth of the load, and the magnet with it.
void check_azimuths(const input::CaseCheck& check) {
  const LoadPath& path = check.problem.load_path;
  if (!has_transverse_magnetization(check.problem.cilium)) return;
  for (std::size_t i = 1; i < path.size(); ++i)
    if (azimuth(path[i]) != azimuth(path.front()))
      return check.report(fmt::format("load.azimuth[{}]", i),
                          "the solid takes a path of one azimuth, if a segment is magnetised "
                          "across its axis: make a case of each azimuth, or leave out 'solid'");
}

void check_error_limit(const input::CaseCheck& check) {
  const auto& limit = check.problem.options.of<ErrorLimit>();
  if (limit.percent > 0 && !check.problem.options.of<SolidOptions>().mesh.empty())
    check.report("models.solid.tolerance",
                 "'tolerance' chooses one of the built-in meshes, and 'mesh' names a file: leave "
                 "out one of the two");
  if (limit.of == ErrorLimit::Of::field && limit.percent == 0)
    check.report("models.solid.tolerance_of",
                 "'tolerance_of' says of what the 'tolerance' is a part: give that too");
  if (limit.of == ErrorLimit::Of::field && check.problem.sensors.empty())
    check.report("models.solid.tolerance_of",
                 "the field's error is that at the sensors, and the case has none");
}

void check(const input::CaseCheck& check) {
  const auto& options = check.problem.options.of<SolidOptions>();
  if (check.is_asked_for && check.cilium_is_right && check.load_is_right) {
    if (check.problem.load_path.front().touch().is_plain())
      check_kernel(check);
    else
      check_touch(check);
    check_azimuths(check);
  }
  check_error_limit(check);
  const auto [ratio_2, ratio_3] = options.yeoh_ratios;
  if (!fem::solid::material::yeoh_is_stable(ratio_2, ratio_3))
    check.report("models.solid.yeoh_ratios",
                 fmt::format("a Yeoh solid with C20/C10 = {:g} and C30/C10 = {:g} is unstable: "
                             "from some shear on its shear stress falls; {}",
                             ratio_2, ratio_3,
                             ratio_3 < 0 ? "C30/C10 must not be negative"
                                         : fmt::format("C30/C10 must be above 3/5 (C20/C10)² = "
                                                       "{:g}",
                                                       0.6 * ratio_2 * ratio_2)));
  std::error_code error;
  if (!options.mesh.empty() && !fs::is_regular_file(options.mesh, error))
    check.report("models.solid.mesh",
                 fmt::format("there is no mesh file '{}': a name without a leading / is looked for "
                             "beside the case file",
                             options.mesh.string()));
}

/// Reads the user's mesh.
std::vector<std::string> remarks(const input::Case& problem) {
  const auto& options = problem.options.of<SolidOptions>();
  if (options.mesh.empty()) return {};
  std::vector<std::string> remarks =
      meshes::plain_gmsh({options.mesh, options.mesh_unit}, problem.cilium).remarks;
  for (std::string& remark : remarks) remark = fmt::format("{}: {}", options.mesh.string(), remark);
  return remarks;
}

/// The whole mesh, not its half: the built-in one or the user's.
meshes::PlainMesh mesh_of(const input::Case& problem, std::optional<unsigned int> refinement) {
  auto options = problem.options.of<SolidOptions>();
  if (options.mesh.empty()) {
    options.symmetry = false;
    if (refinement) options.refinement = *refinement;
    return meshes::plain_cylinder(problem.cilium,
                                  fem::solid::cylinder_mesh_options(options, problem.load_path));
  }
  if (refinement)
    throw InputError(
        fmt::format("the case has a mesh of its own ({}), which has no refinement: "
                    "leave out --refinement",
                    options.mesh.string()));
  return meshes::plain_gmsh({options.mesh, options.mesh_unit}, problem.cilium);
}

/// The solid's energies. The defaults of the ratios are the orders of magnitude of rubbers, none
/// measured on the paper's: C₀₁/C₁₀ = 1/4 is what is taken where only a hardness is known, and
/// Yeoh (Rubber Chem. Technol. 66, 754, 1993) finds a C₂₀ of −0.1 to −0.01 C₁₀, which makes rubber
/// softer in moderate shear, and a C₃₀ of some +0.01 C₁₀, which makes it stiff again.
std::vector<input::Option> material() {
  using Material = SolidOptions::Material;
  return {input::choice(&SolidOptions::material, "material",
                        {{"neo-hooke", Material::neo_hooke},
                         {"mooney-rivlin", Material::mooney_rivlin},
                         {"yeoh", Material::yeoh}},
                        "Energy W + K/2 (J-1)²: `neo-hooke` W = μ/2 (Ī₁-3), `mooney-rivlin` "
                        "C10 (Ī₁-3) + C01 (Ī₂-3), `yeoh` C10 (Ī₁-3) + C20 (Ī₁-3)² + C30 "
                        "(Ī₁-3)³; E and ν of the segment give μ = 2 (C10 + C01) and K."),
          only_with(
              &SolidOptions::material, Material::mooney_rivlin, "material = \"mooney-rivlin\"",
              option(&SolidOptions::mooney_ratio, "mooney_ratio",
                     {0, 10, false,
                      "with a negative C01 the solid is unstable, and rubber has a C01 below C10"},
                     "`mooney-rivlin`: C01/C10. The default is a round figure for rubber.")),
          only_with(&SolidOptions::material, Material::yeoh, "material = \"yeoh\"",
                    option(&SolidOptions::yeoh_ratios, "yeoh_ratios",
                           {-10, 10, false, "rubber has ratios well below 1"},
                           "`yeoh`: C20/C10 and C30/C10. Neither negative, or (C20/C10)² < 5/3 "
                           "C30/C10. The defaults are round figures for rubber."))};
}

std::vector<input::Option> options() {
  using fem::solid::InitialGuess;
  using fem::solid::solvers::SolverKind;
  std::vector<input::Option> all = material();
  const std::vector<input::Option> others{
      only_with(&ErrorLimit::percent, 0.0, "no tolerance",
                option(&SolidOptions::refinement, "refinement", solid_mesh_range,
                       "Mesh: 0 coarse, 1 default, 2 fine, 3 to certify these.")),
      option(&ErrorLimit::percent, "tolerance", quantity::percentage,
             {0, 100, false, "a larger error is no result"},
             "Allowed error: the coarsest mesh is taken whose estimate is below it at each step. "
             "`\"0 %\"`: none, `refinement` says which mesh."),
      input::choice(
          &ErrorLimit::of, "tolerance_of",
          {{"tip", ErrorLimit::Of::tip}, {"field", ErrorLimit::Of::field}},
          "What the tolerance is of: `tip`, of the tip's displacement; `field`, of the path's "
          "largest change of B, at each sensor."),
      input::choice(&SolidOptions::initial_guess, "initial_guess",
                    {{"beam", InitialGuess::beam}, {"none", InitialGuess::none}},
                    "What the coarsest mesh starts from: the beam's solution at the same "
                    "load, or its own last ones."),
      input::flag(&SolidOptions::symmetry, "symmetry",
                  "Solve one side of the bending plane; the other is its mirror image."),
      input::file(&SolidOptions::mesh, "mesh", input::Option::File::mesh,
                  "Gmsh file (docs/guide/meshes.md) in place of the built-in mesh, beside the "
                  "case file unless absolute; `refinement` and `symmetry` are then not "
                  "used. Empty: the built-in mesh."),
      option(&SolidOptions::mesh_unit, "mesh_unit", quantity::length, {1e-9, 1, false, unit_slip},
             "What a coordinate of 1 in that file is: `\"1 mm\"`."),
      option(&SolidOptions::kernel_width, "kernel_width", quantity::length, length_range,
             "Half-width w of the contact kernel; `contact` and `probe` need 0 < h-w "
             "and h+w below the tip."),
      option(&SolidOptions::newton_tolerance, "newton_tolerance", tolerance_range,
             "Of the residual, relative to the applied force, and of the increment."),
      option(&SolidOptions::max_iterations, "max_iterations", iterations_range,
             "Newton iterations of a load increment."),
      option(&SolidOptions::max_cutbacks, "max_cutbacks", cutbacks_range,
             "Cuts, to a quarter, of a load step that does not converge, in a row."),
      input::choice(&SolidOptions::solver, "solver",
                    {{"auto", SolverKind::automatic},
                     {"direct", SolverKind::direct},
                     {"iterative", SolverKind::iterative}},
                    "Linear systems: sparse LU, or GMRES with multigrid; `auto` takes LU up "
                    "to 100,000 unknowns.")};
  all.insert(all.end(), others.begin(), others.end());
  return all;
}

}  // namespace

input::Refinement solid_meshes() {
  return {.option = "refinement",
          .values = {0, 1, 2, 3},
          .size =
              [](double value) {
                const auto refinement = static_cast<unsigned int>(value);
                return fem::solid::cylinder_mesh_options(refinement).finest_layer;
              },
          .size_name = "thickness of the finest layers, in diameters",
          .also = [](input::ModelOptions& o) { o.of<ErrorLimit>() = {}; }};
}

input::MechanicsEntry solid() {
  return {
      .id = "solid",
      .description = "3D finite-strain near-incompressible solid FEM",
      .make = input::make<fem::solid::Solid, SolidOptions>,
      .options = options(),
      .refinements = {solid_meshes()},
      .error_limit = [](const input::ModelOptions& o) { return o.of<ErrorLimit>(); },
      .takes_environment = true,
      .takes_touch = true,
      .takes_sections = true,
      .has_body = true,
      .is_collective = true,
      .is_slow = true,
      .accuracy = 1e-8,
      .check = check,
      .remarks = remarks,
      .budget_stages =
          [](const input::ModelOptions&) {
            return std::vector<input::BudgetStage>{
                {.physics = "three dimensions: bonded ends, near-incompressibility, a contact of "
                            "some width"}};
          },
      .mesh = mesh_of,
      // These may be raised to go on after a failure.
      .checkpoint_without = std::vector<std::string_view>{"max_iterations", "max_cutbacks"},
  };
}

}  // namespace ciliaval::compare::models::entries
