// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <array>
#include <numbers>
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
inline constexpr QuantityKey diameter{
    "cilium",
    "diameter",
    quantity::length,
    length_range,
    "none of a rectangle",
    "Diameter d of the section, the same all along; of a tube the outer one."};
inline constexpr std::string_view section_table = "cilium.section";
inline constexpr std::string_view section_shape = "shape";
inline constexpr std::array<std::string_view, 3> section_shapes{"circle", "rectangle", "tube"};
inline constexpr QuantityKey section_width{
    section_table, "width", quantity::length,
    length_range,  "",      "`rectangle`: its first side, along x unless it is turned."};
inline constexpr QuantityKey section_height{
    section_table, "height", quantity::length,
    length_range,  "",       "`rectangle`: its second side, along y unless it is turned."};
inline constexpr QuantityKey section_orientation{
    section_table,
    "orientation",
    quantity::angle,
    {-4 * std::numbers::pi, 4 * std::numbers::pi, false,
     "more than two turns is taken for a slip in the unit"},
    "0 deg",
    "`rectangle`: turn of the first side from +x towards +y. The load's azimuth lies along a "
    "side."};
inline constexpr QuantityKey section_inner_diameter{section_table,
                                                    "inner_diameter",
                                                    quantity::length,
                                                    length_range,
                                                    "",
                                                    "`tube`: diameter of the hole."};
inline constexpr QuantityKey segment_length{
    "cilium.segment", "length", quantity::length,
    length_range,     "",       "Length along the straight axis."};
inline constexpr QuantityKey young_modulus{
    "cilium.segment",    "young_modulus", quantity::pressure, {1, 1e15, false, unit_slip}, "",
    "Young's modulus E."};
inline constexpr QuantityKey poisson_ratio{
    "cilium.segment",
    "poisson_ratio",
    quantity::number,
    {-1, 0.5, true, "an elastic solid is stable only in between, and a compressible one below 0.5"},
    "",
    "Poisson's ratio; rubber is near 0.49."};
inline constexpr QuantityKey magnetization{
    "cilium.segment",
    "magnetization",
    quantity::magnetization,
    {-1e8, 1e8, false, "the strongest magnets have about 1.2e6 A/m; divide a B_r in T by mu_0"},
    "0 A/m",
    "Axial magnetisation B_r/mu_0 from base to tip, negative to the base; or three components "
    "along x, y, z of the straight cilium."};
inline constexpr QuantityKey density{
    "cilium.segment",
    "density",
    quantity::density,
    {1e-3, 1e5, false, unit_slip},
    "not known",
    "Of the material, for its weight: `gravity` of [environment] needs it of each segment."};
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
