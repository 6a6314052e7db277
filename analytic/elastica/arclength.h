// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <optional>

#include "analytic/elastica/planar.h"

namespace ciliaval::analytic::elastica {

/// The arc-length form dθ/dS = M/(EI) of a planar problem, integrated by Taylor series.
///
/// contact: an initial value problem from the base, for M = h − z is known there; it ends where
/// M = 0. The others are shot down from the free end, where M = 0, with the angle at the top
/// θ = arctan(e^x) as unknown x: θ at the base increases with x (dM/dθ > 0 all along), so the
/// solution is unique; secants find it, or a bracket where they lead away. Towards the base the
/// solution grows away from θ = 90° as it does in the cilium, so errors do not.
///
/// Empty if the contact force is above the slip-off force. Throws SolverError if the accuracy asked
/// is not reached.
std::optional<PlanarShape> solve_arclength(const PlanarProblem& problem, double tolerance);

/// The load PL²/max(EI) of a contact problem above which no equilibrium exists: the one at which
/// z(1) = h (the tip's height decreases with the load). `problem.load` is not used.
double slip_off_arclength(const PlanarProblem& problem, double tolerance);

}  // namespace ciliaval::analytic::elastica
