// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

namespace ciliaval::analytic::sources {

/// Law by which the deformation carries the magnetisation. F (ideal hard magnet): m = F·M/J in
/// solids, M dr in rods. R (rigid sections): m = R·M with the polar rotation in solids, M d₃ dS in
/// rods. The two differ under shear and extension only.
enum class PushForward { F, R };

}  // namespace ciliaval::analytic::sources
