// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compare/models/registry.h"
#include "compare/models/run.h"

namespace ciliaval::compare::output {

/// B of one pair of models on a regular grid around the cilium, for drawing.
struct FieldGrid {
  struct Step {
    std::vector<Vector3> B;           ///< T, first index fastest; zero where it is not valid
    std::vector<std::uint8_t> valid;  ///< 0 where the model gives no field
  };
  std::string mechanics;
  std::string field;
  Vector3 origin = Vector3::Zero();       ///< lowest corner, m
  Vector3 spacing = Vector3::Zero();      ///< m
  std::array<int, 3> points{33, 33, 49};  ///< along x, y, z
  /// B at a step, computed when it is asked for (a long path would not fit into memory); none where
  /// the mechanics did not converge.
  std::function<std::optional<Step>(std::size_t)> sample;
};

/// The most detailed pointwise field model that needs no body (it reads the centreline), on the
/// most detailed mechanics model, to be sampled in a box that holds the cilium at every step and
/// the sensors no farther than two lengths from it, two diameters wider. Closed forms are used
/// whatever the case asks: the picture checks no quadrature. None if no such pair converged at any
/// step. The result refers to `result` and calls `progress`.
std::optional<FieldGrid> field_grid(const models::CaseResult& result,
                                    std::span<const models::FieldEntry> fields,
                                    const Progress& progress = {});

}  // namespace ciliaval::compare::output
