// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include "problem/types.h"

namespace ciliaval::fem::beam {

/// A quaternion as a vector (x, y, z, w), Eigen's order; not of unit length in general.
using Vector4 = Eigen::Vector4d;
using Matrix4 = Eigen::Matrix4d;
using Matrix34 = Eigen::Matrix<double, 3, 4>;
using Matrix43 = Eigen::Matrix<double, 4, 3>;

/// L(t) with L(t) p = t ∘ p, t a pure quaternion; skew-symmetric.
Matrix4 left_product(const Vector3& t);
/// R(n) with R(n) p = p ∘ n, n a pure quaternion; skew-symmetric and commuting with every L(t).
Matrix4 right_product(const Vector3& n);

/// exp(θ) = (sin(|θ|/2) θ/|θ|, cos(|θ|/2)): the unit quaternion of the rotation vector θ (rad).
Quaternion exponential(const Vector3& theta);

/// E(q) with dq = E(q) dθ for q ← exp(dθ) q: columns ½ e_i ∘ q.
Matrix43 spin_derivative(const Quaternion& q);

/// The strains per unit of the element coordinate ξ before the reference strains are taken off, as
/// functions of the interpolated quaternion p = Σ N_a q_a (any length), s = dp/dξ and t = dr/dξ:
///   γ = Λᵀ t = vec(p̄ t p)/|p|²,   κ = 2 vec(p̄ s)/|p|²   (material components),
/// with their first derivatives. Λ is the rotation of p/|p|.
struct Strain {
  Vector3 gamma;
  Vector3 kappa;
  Matrix3 gamma_t;   ///< ∂γ/∂t = Λᵀ
  Matrix34 gamma_p;  ///< ∂γ/∂p
  Matrix34 kappa_p;  ///< ∂κ/∂p
  Matrix34 kappa_s;  ///< ∂κ/∂s
};
Strain strain(const Vector4& p, const Vector4& s, const Vector3& t);

/// First and second derivatives of f = n·γ + m·κ at constant n, m. With Q = |p|²,
/// f Q = −pᵀ L(t) R(n) p + 2 sᵀ R(m) p, and the quotient rule gives the rest (docs/theory/beam.md).
struct StressPower {
  double value;
  Vector4 p;    ///< ∂f/∂p
  Vector4 s;    ///< ∂f/∂s
  Vector3 t;    ///< ∂f/∂t = Λ n
  Matrix4 pp;   ///< ∂²f/∂p∂p
  Matrix4 sp;   ///< ∂²f/∂s∂p
  Matrix34 tp;  ///< ∂²f/∂t∂p; ∂²f/∂s∂s, ∂²f/∂t∂t and ∂²f/∂s∂t vanish
};
StressPower stress_power(const Vector4& p, const Vector3& t, const Strain& strain, const Vector3& n,
                         const Vector3& m);

}  // namespace ciliaval::fem::beam
