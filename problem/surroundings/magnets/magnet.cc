// SPDX-License-Identifier: LGPL-2.1-or-later
#include "problem/surroundings/magnets/magnet.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "problem/error.h"

namespace ciliaval::surroundings::magnets {
namespace {

/// The point of the cylinder |(x, y)| ≤ radius, low ≤ z ≤ high that is nearest to x.
Vector3 nearest_in_cylinder(double cylinder_radius, double low, double high, const Vector3& x) {
  const double rho = x.head<2>().norm();
  Vector3 result = x;
  if (rho > cylinder_radius) result.head<2>() *= cylinder_radius / rho;
  result.z() = std::clamp(x.z(), low, high);
  return result;
}

/// The same for the magnet, in its own axes.
Vector3 nearest_in_own_axes(const Magnet& magnet, const Vector3& x) {
  switch (magnet.shape) {
    case Shape::ball: {
      const double r = x.norm();
      return r > magnet.diameter / 2 ? Vector3(magnet.diameter / 2 / r * x) : x;
    }
    case Shape::cylinder:
      return nearest_in_cylinder(magnet.diameter / 2, -magnet.length / 2, magnet.length / 2, x);
    case Shape::cuboid:
      return x.cwiseMax(-magnet.edges / 2).cwiseMin(magnet.edges / 2);
  }
  return x;
}

}  // namespace

std::string_view name(Shape shape) {
  constexpr std::array<std::string_view, 3> names{"ball", "cylinder", "cuboid"};
  return names[static_cast<std::size_t>(shape)];
}

bool Magnet::operator==(const Magnet& other) const {
  return name == other.name && shape == other.shape && position == other.position &&
         rotation.coeffs() == other.rotation.coeffs() && diameter == other.diameter &&
         length == other.length && edges == other.edges && magnetization == other.magnetization;
}

double volume(const Magnet& magnet) {
  const double section = std::numbers::pi * magnet.diameter * magnet.diameter / 4;
  switch (magnet.shape) {
    case Shape::ball:
      return 2 * section * magnet.diameter / 3;
    case Shape::cylinder:
      return section * magnet.length;
    case Shape::cuboid:
      return magnet.edges.prod();
  }
  return 0;
}

Vector3 moment(const Magnet& magnet) {
  return volume(magnet) * (magnet.rotation * magnet.magnetization);
}

double radius(const Magnet& magnet) {
  switch (magnet.shape) {
    case Shape::ball:
      return magnet.diameter / 2;
    case Shape::cylinder:
      return std::hypot(magnet.diameter, magnet.length) / 2;
    case Shape::cuboid:
      return magnet.edges.norm() / 2;
  }
  return 0;
}

Vector3 nearest_point(const Magnet& magnet, const Vector3& x) {
  const Vector3 own = magnet.rotation.conjugate() * (x - magnet.position);
  const Vector3 nearest = nearest_in_own_axes(magnet, own);
  return nearest == own ? x : Vector3(magnet.position + magnet.rotation * nearest);
}

double distance(const Magnet& magnet, const Vector3& x) {
  return (x - nearest_point(magnet, x)).norm();
}

double distance_from_upright_cylinder(const Magnet& magnet, double cylinder_radius, double height) {
  Vector3 x = magnet.position;
  double previous = -1;
  for (int i = 0; i < 100'000; ++i) {  // Cheney & Goldstein 1959: converges to the nearest pair
    const Vector3 y = nearest_in_cylinder(cylinder_radius, 0, height, x);
    x = nearest_point(magnet, y);
    const double gap = (x - y).norm();
    if (gap < 1e-9 * cylinder_radius) return 0;
    if (std::abs(gap - previous) < 1e-12 * gap) return gap;
    previous = gap;
  }
  return previous;
}

void require_valid(const Magnet& magnet) {
  const auto refuse = [&](const std::string& what) {
    throw InputError("magnet '" + magnet.name + "': " + what);
  };
  const auto positive = [](double value) { return std::isfinite(value) && value > 0; };
  if (!magnet.position.allFinite()) refuse("the position must be finite");
  if (!(std::abs(magnet.rotation.norm() - 1) < 1e-9)) refuse("the rotation must be of unit length");
  if (!magnet.magnetization.allFinite()) refuse("the magnetization must be finite");
  if (magnet.shape == Shape::cuboid) {
    if (!(positive(magnet.edges[0]) && positive(magnet.edges[1]) && positive(magnet.edges[2])))
      refuse("the edges must be finite and positive");
    return;
  }
  if (!positive(magnet.diameter)) refuse("the diameter must be finite and positive");
  if (magnet.shape != Shape::cylinder) return;
  if (!positive(magnet.length)) refuse("the length must be finite and positive");
  if (!magnet.magnetization.head<2>().isZero(0))
    refuse(
        "a cylinder is magnetised along its axis only: across it the field has no closed form "
        "here; take a cuboid or a ball");
}

}  // namespace ciliaval::surroundings::magnets
