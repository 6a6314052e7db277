// SPDX-License-Identifier: LGPL-2.1-or-later
#include "problem/surroundings/magnets/field.h"

#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>

#include "problem/error.h"
#include "problem/field_model.h"
#include "problem/lagrange.h"
#include "problem/surroundings/magnets/disc.h"

namespace ciliaval::surroundings::magnets {
namespace {

constexpr double over_four_pi = 1 / (4 * std::numbers::pi);

/// log(z + r) with p² = x² + y², but for log p² where z < 0, which cancels between the two ends of
/// an edge unless the point is beside it.
double log_sum(double z, double r, double p2) {
  return z >= 0 ? std::log(z + r) : std::log(p2 / (r - z));
}

/// z + r without cancellation.
double sum(double z, double r, double p2) {
  return z >= 0 ? z + r : p2 / (r - z);
}

/// −atan(y/x); on the line through an edge, where it cancels between the edge's ends, 0.
double minus_arc(double y, double x) {
  return y == 0 ? 0 : -std::atan(y / x);
}

/// The derivatives of second to fourth order of G, ∂x∂y∂zG = 1/r, that a magnetisation M is
/// contracted with: B = M·∇∇G.
FieldJet corner(const Vector3& M, const Vector3& a) {
  const double r = a.norm();
  Matrix3 second;
  // g_c = 1/(r(c + r)) for c = x, y, z, so that ∂x∂x∂yG = x g_z.
  std::array<double, 3> g;
  for (int c = 0; c < 3; ++c) {
    const int i = (c + 1) % 3;
    const int j = (c + 2) % 3;
    const double p2 = a[i] * a[i] + a[j] * a[j];
    second(i, j) = second(j, i) = log_sum(a[c], r, p2);
    second(c, c) = minus_arc(a[i] * a[j], a[c] * r);
    g[static_cast<std::size_t>(c)] = 1 / (r * sum(a[c], r, p2));
  }
  const auto G = [&](int c) { return g[static_cast<std::size_t>(c)]; };
  // (∂g_c/∂b)/b for an axis b ≠ c: ∂[r(c + r)]/∂b = b (c + 2r)/r.
  const auto slope = [&](int c) { return -G(c) * G(c) * (a[c] / r + 2); };
  // Third derivatives: T(i, j, k).
  const auto third = [&](int i, int j, int k) {
    if (i != j && j != k && i != k) return 1 / r;
    if (i == j && j == k) {
      const int b = (i + 1) % 3;
      const int c = (i + 2) % 3;
      return -a[b] * G(c) - a[c] * G(b);  // ΔG is constant
    }
    // Two alike, d, and another, o; the third axis is 3 − d − o. ∂d∂d∂oG = a_d g.
    const int d = i == j || i == k ? i : j;
    const int o = i + j + k - 2 * d;
    return a[d] * G(3 - d - o);
  };
  // ∂d²∂o²G and ∂d³∂oG of two axes with the third c.
  const auto two_two = [&](int d, int o) {
    const int c = 3 - d - o;
    return a[d] * a[o] * slope(c);
  };
  const auto three_one = [&](int d, int o) {
    const int c = 3 - d - o;
    return G(c) + a[d] * a[d] * slope(c);
  };
  const double r3 = r * r * r;
  const auto fourth = [&](int i, int j, int k, int l) {
    std::array<int, 3> count{};
    for (const int axis : {i, j, k, l}) ++count[static_cast<std::size_t>(axis)];
    const auto n = [&](int axis) { return count[static_cast<std::size_t>(axis)]; };
    for (int d = 0; d < 3; ++d) {
      const int b = (d + 1) % 3;
      const int c = (d + 2) % 3;
      if (n(d) == 4) return -two_two(d, b) - two_two(d, c);
      if (n(d) == 3) return three_one(d, n(b) == 1 ? b : c);
      if (n(d) == 2 && n(b) == 1) return -a[d] / r3;
      if (n(d) == 2 && n(b) == 2) return two_two(d, b);
    }
    return 0.0;  // not reached: four indices of three values
  };
  FieldJet jet;
  jet.B = second * M;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int m = 0; m < 3; ++m) {
        jet.gradient(i, j) += third(i, j, m) * M[m];
        for (int k = 0; k < 3; ++k)
          jet.second[static_cast<std::size_t>(k)](i, j) += fourth(i, j, k, m) * M[m];
      }
  return jet;
}

/// B/μ₀ of a cuboid with the half edges h in its own axes.
FieldJet cuboid_jet(const Vector3& h, const Vector3& M, const Vector3& x) {
  // By symmetry the point is taken to where x, y, z ≥ 0: there no corner's log is singular outside.
  const Vector3 sign(std::copysign(1, x[0]), std::copysign(1, x[1]), std::copysign(1, x[2]));
  const Vector3 point = x.cwiseAbs();
  FieldJet jet;
  for (int i = 0; i < 8; ++i) {
    const Vector3 side(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
    jet += -side.prod() * corner(sign.cwiseProduct(M), point - side.cwiseProduct(h));
  }
  jet = over_four_pi * jet;
  const auto flip = sign.asDiagonal();
  jet.B = flip * jet.B;
  jet.gradient = Matrix3(flip * jet.gradient * flip);
  for (int k = 0; k < 3; ++k) {
    Matrix3& second = jet.second[static_cast<std::size_t>(k)];
    second = Matrix3(sign[k] * (flip * second * flip));
  }
  return jet;
}

/// The same by Gauss's rule with n³ dipoles.
FieldJet cuboid_of_dipoles(const Vector3& h, const Vector3& M, const Vector3& x, std::size_t n) {
  const QuadratureRule rule = gauss_legendre(n);
  FieldJet jet;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j)
      for (std::size_t k = 0; k < n; ++k) {
        const Vector3 y(rule.nodes[i], rule.nodes[j], rule.nodes[k]);
        const double weight = rule.weights[i] * rule.weights[j] * rule.weights[k];
        jet += dipole_jet(weight * h.prod() * M, x - h.cwiseProduct(y));
      }
  return jet;
}

FieldJet jet_in_own_axes(const Magnet& magnet, const Vector3& x) {
  switch (magnet.shape) {
    case Shape::ball:
      return dipole_jet(volume(magnet) * magnet.magnetization, x);
    case Shape::cuboid: {
      const double radii = x.norm() / radius(magnet);
      if (radii < 6)
        return vacuum_permeability * cuboid_jet(magnet.edges / 2, magnet.magnetization, x);
      return cuboid_of_dipoles(magnet.edges / 2, magnet.magnetization, x, radii < 12 ? 8 : 5);
    }
    case Shape::cylinder: {
      const Vector3 half(0, 0, magnet.length / 2);
      FieldJet jet = disc_jet(magnet.diameter / 2, x - half);
      jet += -1.0 * disc_jet(magnet.diameter / 2, x + half);
      return vacuum_permeability * magnet.magnetization[2] * jet;
    }
  }
  return {};
}

}  // namespace

