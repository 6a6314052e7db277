// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include "fem/solid/fibres.h"
#include "fem/solid/space.h"
#include "problem/cilium.h"
#include "problem/solid_body.h"

namespace ciliaval::fem {

/// The solid of a cilium as polynomial patches of the given degree on Gauss–Lobatto nodes, with
/// x = X + u, J = det(1 + ∂u/∂X) and the Cauchy stress of (F, p) at the nodes. At a degree not
/// below that of the mapping (and 2) X and x are the finite elements' own polynomials. Charged
/// faces are the horizontal planes across which M jumps: end faces and interfaces. At an interface
/// the lower segment is `inside`; its normal is +Z. A half body is completed by its image in y = 0.
SolidBody solid_body(const SolidSpace& space, const Fibres& fibres, const Cilium& cilium,
                     const SolidState& state, unsigned int degree);

}  // namespace ciliaval::fem
