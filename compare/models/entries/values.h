// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string_view>

#include "analytic/rod/field_models.h"
#include "analytic/sources/push_forward.h"
#include "compare/input/option.h"
#include "problem/parameter.h"

/// Ranges and choices of options that several models have.
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

}  // namespace ciliaval::compare::models::entries
