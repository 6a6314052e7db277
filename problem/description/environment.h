// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string_view>

#include "problem/description/field.h"
#include "problem/surroundings/environment.h"
#include "problem/surroundings/magnets/magnet.h"

namespace ciliaval::description {

/// Keys that rules between several of them name.
inline constexpr std::string_view axis_key = "axis";
inline constexpr std::string_view rotation_key = "rotation";
inline constexpr std::string_view magnetization_key = "magnetization";
inline constexpr std::string_view remanence_key = "remanence";

/// [environment] without its magnets.
template <>
const Fields<surroundings::Environment>& fields<surroundings::Environment>();
/// [[environment.magnet]].
template <>
const Fields<surroundings::magnets::Magnet>& fields<surroundings::magnets::Magnet>();

}  // namespace ciliaval::description
