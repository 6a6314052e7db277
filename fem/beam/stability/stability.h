// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include "fem/beam/system.h"
#include "fem/lanczos.h"

namespace ciliaval::fem::beam::stability {

/// Negative eigenvalues of the second variation of the potential energy at an equilibrium: ways in
/// which the energy decreases; 0: stable.
///
/// With the tangent T = [K B; Bᵀ −C] of displacements and section forces, of which there are n, K
/// has as many as T has beyond n (Haynsworth's inertia additivity; with rigid modes, C = 0, on what
/// they leave free). The count is that above the straight cilium without loads, where K = 0 and B
/// is square: T has n negative eigenvalues whatever C is. So the joints' negative compliance,
/// without which the cilium would be no stiffer, does not count. T is eliminated element by element
/// from the base up, each block as LDLᵀ with Bunch and Kaufman's pivots (LAPACK's dsytrf). The
/// loads must have a potential: force_per_height and contacts have none. Throws SolverError if a
/// block is singular.
int unstable_modes(const System& system, const State& state, const Loads& loads);

/// The smallest eigenvalue ω of the second variation, K u = ω W u, dimensionless, and its mode u in
/// the order of the system's unknowns, at an equilibrium with so many unstable modes. uᵀW u is
/// the integral of the squared displacement over the length; rotations have no weight. ω vanishes
/// where the equilibrium ceases to be stable. Leaves the factors of the tangent in the system.
/// Throws SolverError if that is singular.
Eigenpair smallest_eigenvalue(System& system, const State& state, const Loads& loads,
                              int unstable_modes);

}  // namespace ciliaval::fem::beam::stability
