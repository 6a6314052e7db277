// SPDX-License-Identifier: LGPL-2.1-or-later
#include "problem/support/rotation.h"

#include <Eigen/SVD>
#include <cmath>

namespace ciliaval::support {

Quaternion turn_to(const Vector3& direction) {
  const Vector3 axis = direction.normalized();
  const double across = axis.head<2>().squaredNorm();
  if (across == 0) return axis.z() > 0 ? Quaternion::Identity() : Quaternion(0, 1, 0, 0);
  // 1 + cos θ, without cancellation near the opposite direction.
  const double one_and_cosine = axis.z() > 0 ? 1 + axis.z() : across / (1 - axis.z());
  const double s = std::sqrt(2 * one_and_cosine);
  return {s / 2, (0 - axis.y()) / s, axis.x() / s, 0};  // no −0, which files would show
}

Matrix3 polar_rotation(const Matrix3& F) {
  const Eigen::JacobiSVD<Matrix3> svd(F, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return svd.matrixU() * svd.matrixV().transpose();
}

}  // namespace ciliaval::support
