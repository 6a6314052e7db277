// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <Eigen/Core>

namespace ciliaval::fem::solid::solvers {

/// The lower triangle of the inverse of a symmetric matrix: A⁻¹ = L⁻ᵀL⁻¹ by Cholesky's factor, with
/// three eighths of the operations of Eigen's LU, which inverts matrices that are not positive
/// definite. The entries above the diagonal are undefined. Schur complements by explicit inverses
/// lose too many digits at K/μ = 500 (docs/measurements.md). LAPACK's potri is no slower, but
/// OpenBLAS's threads get in the way of ours.
Eigen::MatrixXd symmetric_inverse(const Eigen::MatrixXd& matrix);

}  // namespace ciliaval::fem::solid::solvers
