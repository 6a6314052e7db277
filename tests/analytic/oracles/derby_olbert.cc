// SPDX-License-Identifier: LGPL-2.1-or-later
#include "tests/analytic/oracles/derby_olbert.h"

#include <boost/math/constants/constants.hpp>
#include <boost/math/special_functions/ellint_1.hpp>
#include <boost/math/special_functions/ellint_2.hpp>
#include <boost/math/special_functions/ellint_3.hpp>
#include <boost/multiprecision/cpp_bin_float.hpp>

#include "problem/field_model.h"

namespace ciliaval::oracle {
namespace {

using Real = boost::multiprecision::number<boost::multiprecision::cpp_bin_float_50::backend_type,
                                           boost::multiprecision::et_off>;

/// C(kc, p, c, s) by Legendre's integrals: with n = 1 − p and m = 1 − kc², the numerator is
/// c + (s − c) sin²φ and sin²φ = [1 − (1 − n sin²φ)]/n.
Real cel(const Real& kc2, const Real& p, const Real& c, const Real& s) {
  const Real m = 1 - kc2;
  const Real n = 1 - p;
  const Real k = sqrt(m);
  const Real K = boost::math::ellint_1(k);
  if (n != 0) return (c + (s - c) / n) * boost::math::ellint_3(k, n) - (s - c) / n * K;
  if (m != 0) return c * K + (s - c) * (K - boost::math::ellint_2(k)) / m;
  return boost::math::constants::pi<Real>() / 4 * (c + s);
}

}  // namespace

Vector3 derby_olbert(double M, double radius, double bottom, double top, const Vector3& x) {
  const Real& pi = boost::math::constants::pi<Real>();
  const Real R = radius;
  const Real rho = sqrt(Real(x[0]) * x[0] + Real(x[1]) * x[1]);
  const Real r = rho / R;
  const Real gamma = (1 - r) / (1 + r);
  Real B_rho = 0;
  Real B_z = 0;
  for (const int sign : {1, -1}) {
    const Real z = (Real(x[2]) - (sign > 0 ? bottom : top)) / R;
    const Real s2 = z * z + (1 + r) * (1 + r);
    const Real s = sqrt(s2);
    const Real kc2 = (z * z + (1 - r) * (1 - r)) / s2;  // exactly 1 on the axis
    B_rho += sign * cel(kc2, 1, 1, -1) / s;
    B_z += sign * z * cel(kc2, gamma * gamma, 1, gamma) / (s * (1 + r));
  }
  const Real scale = Real(vacuum_permeability) * M / pi;
  Vector3 B(0, 0, static_cast<double>(scale * B_z));
  if (rho > 0) {
    B[0] = static_cast<double>(scale * B_rho * x[0] / rho);
    B[1] = static_cast<double>(scale * B_rho * x[1] / rho);
  }
  return B;
}

Vector3 charged_disc(double sigma, const Vector3& centre, const Vector3& normal, double radius,
                     const Vector3& x) {
  using Vector = Eigen::Matrix<Real, 3, 1>;
  const Real& pi = boost::math::constants::pi<Real>();
  Vector n = normal.cast<Real>();
  n /= Real(sqrt(n.dot(n)));
  const Vector offset = (x.cast<Real>() - centre.cast<Real>()) / Real(radius);
  const Real z = offset.dot(n);
  const Vector in_plane = offset - z * n;
  const Real r = sqrt(in_plane.dot(in_plane));
  const Real gamma = (1 - r) / (1 + r);
  const Real s2 = z * z + (1 + r) * (1 + r);
  const Real s = sqrt(s2);
  const Real kc2 = r == 0 ? Real(1) : Real((z * z + (1 - r) * (1 - r)) / s2);
  // The solenoid's end has +sign where the charge is negative: the sign of both terms turns.
  const Real radial = -cel(kc2, 1, 1, -1) / (pi * s);
  const Real inside = r < 1 ? Real(z > 0 ? 0.5 : -0.5) : Real(0);
  const Real axial = inside - z * cel(kc2, gamma * gamma, 1, gamma) / (pi * s * (1 + r));
  Vector H = axial * n;
  if (r > 0) H += radial / r * in_plane;
  return (Real(vacuum_permeability) * Real(sigma) * H).cast<double>();
}

}  // namespace ciliaval::oracle
