// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/solvers/symmetric_inverse.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>

namespace ciliaval::fem::solid::solvers {
namespace {

/// L⁻¹ in place of a lower triangle L, by halves: nearly all of it in products of matrices.
void invert_triangle(Eigen::Ref<Eigen::MatrixXd> L) {
  constexpr Eigen::Index smallest = 32;
  const Eigen::Index size = L.rows();
  if (size <= smallest) {
    L = Eigen::MatrixXd(
        L.triangularView<Eigen::Lower>().solve(Eigen::MatrixXd::Identity(size, size)));
    return;
  }
  const Eigen::Index half = size / 2;
  auto first = L.topLeftCorner(half, half);
  auto coupling = L.bottomLeftCorner(size - half, half);
  auto second = L.bottomRightCorner(size - half, size - half);
  invert_triangle(first);
  invert_triangle(second);
  const Eigen::MatrixXd product = second.triangularView<Eigen::Lower>() * coupling;
  coupling.noalias() = -product * first.triangularView<Eigen::Lower>();
}

}  // namespace

Eigen::MatrixXd symmetric_inverse(const Eigen::MatrixXd& matrix) {
  const Eigen::LLT<Eigen::MatrixXd> factors(matrix);
  // Not positive definite: the tangent of compressed cells.
  if (factors.info() != Eigen::Success) return matrix.inverse();
  Eigen::MatrixXd L = factors.matrixL();
  invert_triangle(L);
  constexpr Eigen::Index width = 48;  // of the columns that are computed at once
  Eigen::MatrixXd result(L.rows(), L.cols());
  for (Eigen::Index j = 0; j < L.cols(); j += width) {
    const Eigen::Index rest = L.rows() - j;
    const Eigen::Index columns = std::min(width, rest);
    result.block(j, j, rest, columns).noalias() =
        L.bottomRightCorner(rest, rest).triangularView<Eigen::Lower>().transpose() *
        L.block(j, j, rest, columns);
  }
  return result;
}

}  // namespace ciliaval::fem::solid::solvers
