// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string_view>

#include "problem/description/field.h"
#include "problem/load.h"
#include "problem/surroundings/surface.h"

namespace ciliaval::description {

/// A coefficient of friction: of a surface or of a probe.
inline constexpr std::string_view friction_key = "friction";

/// [surface].
template <>
const Fields<surroundings::StatedSurface>& fields<surroundings::StatedSurface>();
/// The keys of [load] that say how a sweep goes its way; the travel is the load's.
template <>
const Fields<SweepWay>& fields<SweepWay>();

}  // namespace ciliaval::description
