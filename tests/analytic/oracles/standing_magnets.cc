// SPDX-License-Identifier: LGPL-2.1-or-later
#include "tests/analytic/oracles/standing_magnets.h"

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
using Vector = Eigen::Matrix<Real, 3, 1>;

const Real& pi() {
  return boost::math::constants::pi<Real>();
}

template <class H>
FieldAndGradient rounded(const Vector3& x, bool with_gradient, const H& field) {
  const Vector at = x.cast<Real>();
  const Real mu0(vacuum_permeability);
  FieldAndGradient result;
  result.B = Vector(mu0 * field(at)).template cast<double>();
  if (!with_gradient) return result;
  const Real step = 1e-12 * x.norm();
  for (int j = 0; j < 3; ++j) {
    const Vector move = step * Vector::Unit(j);
    result.gradient.col(j) =
        Vector(mu0 * (field(at + move) - field(at - move)) / (2 * step)).template cast<double>();
  }
  return result;
}

/// H of a disc of unit charge about the z axis, outside of the cylinder over it.
Vector disc(const Real& R, const Vector& x) {
  const Real rho = sqrt(x[0] * x[0] + x[1] * x[1]);
  const Real r = rho / R;
  const Real z = x[2] / R;
  const Real s2 = z * z + (1 + r) * (1 + r);
  const Real kc2 = (z * z + (1 - r) * (1 - r)) / s2;
  const Real m = 1 - kc2;
  const Real k = sqrt(m);
  const Real K = boost::math::ellint_1(k);
  const Real E = boost::math::ellint_2(k);
  // ∫ cos 2φ/Δ dφ = K − 2D with D = (K − E)/m, and ∫ (cos²φ + γ sin²φ)/((cos²φ + γ² sin²φ) Δ) dφ.
  const Real gamma = (1 - r) / (1 + r);
  const Real n = 1 - gamma * gamma;
  const Real P = boost::math::ellint_3(k, n);
  const Real axial = P + (gamma - 1) / n * (P - K);
  const Real radial = -(K - 2 * (K - E) / m) / (pi() * sqrt(s2));
  const Real inside = r < 1 ? Real(z > 0 ? 0.5 : -0.5) : Real(0);
  return {radial * x[0] / rho, radial * x[1] / rho,
          inside - z * axial / (pi() * sqrt(s2) * (1 + r))};
}

/// H of a rectangle of unit charge in z = 0.
Vector rectangle(const Real& a, const Real& b, const Vector& x) {
  Vector H = Vector::Zero();
  for (const int s : {-1, 1})
    for (const int t : {-1, 1}) {
      const Real u = x[0] + s * a;
      const Real v = x[1] + t * b;
      const Real z = x[2];
      const Real r = sqrt(u * u + v * v + z * z);
      const int sign = s * t;
      H[0] -= sign * asinh(v / sqrt(u * u + z * z));
      H[1] -= sign * asinh(u / sqrt(v * v + z * z));
      H[2] += sign * atan(u * v / (z * r));
    }
  return H / (4 * pi());
}

/// H of two unlike faces; `face(x)` is that of the upper one about the origin.
template <class Face>
Vector two_faces(const Real& height, const Vector& x, const Face& face) {
  return face(Vector(x - height * Vector::Unit(2))) - face(x);
}

}  // namespace

FieldAndGradient standing_tube(double M, double radius, double inner_radius, double height,
                               const Vector3& x, bool with_gradient) {
  return rounded(x, with_gradient, [&](const Vector& at) -> Vector {
    return Real(M) * two_faces(height, at, [&](const Vector& y) -> Vector {
             const Vector outer = disc(radius, y);
             return inner_radius > 0 ? Vector(outer - disc(inner_radius, y)) : outer;
           });
  });
}

FieldAndGradient standing_cuboid(const Vector3& M, const Vector3& edges, const Vector3& x,
                                 bool with_gradient) {
  return rounded(x, with_gradient, [&](const Vector& at) {
    Vector H = Vector::Zero();
    const Vector centre = at - Real(edges[2]) / 2 * Vector::Unit(2);
    for (int k = 0; k < 3; ++k) {
      // The axes turned so that the k-th is the third.
      const auto turned = [k](int axis) { return (axis + k + 1) % 3; };
      const Vector own(centre[turned(0)], centre[turned(1)], centre[k]);
      const Real half = Real(edges[k]) / 2;
      const Vector part =
          Real(M[k]) * two_faces(2 * half, own + half * Vector::Unit(2), [&](const Vector& y) {
            return rectangle(Real(edges[turned(0)]) / 2, Real(edges[turned(1)]) / 2, y);
          });
      for (int axis = 0; axis < 3; ++axis) H[turned(axis)] += part[axis];
    }
    return H;
  });
}

FieldAndGradient standing_poles(double q, double height, const Vector3& x, bool with_gradient) {
  return rounded(x, with_gradient, [&](const Vector& at) -> Vector {
    return Real(q) / (4 * pi()) * two_faces(height, at, [](const Vector& y) -> Vector {
             const Real r = sqrt(y.dot(y));
             return y / (r * r * r);
           });
  });
}

}  // namespace ciliaval::oracle
