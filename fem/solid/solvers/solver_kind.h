// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

namespace ciliaval::fem::solid::solvers {

/// Solver of the solid's linear systems: sparse LU, GMRES with multigrid, or the one that is faster
/// for their size.
enum class SolverKind { automatic, direct, iterative };

}  // namespace ciliaval::fem::solid::solvers
