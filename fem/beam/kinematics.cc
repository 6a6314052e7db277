// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/beam/kinematics.h"

#include <cmath>

namespace ciliaval::fem::beam {
namespace {

Matrix3 cross(const Vector3& a) {
  Matrix3 A;
  A << 0, -a[2], a[1], a[2], 0, -a[0], -a[1], a[0], 0;
  return A;
}

}  // namespace

Matrix4 left_product(const Vector3& t) {
  Matrix4 L;
  L << cross(t), t, -t.transpose(), 0;
  return L;
}

Matrix4 right_product(const Vector3& n) {
  Matrix4 R;
  R << -cross(n), n, -n.transpose(), 0;
  return R;
}

Quaternion exponential(const Vector3& theta) {
  const double angle = theta.norm();
  // sin(x/2)/x; its series below 1e-4 is exact to rounding error.
  const double factor = angle < 1e-4 ? 0.5 - angle * angle / 48 : std::sin(angle / 2) / angle;
  Quaternion q;
  q.vec() = factor * theta;
  q.w() = std::cos(angle / 2);
  return q;
}

Matrix43 spin_derivative(const Quaternion& q) {
  Matrix43 E;
  for (int i = 0; i < 3; ++i) E.col(i) = 0.5 * left_product(Vector3::Unit(i)) * q.coeffs();
  return E;
}

Strain strain(const Vector4& p, const Vector4& s, const Vector3& t) {
  const double Q = p.squaredNorm();
  const Vector4 tp = left_product(t) * p;
  Strain result;
  for (int i = 0; i < 3; ++i) {
    const Matrix4 R = right_product(Vector3::Unit(i));
    const Vector4 pe = R * p;  // p ∘ e_i
    result.gamma[i] = tp.dot(pe) / Q;
    result.kappa[i] = 2 * s.dot(pe) / Q;
    // L(t)ᵀ R(e_i) is symmetric, so the gradient of the quadratic form is twice its product.
    const Vector4 gradient = 2 * (R.transpose() * tp);
    result.gamma_p.row(i) = (gradient - 2 * result.gamma[i] * p).transpose() / Q;
    result.kappa_p.row(i) = (2 * (R.transpose() * s) - 2 * result.kappa[i] * p).transpose() / Q;
    result.kappa_s.row(i) = 2 * pe.transpose() / Q;
  }
  Quaternion q;
  q.coeffs() = p / std::sqrt(Q);
  result.gamma_t = q.toRotationMatrix().transpose();
  return result;
}

StressPower stress_power(const Vector4& p, const Vector3& t, const Strain& strain, const Vector3& n,
                         const Vector3& m) {
  const double Q = p.squaredNorm();
  const Matrix4 Rn = right_product(n);
  StressPower f;
  f.value = n.dot(strain.gamma) + m.dot(strain.kappa);
  f.p = strain.gamma_p.transpose() * n + strain.kappa_p.transpose() * m;
  f.s = strain.kappa_s.transpose() * m;
  f.t = strain.gamma_t.transpose() * n;
  f.pp = (2 * left_product(t).transpose() * Rn - 2 * f.value * Matrix4::Identity() -
          2 * p * f.p.transpose() - 2 * f.p * p.transpose()) /
         Q;
  f.sp = (2 * right_product(m) - 2 * f.s * p.transpose()) / Q;
  const Vector4 pn = Rn * p;
  for (int j = 0; j < 3; ++j) {
    const Vector4 gradient = 2 * (left_product(Vector3::Unit(j)).transpose() * pn);
    f.tp.row(j) = (gradient - 2 * f.t[j] * p).transpose() / Q;
  }
  return f;
}

}  // namespace ciliaval::fem::beam
