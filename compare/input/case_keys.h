// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "compare/input/case.h"
#include "compare/input/units.h"
#include "problem/parameter.h"

namespace ciliaval::compare::input {

/// "from 1e-09 m to 100 m" or "between -1 and 0.5, both excluded"; angles in deg.
std::string describe(const Range& range, const Quantity& quantity);

namespace key {
inline constexpr QuantityKey samples{
    "load",
    "samples",
    quantity::number,
    {2, 10000, false, "each is a step, of which every model writes files"},
    "101",
    "`sweep`: places of equal distance along the travel, both ends included."};
inline constexpr std::string_view sweep_return = "return";
/// Each coordinate of a sensor point.
inline constexpr QuantityKey position{
    "sensor",
    "position",
    quantity::length,
    {-1000, 1000, false, "a sensor farther away is taken for a slip in the unit"},
    "none",
    "The point `[x, y, z]` where the field is computed, or a list of points; required if `fields` "
    "are asked for."};
inline constexpr std::string_view external_table = "models.external";
inline constexpr QuantityKey tip_uncertainty{
    external_table,   "tip_uncertainty",
    quantity::length, {0, 100, false, unit_slip},
    "not known",      "Uncertainty of the tip's position in each centreline."};
inline constexpr QuantityKey field_uncertainty{external_table,
                                               "field_uncertainty",
                                               quantity::flux_density,
                                               {0, 100, false, unit_slip},
                                               "not known",
                                               "Uncertainty of each component of each reading."};
}  // namespace key

}  // namespace ciliaval::compare::input
