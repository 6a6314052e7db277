// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include "problem/mechanics_model.h"

namespace ciliaval::continuation {

/// Has the contacts and probes of a rod's result that state SlipOffPoint::rim let go where a solid
/// does: where the lowest point of the end face comes down to the upper edge of the contact,
///   z(L) − d(θ_L) = h + w,   d = R sin θ_L of a circle.
/// The largest load borne is the root of this by TOMS 748, each trial solved by the model from the
/// straight cilium: the rim sinks as the load grows, so there is one. It is sought where the step
/// is beyond it, or where the model states the limit of the axis. `slip_off_uncertainty` is
/// (δz + R δθ)/|dz/dF|, of the errors that the model states at the root.
///
/// `half_width` is w, m; Throws InputError if h + w is not below the straight tip.
void let_go_at_rim(const MechanicsModel& rod, const Cilium& cilium, double half_width,
                   MechanicsResult& result);

}  // namespace ciliaval::continuation
