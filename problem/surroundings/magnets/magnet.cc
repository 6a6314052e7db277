// SPDX-License-Identifier: LGPL-2.1-or-later
#include "problem/surroundings/magnets/magnet.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

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

/// Distance from the convex body whose nearest point to x is nearest(x), by projections on the two
/// in turn, which converge to the nearest pair (Cheney & Goldstein, Proc. AMS 10, 1959).
template <class Nearest>
double distance_from_convex(const Magnet& magnet, double size, const Nearest& nearest) {
  Vector3 x = magnet.position;
  double gap = 0;
  double previous = -1;
  for (int i = 0; i < 100'000; ++i) {
    const Vector3 y = nearest(x);
    x = nearest_point(magnet, y);
    gap = (x - y).norm();
    if (gap < 1e-9 * size) return 0;
    if (std::abs(gap - previous) < 1e-12 * gap) break;
    previous = gap;
  }
  return gap;
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
  return distance_from_convex(magnet, cylinder_radius, [&](const Vector3& x) {
    return nearest_in_cylinder(cylinder_radius, 0, height, x);
  });
}

double distance_from_disc(const Magnet& magnet, const Vector3& centre, const Vector3& normal,
                          double disc_radius) {
  return distance_from_convex(magnet, disc_radius, [&](const Vector3& x) -> Vector3 {
    const Vector3 offset = x - centre;
    const Vector3 radial = offset - offset.dot(normal) * normal;
    const double rho = radial.norm();
    return centre + (rho > disc_radius ? disc_radius / rho : 1) * radial;
  });
}

double asymmetry(const Magnet& magnet, const Vector3& n) {
  const auto along = [&n](const Vector3& v) {
    return v.isZero(0) ? 0.0 : std::abs(v.dot(n)) / v.norm();
  };
  double largest = std::max(along(moment(magnet)), along(magnet.position));
  if (magnet.shape != Shape::cuboid) return largest;
  const Vector3 own = (magnet.rotation.conjugate() * n).cwiseAbs();
  Eigen::Index axis = 0;
  own.maxCoeff(&axis);
  const Vector3 rest = own - own[axis] * Vector3::Unit(axis);
  return std::max(largest, rest.norm());
}

std::vector<Magnet> superposed(double a, const std::vector<Magnet>& x, double b,
                               const std::vector<Magnet>& y) {
  std::vector<Magnet> sum;
  const auto append = [&](double factor, Magnet magnet) {
    if (factor == 0 || magnet.magnetization.isZero(0)) return;
    magnet.magnetization *= factor;
    for (Magnet& there : sum) {
      const Vector3 other = std::exchange(there.magnetization, magnet.magnetization);
      const bool is_same = there == magnet;
      there.magnetization = is_same ? Vector3(other + magnet.magnetization) : other;
      if (is_same) return;
    }
    sum.push_back(std::move(magnet));
  };
  for (const Magnet& magnet : x) append(a, magnet);
  for (const Magnet& magnet : y) append(b, magnet);
  return sum;
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
