// SPDX-License-Identifier: LGPL-2.1-or-later
#include "analytic/rod/rod_quadrature.h"

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "analytic/sources/adaptive_order.h"
#include "analytic/sources/dipole.h"
#include "problem/error.h"

namespace ciliaval::analytic::rod {
namespace {

using Slices = VolumeOptions::Slices;

[[noreturn]] void throw_too_near(const Vector3& x) {
  throw SolverError("the quadrature of the model `volume` was asked at " + sources::to_string(x) +
                    ", inside the magnet or too near to it: take the closed form");
}

/// Numbers of nodes along S (of each part), r and φ.
using Orders = std::array<std::size_t, 3>;

/// Unit vectors towards the nodes of the trapezoidal rule.
std::vector<Eigen::Vector2d> directions(std::size_t n) {
  std::vector<Eigen::Vector2d> nodes(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double phi = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(n);
    nodes[i] = {std::cos(phi), std::sin(phi)};
  }
  return nodes;
}

/// B of the slice of unit thickness at `point`.
Vector3 slice_field(const RodStretch& stretch, const CentrelinePoint& point, double radius,
                    Slices slices, const QuadratureRule& radial,
                    const std::vector<Eigen::Vector2d>& azimuthal, const Vector3& x) {
  const Matrix3 directors = point.rotation.toRotationMatrix();
  const double angle = 2 * std::numbers::pi / static_cast<double>(azimuthal.size());
  Vector3 B = Vector3::Zero();
  for (std::size_t j = 0; j < radial.nodes.size(); ++j) {
    const double r = radius * radial.nodes[j];
    Vector3 ring = Vector3::Zero();
    for (const Eigen::Vector2d& direction : azimuthal) {
      const Vector3 y = point.position + r * (directors.leftCols<2>() * direction);
      const Vector3 a = slices == Slices::wedge ? stretch_vector(point, y) : directors.col(2);
      ring += sources::dipole_field(carried_magnetization(stretch, point, a), x - y);
    }
    B += radius * radial.weights[j] * r * angle * ring;
  }
  return B;
}

Vector3 rod_field(const RodMagnet& magnet, Slices slices, const std::vector<RodStretch>& parts,
                  const Orders& orders, const Vector3& x) {
  if (orders[0] * orders[1] * orders[2] * parts.size() > 20'000'000) throw_too_near(x);
  const QuadratureRule& axial = sources::unit_gauss_legendre(orders[0]);
  const QuadratureRule& radial = sources::unit_gauss_legendre(orders[1]);
  const std::vector<Eigen::Vector2d> azimuthal = directions(orders[2]);
  Vector3 B = Vector3::Zero();
  for (const RodStretch& part : parts) {
    const double length = part.end - part.begin;
    for (std::size_t i = 0; i < orders[0]; ++i) {
      const CentrelinePoint point = at(magnet, part, part.begin + axial.nodes[i] * length);
      B += axial.weights[i] * length *
           slice_field(part, point, magnet.radius, slices, radial, azimuthal, x);
    }
  }
  return B;
}

}  // namespace

sources::FieldValue rod_field_by_quadrature(const RodMagnet& magnet, const RodInterior& interior,
                                            Slices slices, double tolerance, const Vector3& x) {
  if (interior.magnetization_at(x)) throw_too_near(x);
  const auto parts = graded_stretches(
      magnet,
      [&](const CentrelinePoint& point) {
        return sources::distance_from_disc(section(magnet, point), x);
      },
      1e-4 * magnet.radius);
  if (!parts) throw_too_near(x);
  if (parts->empty()) return {};
  Orders orders{6, 6, 12};
  while (true) {
    sources::FieldValue value{rod_field(magnet, slices, *parts, orders, x), Vector3::Zero()};
    const double allowed = tolerance * value.B.norm() / 3;
    Orders next = orders;
    for (std::size_t direction = 0; direction < 3; ++direction) {
      Orders raised = orders;
      raised[direction] += raised[direction] / 2;
      const Vector3 change = (rod_field(magnet, slices, *parts, raised, x) - value.B).cwiseAbs();
      value.uncertainty += change;
      if (change.norm() > allowed) next[direction] = raised[direction];
      // Sums of some thousand terms are rounded at this level: a higher order changes no more.
      if (change.norm() > allowed && change.norm() < 1e-14 * value.B.norm())
        sources::throw_tolerance_missed({tolerance, 0, "quadrature of the model `volume`", x},
                                        change.norm() / value.B.norm());
    }
    if (next == orders) return value;
    orders = next;
  }
}

}  // namespace ciliaval::analytic::rod
