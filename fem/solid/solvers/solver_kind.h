// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

namespace ciliaval::fem::solid::solvers {

/// How the solid's linear systems are solved: by sparse LU, by GMRES with multigrid, or by the one
/// that is faster for their size.
enum class SolverKind { automatic, direct, iterative };

}  // namespace ciliaval::fem::solid::solvers
