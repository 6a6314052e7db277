// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "compare/models/run.h"

namespace ciliaval::compare::budget {

/// Relative step h of the load in the differences below. The truncation of the five-point formula
/// is h⁴ F⁵ B⁽⁵⁾/(30 F), that of the solvers' tolerances (1e-9) about 1e-9/h of dB/dF: at h = 0.01
/// both are below 1e-6 for fields that change over loads of the size of F.
inline constexpr double sensitivity_step = 0.01;

/// A load path with the loads around each of its steps.
struct SurroundedPath {
  LoadPath loads;
  std::vector<std::size_t> step;  ///< place of each step of the path in `loads`
  std::vector<std::optional<std::array<std::size_t, 4>>>
      around;  ///< places of F(1−2h), F(1−h), F(1+h), F(1+2h); none for a load of zero
};

/// The path alone, or each step with its four neighbours.
SurroundedPath surround(const LoadPath& path, bool with_neighbours);

/// dB/dF at a sensor by central differences in the magnitude F of the load (N, N/m or m), T per
/// unit of F.
struct Sensitivity {
  Vector3 value;  ///< (4 D(h) − D(2h))/3, of fourth order
  Vector3 plain;  ///< D(h) = [B(F + hF) − B(F − hF)]/(2hF): `value` less its truncation error
};
/// Sensitivity of a run of the surrounded path; none if one of the neighbours is missing.
std::optional<Sensitivity> sensitivity(const models::FieldRun& run, const SurroundedPath& path,
                                       std::size_t step, std::size_t sensor);

}  // namespace ciliaval::compare::budget
