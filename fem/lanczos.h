// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <Eigen/Core>
#include <functional>

namespace ciliaval::fem {

/// K u = ω W u with K symmetric and regular, W symmetric and positive semidefinite.
struct EigenProblem {
  using Map = std::function<Eigen::VectorXd(const Eigen::VectorXd&)>;
  Eigen::Index size = 0;
  Map solve;  ///< K⁻¹ f
  Map weigh;  ///< W u
};

struct Eigenpair {
  double value = 0;        ///< ω
  Eigen::VectorXd vector;  ///< u, uᵀ W u = 1
};

/// The smallest ω, of which `negative` are negative, as the inertia of K tells: by Lanczos's method
/// on K⁻¹ W in the inner product of W, with full reorthogonalisation (Parlett, The Symmetric
/// Eigenvalue Problem, ch. 13). If none are, it is the one
/// nearest to 0.
/// The start is the same in every run. Throws SolverError if it is not found.
Eigenpair smallest_eigenpair(const EigenProblem& problem, int negative);

}  // namespace ciliaval::fem
