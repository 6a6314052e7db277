// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string_view>
#include <vector>

#include "compare/input/model_entry.h"

/// Refinements that several models have.
namespace ciliaval::compare::models::entries {

/// The option `tolerance`, which the model promises to keep.
input::Refinement tolerances(std::vector<double> values);

/// An option of which each step halves the size.
input::Refinement halvings(std::string_view option, std::vector<double> values,
                           std::string_view size_name);

/// The option `elements`: pieces of equal height, summed by the midpoint rule.
input::Refinement pieces(std::vector<double> values, std::string_view size_name);

/// The option `refinement` of the solid's meshes, by the thickness of the layers at the singular
/// rims, which govern (docs/theory/solid.md): order 1.5 on the average, none formal.
input::Refinement solid_meshes();

}  // namespace ciliaval::compare::models::entries