FieldJet& FieldJet::operator+=(const FieldJet& other) {
  B += other.B;
  gradient += other.gradient;
  for (std::size_t k = 0; k < 3; ++k) second[k] += other.second[k];
  return *this;
}

FieldJet operator*(double factor, const FieldJet& jet) {
  FieldJet result = jet;
  result.B *= factor;
  result.gradient *= factor;
  for (Matrix3& matrix : result.second) matrix *= factor;
  return result;
}

FieldJet dipole_jet(const Vector3& m, const Vector3& a) {
  const double r2 = a.squaredNorm();
  const double c3 = vacuum_permeability * over_four_pi / (r2 * std::sqrt(r2));
  const double c5 = 3 * c3 / r2;
  const double c7 = 5 * c5 / r2;
  const double c9 = 7 * c7 / r2;
  const double s = m.dot(a);
  const Matrix3 ma = m * a.transpose() + a * m.transpose();
  const Matrix3 aa = a * a.transpose();
  FieldJet jet;
  jet.B = c5 * s * a - c3 * m;
  jet.gradient = c5 * (ma + s * Matrix3::Identity()) - c7 * s * aa;
  for (int k = 0; k < 3; ++k) {
    const Vector3 e = Vector3::Unit(k);
    const Matrix3 ea = e * a.transpose() + a * e.transpose();
    const Matrix3 em = e * m.transpose() + m * e.transpose();
    jet.second[static_cast<std::size_t>(k)] =
        c9 * s * a[k] * aa - c7 * (m[k] * aa + a[k] * ma + s * (ea + a[k] * Matrix3::Identity())) +
        c5 * (em + m[k] * Matrix3::Identity());
  }
  return jet;
}

FieldJet jet(const Magnet& magnet, const Vector3& x) {
  if (!(distance(magnet, x) > 1e-12 * radius(magnet))) {
    char point[96];
    std::snprintf(point, sizeof point, "(%.6g, %.6g, %.6g) m", x[0], x[1], x[2]);
    throw SolverError("the field of the magnet '" + magnet.name + "' was asked at " + point +
                      ", which is inside it: move the magnet away from the cilium");
  }
  const Matrix3 R = magnet.rotation.toRotationMatrix();
  const FieldJet own = jet_in_own_axes(magnet, R.transpose() * (x - magnet.position));
  FieldJet jet;
  jet.B = R * own.B;
  jet.gradient = R * own.gradient * R.transpose();
  for (int k = 0; k < 3; ++k)
    for (int m = 0; m < 3; ++m)
      jet.second[static_cast<std::size_t>(k)] +=
          R(k, m) * (R * own.second[static_cast<std::size_t>(m)] * R.transpose());
  return jet;
}

FieldJet jet(const std::vector<Magnet>& magnets, const Vector3& x) {
  FieldJet sum;
  for (const Magnet& magnet : magnets) sum += jet(magnet, x);
  return sum;
}

}  // namespace ciliaval::surroundings::magnets
