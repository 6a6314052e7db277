// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include "problem/centreline.h"

namespace ciliaval {

/// Sets the curvature at the nodes of a piece, κ = 2 vec(q′ q̄), from the interpolation of the
/// nodes' rotations q, of which it takes the signs that belong together.
void differentiate_rotation(Centreline::Piece& piece);

}  // namespace ciliaval
