// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/models/entries/sequences.h"

#include <cmath>
#include <utility>

#include "fem/solid/solid.h"
#include "meshes/cylinder/cylinder_mesh.h"

namespace ciliaval::compare::models::entries {

input::Refinement tolerances(std::vector<double> values) {
  return {.option = "tolerance",
          .values = std::move(values),
          .size = [](double value) { return value; },
          .size_name = "tolerance",
          .law = input::Refinement::Law::tolerance};
}

input::Refinement halvings(std::string_view option, std::vector<double> values,
                           std::string_view size_name) {
  return {.option = option,
          .values = std::move(values),
          .size = [](double value) { return std::exp2(-value); },
          .size_name = size_name};
}

input::Refinement pieces(std::vector<double> values, std::string_view size_name) {
  return {.option = "elements",
          .values = std::move(values),
          .size = [](double value) { return 1 / value; },
          .size_name = size_name,
          .formal_order = 2.0};
}

input::Refinement solid_meshes() {
  return {.option = "refinement",
          .values = {0, 1, 2, 3},
          .size =
              [](double value) {
                const auto refinement = static_cast<unsigned int>(value);
                return fem::solid::cylinder_mesh_options(refinement).finest_layer;
              },
          .size_name = "thickness of the finest layers, in diameters"};
}

}  // namespace ciliaval::compare::models::entries
