// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "problem/load.h"
#include "problem/parameter.h"
#include "problem/surroundings/environment.h"

namespace ciliaval::compare::input {
class Section;
}

/// The table [environment] of a case file.
namespace ciliaval::compare::input::environment {

inline constexpr std::string_view table_name = "environment";
inline constexpr QuantityKey gravity{
    table_name,
    "gravity",
    quantity::acceleration,
    {-1e4, 1e4, false, unit_slip},
    "none",
    "The acceleration `[x, y, z]` of free fall, such as `[\"0 m/s2\", \"0 m/s2\", \"-9.81 m/s2\"]` "
    "for a cilium that stands; each segment needs a `density`."};
inline constexpr QuantityKey fluid_density{
    table_name,
    "fluid_density",
    quantity::density,
    {0, 1e5, false, unit_slip},
    "0 kg/m^3",
    "Of a fluid around the cilium, whose buoyancy takes its part off the weight."};
inline constexpr QuantityKey uniform_field{
    table_name,
    "uniform_field",
    quantity::flux_density,
    {-100, 100, false, unit_slip},
    "none",
    "A uniform field B_0 `[x, y, z]` that turns the magnet, or a list of such, which is a path. "
    "Sensors read the cilium's field without it."};
inline constexpr std::string_view magnetic_energy = "magnetic_energy";
/// The names of surroundings::MagneticEnergy, in its order.
inline constexpr std::array<std::string_view, 2> energy_names{"F", "R"};
constexpr std::string_view name(surroundings::MagneticEnergy energy) {
  return energy_names[energy == surroundings::MagneticEnergy::R];
}
inline constexpr std::string_view magnetic_energy_doc =
    "Energy of the cilium's magnet in the fields: the magnetisation carried along by the "
    "deformation, "
    "-(F M).B_0, or turned by its rotation, -(R M).B_0.";

/// Reads the table: an environment for each field or magnet's position that it lists, or one; none
/// without the table.
std::vector<surroundings::Environment> read_environment(Section& root);

/// Gives the loads their environments: one to all, or one to each. A single load becomes a path.
/// False if their numbers do not fit.
bool put_into(const std::vector<surroundings::Environment>& environments, LoadPath& path);

/// A path for a case without a load: bent in the vertical plane of the strongest field, of gravity,
/// or of the first magnet.
LoadPath path_of(const std::vector<surroundings::Environment>& environments);

/// The table as TOML; empty without an environment.
std::string to_toml(const LoadPath& path);

}  // namespace ciliaval::compare::input::environment
