// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compare/registry.h"
#include "compare/run.h"

namespace ciliaval::compare {

/// B of one pair of models on a regular grid around the cilium, for drawing.
struct FieldGrid {
  struct Step {
    std::vector<Vector3> B;           ///< T, first index fastest; zero where it is not valid
    std::vector<std::uint8_t> valid;  ///< 0 where the model gives no field
  };
  std::string mechanics;
  std::string field;
  Vector3 origin = Vector3::Zero();        ///< lowest corner, m
  Vector3 spacing = Vector3::Zero();       ///< m
  std::array<int, 3> points{33, 33, 49};   ///< along x, y, z
  std::vector<std::optional<Step>> steps;  ///< none where the mechanics did not converge
};

/// The most detailed field model that needs no body (it reads the centreline), on the most detailed
/// mechanics model, sampled in a box that holds the sensors and the cilium at every step, two
/// diameters wider. Closed forms are used whatever the case asks: the picture
/// checks no quadrature. None if no such pair converged at any step.
std::optional<FieldGrid> sample_field(const CaseResult& result, std::span<const FieldEntry> fields,
                                      const Progress& progress = {});

}  // namespace ciliaval::compare
