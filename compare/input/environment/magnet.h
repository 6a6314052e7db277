// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "compare/input/case_toml.h"
#include "problem/load.h"
#include "problem/parameter.h"
#include "problem/surroundings/magnets/magnet.h"

namespace ciliaval::compare::input::environment {

inline constexpr std::string_view magnet_table = "environment.magnet";
inline constexpr QuantityKey magnet_position{
    magnet_table,
    "position",
    quantity::length,
    {-100, 100, false, unit_slip},
    "",
    "The point `[x, y, z]` of the centre, or a list of such, which is a path."};
inline constexpr QuantityKey magnet_axis{
    magnet_table,
    "axis",
    quantity::number,
    {-1e6, 1e6, false, unit_slip},
    "`[0, 0, 1]`",
    "Direction `[x, y, z]` of its own third axis, along which it is magnetised; the other two are "
    "turned with it by the shortest way."};
inline constexpr QuantityKey magnet_rotation{
    magnet_table,
    "rotation",
    quantity::number,
    {-1, 1, false, "a quaternion of a rotation has unit length"},
    "`axis`",
    "In place of `axis`: the rotation of its own axes, the unit quaternion `[w, x, y, z]`."};
inline constexpr QuantityKey magnet_diameter{magnet_table, "diameter", quantity::length,
                                             length_range, "",         "Of a ball or a cylinder."};
inline constexpr QuantityKey magnet_length{
    magnet_table, "length", quantity::length, length_range, "", "Of a cylinder, along its axis."};
inline constexpr QuantityKey magnet_edges{
    magnet_table, "edges", quantity::length,
    length_range, "",      "Of a cuboid, along its own axes `[a, b, c]`."};
inline constexpr QuantityKey magnet_magnetization{
    magnet_table,
    "magnetization",
    quantity::magnetization,
    {-1e8, 1e8, false, "the strongest magnets have about 1.2e6 A/m"},
    "`remanence`",
    "M along its own third axis, or three components along its own axes (a cylinder's along its "
    "axis only)."};
inline constexpr QuantityKey magnet_remanence{
    magnet_table,           "remanence",
    quantity::flux_density, {-100, 100, false, unit_slip},
    "`magnetization`",      "B_r = mu_0 M in place of `magnetization`, along its own third axis."};

/// The magnets [[environment.magnet]]: one set for each step of a path that a position lists, or
/// one; none without the tables.
std::vector<std::vector<surroundings::magnets::Magnet>> read_magnets(Section& environment);

/// The tables as TOML, of the magnets at the steps of a path.
std::string magnets_to_toml(const LoadPath& path);

}  // namespace ciliaval::compare::input::environment
