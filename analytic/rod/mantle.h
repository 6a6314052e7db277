// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "analytic/body/body_quadrature.h"
#include "analytic/rod/rod_magnet.h"

namespace ciliaval::analytic::rod {

/// A smooth part of the sides of a stretch, ξ ∈ [0,1]² along S and around it, with the reference
/// charge (M₁ N₁ + M₂ N₂) dA₀ per dξ that F·M/J leaves there (Piola).
using MantlePatch = std::function<body::PatchPoint<double>(const std::array<double, 2>& xi)>;

/// The sides of all stretches that are magnetised across the axis; of a tube those of its hole,
/// too. They refer to the magnet.
std::vector<MantlePatch> mantle_patches(const RodMagnet& magnet);

}  // namespace ciliaval::analytic::rod
