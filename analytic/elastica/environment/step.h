// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <optional>

#include "analytic/elastica/environment/equilibrium.h"
#include "analytic/elastica/planar.h"
#include "problem/cilium.h"
#include "problem/load.h"
#include "problem/mechanics_model.h"

namespace ciliaval::analytic::elastica::environment {

/// L (m) and B/L² (N), the units of a rod.
PlanarUnits units_of(const Cilium& cilium, double azimuth = 0);

/// The factor on an environment along the axis at which the straight cilium buckles, over its thin
/// side if it is a rectangle; none up to `most`. Greenhill's problem, and that of an opposing
/// field. Throws InputError if the environment is not along the axis, or acts in a field on a
/// magnetisation across it.
std::optional<double> critical_factor(const Cilium& cilium,
                                      const surroundings::Environment& environment, double most);

/// The cilium with its environment and what its load spreads over it. Throws InputError if the
/// environment, or in a field the magnetisation, points out of the plane of the load.
Rod rod_of(const Cilium& cilium, const Load& load);

/// Solves the step, whose load has an environment and is no sweep. Throws SolverError where
/// the branch of equilibria that begins at the straight cilium ends.
void solve_step(const Cilium& cilium, double tolerance, MechanicsStep& step);

}  // namespace ciliaval::analytic::elastica::environment
