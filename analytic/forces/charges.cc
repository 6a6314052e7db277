// SPDX-License-Identifier: LGPL-2.1-or-later
#include "analytic/forces/charges.h"

#include <cmath>
#include <numbers>

#include "analytic/rod/mantle.h"
#include "problem/lagrange.h"
#include "problem/support/rotation.h"

namespace ciliaval::analytic::forces {
namespace {

using surroundings::magnets::Magnet;
using surroundings::magnets::Shape;

/// Unit vectors around the third axis.
std::vector<Vector3> directions(std::size_t n) {
  std::vector<Vector3> result;
  for (std::size_t i = 0; i < n; ++i) {
    const double phi = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(n);
    result.emplace_back(std::cos(phi), std::sin(phi), 0);
  }
  return result;
}

/// A disc of charge σ, its axes in the columns.
void append_disc(const Vector3& centre, const Matrix3& axes, double radius, double sigma,
                 std::size_t order, std::vector<PointCharge>& charges) {
  const QuadratureRule rule = gauss_legendre(order, 0, radius);
  const std::vector<Vector3> around = directions(2 * order);
  const double angle = std::numbers::pi / static_cast<double>(order);
  for (std::size_t i = 0; i < order; ++i)
    for (const Vector3& e : around)
      charges.push_back(
          {centre + axes * (rule.nodes[i] * e), sigma * rule.weights[i] * rule.nodes[i] * angle});
}

/// A rectangle of charge σ about the centre, with the half sides a and b as vectors.
void append_rectangle(const Vector3& centre, const Vector3& a, const Vector3& b, double sigma,
                      std::size_t order, std::vector<PointCharge>& charges) {
  const QuadratureRule rule = gauss_legendre(order);
  const double area = a.norm() * b.norm();
  for (std::size_t i = 0; i < order; ++i)
    for (std::size_t j = 0; j < order; ++j)
      charges.push_back({centre + rule.nodes[i] * a + rule.nodes[j] * b,
                         sigma * area * rule.weights[i] * rule.weights[j]});
}

void append_ball(const Magnet& magnet, std::size_t order, std::vector<PointCharge>& charges) {
  const QuadratureRule rule = gauss_legendre(order);
  const double R = magnet.diameter / 2;
  const double angle = std::numbers::pi / static_cast<double>(order);
  for (std::size_t i = 0; i < order; ++i)
    for (const Vector3& e : directions(2 * order)) {
      const double z = rule.nodes[i];
      const Vector3 n = std::sqrt(1 - z * z) * e + z * Vector3::UnitZ();
      charges.push_back({magnet.position + magnet.rotation * (R * n),
                         magnet.magnetization.dot(n) * R * R * rule.weights[i] * angle});
    }
}

/// Any two axes across a unit vector, and it.
Matrix3 axes_about(const Vector3& normal) {
  return support::turn_to(normal).toRotationMatrix();
}

}  // namespace

Charges charges_of(const Magnet& magnet) {
  return [magnet](std::size_t order) {
    std::vector<PointCharge> charges;
    const Matrix3 axes = magnet.rotation.toRotationMatrix();
    if (magnet.shape == Shape::ball) append_ball(magnet, order, charges);
    for (const double side : {-1.0, 1.0}) {
      if (magnet.shape == Shape::cylinder)
        append_disc(magnet.position + side * magnet.length / 2 * axes.col(2), axes,
                    magnet.diameter / 2, side * magnet.magnetization[2], order, charges);
      if (magnet.shape != Shape::cuboid) continue;
      for (int n = 0; n < 3; ++n) {
        const auto half = [&](int axis) -> Vector3 {
          return magnet.edges[axis % 3] / 2 * axes.col(axis % 3);
        };
        append_rectangle(magnet.position + side * half(n), half(n + 1), half(n + 2),
                         side * magnet.magnetization[n], order, charges);
      }
    }
    return charges;
  };
}

Charges charges_of(const rod::RodMagnet& magnet) {
  return [magnet](std::size_t order) {
    std::vector<PointCharge> charges;
    const QuadratureRule rule = gauss_legendre(order, 0, 1);
    for (const rod::MantlePatch& patch : rod::mantle_patches(magnet))
      for (std::size_t i = 0; i < order; ++i)
        for (std::size_t j = 0; j < order; ++j) {
          const auto [position, strength] = patch({rule.nodes[i], rule.nodes[j]});
          charges.push_back({position, rule.weights[i] * rule.weights[j] * strength});
        }
    for (const rod::RodEnd& end : magnet.ends) {
      if (end.rectangle) {
        const auto& [axes, half] = *end.rectangle;
        append_rectangle(end.section.centre, half[0] * axes.col(0), half[1] * axes.col(1),
                         end.magnetization_jump, order, charges);
        continue;
      }
      append_disc(end.section.centre, axes_about(end.section.normal), end.section.radius,
                  end.magnetization_jump, order, charges);
    }
    return charges;
  };
}

Charges poles_of(const rod::RodMagnet& magnet) {
  return [ends = magnet.ends](std::size_t) {
    std::vector<PointCharge> charges;
    charges.reserve(ends.size());
    for (const rod::RodEnd& end : ends)
      charges.push_back({end.section.centre, rod::pole_strength(end)});
    return charges;
  };
}

Charges charges_of(const SolidBody& body) {
  return [&body](std::size_t order) {
    const QuadratureRule rule = gauss_legendre(order, 0, 1);
    std::vector<PointCharge> charges;
    for (const ChargedFace& face : body.charged_faces)
      for (std::size_t i = 0; i < order; ++i)
        for (std::size_t j = 0; j < order; ++j) {
          const FacePoint point = evaluate(body.nodes, face, rule.nodes[i], rule.nodes[j]);
          charges.push_back({point.current, rule.weights[i] * rule.weights[j] *
                                                face.magnetization_jump.dot(point.reference_area)});
        }
    return charges;
  };
}

}  // namespace ciliaval::analytic::forces
