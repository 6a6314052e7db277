// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/contact/rigid_surface.h"

#include <Eigen/Geometry>
#include <cmath>

namespace ciliaval::fem::solid::contact {
namespace {

SurfacePoint point_of_pin(const RigidSurface& surface, const Vector3& x) {
  const Vector3& e = surface.direction;
  const double aside = x.dot(e) - surface.travel;
  const double above = x.z() - surface.height;
  const double distance = std::hypot(aside, above);
  SurfacePoint point;
  point.gap = distance - surface.pin;
  point.normal = (aside * e + above * Vector3::UnitZ()) / distance;
  point.gap_gradient = point.normal;
  const Vector3 t = (aside * Vector3::UnitZ() - above * e) / distance;
  const Vector3 b = t.cross(point.normal);
  point.tangents << t, b;
  point.place_gradient = surface.pin / distance * t;
  point.curvature = -1 / surface.pin;
  point.place = {surface.pin * std::atan2(above, aside), x.dot(b)};
  return point;
}

}  // namespace

SurfacePoint surface_point(const RigidSurface& surface, const Vector3& x) {
  if (surface.profile == nullptr) return point_of_pin(surface, x);
  const Vector3& e = surface.direction;
  const double xi = x.dot(e) - surface.travel;
  const auto [p, slope, second] = surface.profile->extended(xi);
  const double w = std::hypot(1, slope);
  const double h = surface.height - p - x.z();
  SurfacePoint point;
  point.gap = h / w;
  point.normal = (-slope * e - Vector3::UnitZ()) / w;
  point.gap_gradient = point.normal - h * slope * second / (w * w * w) * e;
  const Vector3 t = (e - slope * Vector3::UnitZ()) / w;
  const Vector3 b = t.cross(point.normal);
  point.tangents << t, b;
  point.place_gradient = e;
  point.curvature = second / (w * w);
  point.place = {xi, x.dot(b)};
  return point;
}

}  // namespace ciliaval::fem::solid::contact
