// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include "fem/beam/system.h"

namespace ciliaval::fem::beam::stability {

/// Negative eigenvalues of the second variation of the potential energy at an equilibrium: ways in
/// which the energy decreases; 0: stable.
///
/// With the tangent T = [K B; Bᵀ −C] of displacements and section forces, of which there are n, K
/// has as many as T has beyond n (Haynsworth's inertia additivity; with rigid modes, C = 0, on what
/// they leave free). T is eliminated element by element from the base up, each block as LDLᵀ with
/// Bunch and Kaufman's pivots (LAPACK's dsytrf). The loads must have a potential: force_per_height
/// and contacts have none. Throws SolverError if a block is singular.
int unstable_modes(const System& system, const State& state, const Loads& loads);

/// The eigenvalue of the second variation that is nearest to 0.
struct Eigenvalue {
  double value = 0;      ///< ω, K u = ω W u, dimensionless
  Eigen::VectorXd mode;  ///< u of it, in the order of the system's unknowns
};

/// By inverse iteration with all of T. W takes a node's displacement with its share of the length,
/// rotations with nothing. ω vanishes where the equilibrium ceases to be stable.
Eigenvalue smallest_eigenvalue(const System& system, const State& state, const Loads& loads);

}  // namespace ciliaval::fem::beam::stability
