// SPDX-License-Identifier: LGPL-2.1-or-later
#include "problem/surroundings/environment.h"

#include <algorithm>
#include <cmath>

#include "problem/error.h"

namespace ciliaval::surroundings {

std::string_view name(MagneticEnergy energy) {
  return energy == MagneticEnergy::F ? "F" : "R";
}

bool is_empty(const Environment& environment) {
  return environment.gravity.isZero(0) && environment.uniform_field.isZero(0) &&
         std::ranges::all_of(environment.magnets,
                             [](const auto& magnet) { return magnet.magnetization.isZero(0); });
}

Environment scaled(const Environment& environment, double factor) {
  Environment result = environment;
  result.gravity *= factor;
  result.uniform_field *= factor;
  for (magnets::Magnet& magnet : result.magnets) magnet.magnetization *= factor;
  return result;
}

Environment interpolate(const Environment& from, const Environment& to, double t) {
  Environment result = to;
  result.gravity = (1 - t) * from.gravity + t * to.gravity;
  result.uniform_field = (1 - t) * from.uniform_field + t * to.uniform_field;
  result.magnets = magnets::superposed(1 - t, from.magnets, t, to.magnets);
  return result;
}

Environment turned(const Environment& environment, double angle) {
  const Eigen::AngleAxisd turn(angle, Vector3::UnitZ());
  Environment result = environment;
  result.gravity = turn * environment.gravity;
  result.uniform_field = turn * environment.uniform_field;
  for (magnets::Magnet& magnet : result.magnets) {
    magnet.position = turn * magnet.position;
    magnet.rotation = turn * magnet.rotation;
  }
  return result;
}

double component(const Environment& environment, const Vector3& n) {
  const auto along = [&n](const Vector3& v) {
    return v.isZero(0) ? 0.0 : std::abs(v.dot(n)) / v.norm();
  };
  double largest = std::max(along(environment.gravity), along(environment.uniform_field));
  for (const magnets::Magnet& magnet : environment.magnets)
    largest = std::max(largest, magnets::asymmetry(magnet, n));
  return largest;
}

Vector3 weight_per_volume(const Environment& environment, const Segment& segment) {
  if (environment.gravity.isZero(0)) return Vector3::Zero();
  return (segment.density - environment.fluid_density) * environment.gravity;
}

magnets::FieldJet field_of_magnets(const Environment& environment, const Vector3& x) {
  return magnets::jet(environment.magnets, x);
}

Vector3 pole_force(const Environment& environment, const Cilium& cilium, std::size_t segment) {
  return cilium.segments[segment].magnetization * cilium.area() * environment.uniform_field;
}

std::vector<Vector3> pole_forces(const Environment& environment, const Cilium& cilium) {
  std::vector<Vector3> forces(cilium.segments.size() + 1, Vector3::Zero());
  for (std::size_t i = 0; i < cilium.segments.size(); ++i) {
    const Vector3 force = pole_force(environment, cilium, i);
    forces[i] -= force;
    forces[i + 1] += force;
  }
  return forces;
}

std::optional<std::string> touched_magnet(const Environment& environment, const Cilium& cilium,
                                          const Centreline& centreline) {
  const double R = cilium.radius();
  for (const magnets::Magnet& magnet : environment.magnets)
    for (std::size_t piece = 0; piece < centreline.pieces().size(); ++piece)
      for (std::size_t i = 0; i < centreline.pieces()[piece].S.size(); ++i) {
        const CentrelinePoint point = centreline.node(piece, i);
        if (magnets::distance(magnet, point.position) <= R &&
            magnets::distance_from_disc(magnet, point.position, point.normal(), R) == 0)
          return magnet.name;
      }
  return std::nullopt;
}

void require_valid(const Environment& environment, const Cilium& cilium) {
  if (!environment.gravity.allFinite()) throw InputError("gravity must be finite");
  if (!environment.uniform_field.allFinite()) throw InputError("the uniform field must be finite");
  if (!(std::isfinite(environment.fluid_density) && environment.fluid_density >= 0))
    throw InputError("the fluid's density must be finite and not negative");
  for (const magnets::Magnet& magnet : environment.magnets) {
    magnets::require_valid(magnet);
    if (magnets::distance_from_upright_cylinder(magnet, cilium.radius(), cilium.length()) == 0)
      throw InputError("magnet '" + magnet.name + "' touches the straight cilium: move it away");
  }
  if (environment.gravity.isZero(0)) return;
  for (const Segment& segment : cilium.segments)
    if (segment.density == 0)
      throw InputError("segment '" + segment.name +
                       "' has no density, without which gravity cannot act on it");
}

}  // namespace ciliaval::surroundings
