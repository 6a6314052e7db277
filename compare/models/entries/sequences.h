// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include "compare/input/model_entry.h"

/// Refinements that several models have.
namespace ciliaval::compare::models::entries {

/// The option `tolerance`, which the model promises to keep.
inline input::Refinement tolerances(std::vector<double> values) {
  return {.option = "tolerance",
          .values = std::move(values),
          .size = [](double value) { return value; },
          .size_name = "tolerance",
          .law = input::Refinement::Law::tolerance};
}

/// An option of which each step halves the size.
inline input::Refinement halvings(std::string_view option, std::vector<double> values,
                                  std::string_view size_name) {
  return {.option = option,
          .values = std::move(values),
          .size = [](double value) { return std::exp2(-value); },
          .size_name = size_name};
}

/// The option `elements`: pieces of equal height, summed by the midpoint rule.
inline input::Refinement pieces(std::vector<double> values, std::string_view size_name) {
  return {.option = "elements",
          .values = std::move(values),
          .size = [](double value) { return 1 / value; },
          .size_name = size_name,
          .formal_order = 2.0};
}

/// The option `refinement` of the solid's meshes, by the thickness of the layers at the singular
/// rims, which govern (docs/theory/solid.md): order 1.5 on the average, none formal.
input::Refinement solid_meshes();

}  // namespace ciliaval::compare::models::entries
