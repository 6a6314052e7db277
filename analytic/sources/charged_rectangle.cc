// SPDX-License-Identifier: LGPL-2.1-or-later
#include "analytic/sources/charged_rectangle.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "problem/types.h"

namespace ciliaval::analytic::sources {
namespace {

/// asinh(v₂/ρ) − asinh(v₁/ρ), v₁ < v₂, which is finite beside the edge's line where ρ = 0.
double difference_of_asinh(double v1, double v2, double rho) {
  if (v2 < 0) return difference_of_asinh(-v2, -v1, rho);
  if (v1 > 0) return std::log((v2 + std::hypot(v2, rho)) / (v1 + std::hypot(v1, rho)));
  return std::asinh(v2 / rho) - std::asinh(v1 / rho);
}

/// The component along u, and the sum of its terms' magnitudes.
std::pair<double, double> in_plane(double a, double b, double u, double v, double z) {
  const double upper = difference_of_asinh(v - b, v + b, std::hypot(u + a, z));
  const double lower = difference_of_asinh(v - b, v + b, std::hypot(u - a, z));
  return {lower - upper, std::abs(lower) + std::abs(upper)};
}

std::pair<double, double> across(double a, double b, const Vector3& x) {
  double sum = 0;
  double magnitude = 0;
  for (const double s : {-1.0, 1.0}) {
    for (const double t : {-1.0, 1.0}) {
      const double u = x.x() + s * a;
      const double v = x.y() + t * b;
      if (u == 0 || v == 0) continue;
      const double term = std::atan(u * v / (x.z() * std::hypot(u, v, x.z())));
      sum += s * t * term;
      magnitude += std::abs(term);
    }
  }
  return {sum, magnitude};
}

}  // namespace

FieldValue charged_rectangle_field(const std::array<double, 2>& half_sides, const Vector3& x) {
  const auto [a, b] = half_sides;
  const auto [H_x, size_x] = in_plane(a, b, x.x(), x.y(), x.z());
  const auto [H_y, size_y] = in_plane(b, a, x.y(), x.x(), x.z());
  const auto [H_z, size_z] = across(a, b, x);
  constexpr double factor = 1 / (4 * std::numbers::pi);
  return {factor * Vector3(H_x, H_y, H_z), 8 * epsilon * factor * Vector3(size_x, size_y, size_z)};
}

double distance_from_edge(const std::array<double, 2>& half_sides, const Vector3& x) {
  const double dx = std::abs(x.x()) - half_sides[0];
  const double dy = std::abs(x.y()) - half_sides[1];
  // Inside the nearest side; outside of one or both the nearest point of the rectangle is its edge.
  const double in_plane =
      dx < 0 && dy < 0 ? -std::max(dx, dy) : std::hypot(std::max(dx, 0.0), std::max(dy, 0.0));
  return std::hypot(in_plane, x.z());
}

}  // namespace ciliaval::analytic::sources
