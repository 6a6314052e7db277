// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cmath>
#include <functional>
#include <string_view>
#include <utility>
#include <vector>

#include "analytic/rod/field_models.h"
#include "analytic/sources/push_forward.h"
#include "compare/input/model_entry.h"
#include "problem/parameter.h"

/// Ranges, choices and refinements of options that several models have.
namespace ciliaval::compare::models::entries {

inline constexpr Range tolerance_range{
    1e-15, 1e-3, false, "double precision resolves no less, and more is no solution"};
inline constexpr Range iterations_range{1, 1000, false, "the solver must end"};
inline constexpr Range cutbacks_range{0, 50, false, "50 halvings leave nothing of a step"};
inline constexpr Range solid_mesh_range{0, 3, false, "the solid has the meshes 0 to 3"};

inline constexpr std::string_view rod_push_forward =
    "`F`: M dr (ideal hard magnet); `R`: M d₃ dS (rigid sections).";
inline input::Choices<analytic::sources::PushForward> push_forwards() {
  return {{"F", analytic::sources::PushForward::F}, {"R", analytic::sources::PushForward::R}};
}
inline input::Choices<analytic::rod::Method> methods() {
  return {{"closed_form", analytic::rod::Method::closed_form},
          {"quadrature", analytic::rod::Method::quadrature},
          {"uniform", analytic::rod::Method::uniform}};
}

/// Sets one option.
template <class Options, class Value>
std::function<void(input::ModelOptions&)> set(Value Options::*option, Value value) {
  return [=](input::ModelOptions& options) { options.of<Options>().*option = value; };
}

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
/// rims, which govern (docs/theory/solid.md): none formal.
input::Refinement solid_meshes();

}  // namespace ciliaval::compare::models::entries
