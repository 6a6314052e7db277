// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include "problem/mechanics_model.h"

namespace ciliaval::continuation {

/// Relative: a solid whose contact force falls short by more slips off.
inline constexpr double force_shortfall = 1e-6;

/// Has the contacts and probes of a rod's result that state SlipOffPoint::rim let go where a solid
/// does: where the end face has come so far into the contact of half-width w that `force_shortfall`
/// of its force finds no material,
///   z(L) − R sin θ_L = h + w − ε.
/// A line that ends ε' below the edge of the kernel k(s) = (1 + cos(πs/w))/(2w) lacks π²ε'³/(12w³);
/// the mean over a disc or a tube of area A whose lowest point is ε below it is
///   π² √(2R) B(3/2, 4) ε^4.5/(6 A w³ (sin θ)^1.5),
/// and over a rectangle of the side 2a along e π² ε⁴/(96 a w³ sin θ).
///
/// The largest load borne is the root of this by TOMS 748, each trial solved by the model from the
/// straight cilium: the rim sinks as the load grows, so there is one. It is sought where the step
/// is beyond it, or where the model states the limit of the axis. `slip_off_uncertainty` is
/// (δz + R δθ)/|dz/dF|, of the errors that the model states at the root.
///
/// `half_width` is w, m. Throws InputError if h + w is not below the straight tip.
void let_go_at_rim(const MechanicsModel& rod, const Cilium& cilium, double half_width,
                   MechanicsResult& result);

}  // namespace ciliaval::continuation
