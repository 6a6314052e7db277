// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string_view>

#include "problem/cilium.h"
#include "problem/description/field.h"

namespace ciliaval::description {

/// Keys that rules between several of them name.
inline constexpr std::string_view diameter_key = "diameter";
inline constexpr std::string_view inner_diameter_key = "inner_diameter";
inline constexpr std::string_view poisson_ratio_key = "poisson_ratio";

template <>
const Fields<Segment>& fields<Segment>();  ///< [[cilium.segment]]
template <>
const Fields<CrossSection>& fields<CrossSection>();  ///< [cilium.section]
template <>
const Fields<Cilium>& fields<Cilium>();  ///< those of [cilium] itself

}  // namespace ciliaval::description
