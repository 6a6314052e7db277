// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <optional>

#include "analytic/elastica/planar.h"

namespace ciliaval::analytic::elastica {

/// The paper's form of a planar problem (Eq. 1–4): sin θ = S̃(z) is a polynomial on each segment,
/// the heights z_i of the interfaces follow from ∫ dz/cos θ = L_i, and w = ∫ tan θ dz. Contact and
/// flow only (throws InputError otherwise). The integrals are tanh-sinh in the depth u = h − z or
/// z_tip − z, whose end u = 0 is where they get singular as θ → 90°.
///
/// Empty if the contact force is above the slip-off force. Throws SolverError if θ is so near to
/// 90° that no z_tip gives the length.
std::optional<PlanarShape> solve_height(const PlanarProblem& problem);

/// Limit as by slip_off_arclength(), by the quadrature in z.
double slip_off_height(const PlanarProblem& problem);

}  // namespace ciliaval::analytic::elastica
