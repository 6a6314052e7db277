// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/contact/rigid_surface.h"

#include <Eigen/Geometry>
#include <cmath>

namespace ciliaval::fem::solid::contact {
namespace {

/// Distance of the points of a central difference, in the length of the finest feature.
constexpr double difference = 1e-4;

double second_derivative(const surroundings::Surface& surface, double xi) {
  const double finest = surface.finest_length();
  if (!std::isfinite(finest)) return 0;
  const double step = difference * finest;
  return (surface.extended(xi + step).slope - surface.extended(xi - step).slope) / (2 * step);
}

}  // namespace

SurfacePoint surface_point(const RigidSurface& surface, const Vector3& x) {
  const Vector3& e = surface.direction;
  const double xi = x.dot(e) - surface.travel;
  const auto [p, slope] = surface.profile->extended(xi);
  const double w = std::hypot(1, slope);
  const double second = second_derivative(*surface.profile, xi);
  const double h = surface.height - p - x.z();
  SurfacePoint point;
  point.gap = h / w;
  point.normal = (-slope * e - Vector3::UnitZ()) / w;
  point.gap_gradient = point.normal - h * slope * second / (w * w * w) * e;
  const Vector3 t = (e - slope * Vector3::UnitZ()) / w;
  const Vector3 b = t.cross(point.normal);
  point.tangents << t, b;
  point.curvature = second / (w * w);
  point.place = {xi, x.dot(b)};
  return point;
}

}  // namespace ciliaval::fem::solid::contact
