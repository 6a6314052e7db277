// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "compare/input/described.h"
#include "problem/load.h"
#include "problem/surroundings/environment.h"

/// The table [environment] of a case file.
namespace ciliaval::compare::input::environment {

inline constexpr std::string_view table_name = "environment";
inline constexpr std::string_view magnet_table = "environment.magnet";

/// Reads the table and the magnets in it: an environment for each step that they list, or one; none
/// without the table.
std::vector<surroundings::Environment> read_environment(Section& root, PathLength& length);

/// Gives the loads their environments: one to all, or one to each. A single load becomes a path.
/// False if their numbers do not fit.
bool put_into(const std::vector<surroundings::Environment>& environments, LoadPath& path);

/// A path for a case without a load: bent in the vertical plane of the strongest field, of gravity,
/// or of the first magnet.
LoadPath path_of(const std::vector<surroundings::Environment>& environments);

/// The table as TOML; empty without an environment.
std::string to_toml(const LoadPath& path);

}  // namespace ciliaval::compare::input::environment
