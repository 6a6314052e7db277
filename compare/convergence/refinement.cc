// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/convergence/refinement.h"

#include <algorithm>
#include <cmath>

#include "fem/solid/solid.h"
#include "meshes/cylinder/cylinder_mesh.h"

namespace ciliaval::compare::convergence {
namespace {

unsigned int whole(double value) {
  return static_cast<unsigned int>(std::lround(value));
}

double finest_layer(double refinement) {
  return fem::solid::cylinder_mesh_options(whole(refinement)).finest_layer;
}

double power_of_half(double exponent) {
  return std::exp2(-exponent);
}

double same(double value) {
  return value;
}

double inverse(double value) {
  return 1 / value;
}

std::vector<Refinement> mechanics_refinements() {
  const std::string layers = "thickness of the finest layers, in diameters";
  return {
      {"elastica",
       false,
       "tolerance",
       {1e-4, 1e-6, 1e-8, 1e-10, 1e-12},
       [](input::ModelOptions& options, double value) { options.elastica.tolerance = value; },
       same,
       "tolerance",
       Refinement::Law::tolerance},
      {"beam",
       false,
       "refinement",
       {0, 1, 2, 3, 4, 5},
       [](input::ModelOptions& options, double value) { options.beam.refinement = whole(value); },
       power_of_half,
       "length of the elements, in segments"},
      {"beam",
       false,
       "degree",
       {2, 3, 4, 5, 6},
       [](input::ModelOptions& options, double value) { options.beam.degree = whole(value); },
       power_of_half,
       "2^-degree"},
      {"calculix",
       false,
       "refinement",
       {0, 1, 2, 3},
       [](input::ModelOptions& options, double value) {
         options.calculix.refinement = whole(value);
         options.calculix.error_estimate = false;
       },
       finest_layer,
       layers},
      // The thickness of the layers at the singular rims, which govern (docs/theory/solid.md):
      // order 1.5 on the average, none formal.
      {"solid",
       false,
       "refinement",
       {0, 1, 2, 3},
       [](input::ModelOptions& options, double value) { options.solid.refinement = whole(value); },
       finest_layer,
       layers}};
}

std::vector<Refinement> field_refinements() {
  const std::vector<double> tolerances{1e-2, 1e-4, 1e-6, 1e-8, 1e-10};
  return {
      // Midpoint rules.
      {"line",
       true,
       "elements",
       {16, 32, 64, 128, 256, 512, 1024, 2048, 4096},
       [](input::ModelOptions& options, double value) { options.line.elements = whole(value); },
       inverse,
       "length of the pieces, in segments",
       Refinement::Law::power,
       2.0},
      {"line", true, "tolerance", tolerances,
       [](input::ModelOptions& options, double value) { options.line.tolerance = value; }, same,
       "tolerance", Refinement::Law::tolerance},
      {"volume",
       true,
       "elements",
       {16, 32, 64, 128, 256},
       [](input::ModelOptions& options, double value) { options.volume.elements = whole(value); },
       inverse,
       "height of the slices, in segments",
       Refinement::Law::power,
       2.0},
      {"volume", true, "tolerance", tolerances,
       [](input::ModelOptions& options, double value) { options.volume.tolerance = value; }, same,
       "tolerance", Refinement::Law::tolerance},
      {"mesh",
       true,
       "tolerance",
       {1e-2, 1e-4, 1e-6, 1e-8},
       [](input::ModelOptions& options, double value) { options.mesh.tolerance = value; },
       same,
       "tolerance",
       Refinement::Law::tolerance},
      {"potential",
       true,
       "tolerance",
       {1e-2, 3e-3, 1e-3},
       [](input::ModelOptions& options, double value) { options.potential.tolerance = value; },
       same,
       "tolerance",
       Refinement::Law::tolerance}};
}

/// Whether the knob means anything with the method that the case asks for: closed forms but for the
/// stack of loops have none.
bool applies(const Refinement& refinement, const input::ModelOptions& options) {
  using analytic::rod::Method;
  const auto fits = [&](Method method, bool closed_form_is_exact) {
    if (method == Method::uniform) return refinement.knob == "elements";
    return refinement.knob == "tolerance" &&
           (method == Method::quadrature || !closed_form_is_exact);
  };
  if (refinement.model == "line")
    return fits(options.line.method,
                options.line.push_forward == analytic::sources::PushForward::F);
  if (refinement.model == "volume")
    return fits(options.volume.method,
                options.volume.slices == analytic::rod::VolumeOptions::Slices::wedge);
  return true;
}

}  // namespace

const std::vector<Refinement>& refinements() {
  static const std::vector<Refinement> all = [] {
    std::vector<Refinement> result = mechanics_refinements();
    for (Refinement& refinement : field_refinements()) result.push_back(std::move(refinement));
    return result;
  }();
  return all;
}

std::vector<Refinement> refinements(const input::Case& problem) {
  std::vector<Refinement> result;
  for (const Refinement& refinement : refinements()) {
    const std::vector<std::string>& asked =
        refinement.is_field ? problem.fields : problem.mechanics;
    if (std::find(asked.begin(), asked.end(), refinement.model) != asked.end() &&
        applies(refinement, problem.options))
      result.push_back(refinement);
  }
  return result;
}

}  // namespace ciliaval::compare::convergence
