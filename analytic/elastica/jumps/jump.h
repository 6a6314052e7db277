// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include "analytic/elastica/taylor.h"

namespace ciliaval::analytic::elastica::jumps {

enum class Side { lower, upper };

/// The state on the other side of `part` of a joint, from the side `from`. The section's axes, M
/// and H are the mean of both sides, so that the way back leads to the same state; M jumps by −H Δz
/// and, of a force per height, H by −Δz, as along the rod. Newton's method; throws SolverError if
/// it does not converge or if the joint turns by more than a radian.
PlanarState across(const PlanarJoint& joint, ForceLaw law, const PlanarState& state, Side from,
                   double part = 1);

/// From the lower side, where M > 0, to the part of the joint at which M = 0, which must be there:
/// a contact between its sides.
PlanarState inside(const PlanarJoint& joint, const PlanarState& lower);

}  // namespace ciliaval::analytic::elastica::jumps
