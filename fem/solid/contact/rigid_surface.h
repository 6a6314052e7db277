// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include "problem/surroundings/surface.h"
#include "problem/types.h"

namespace ciliaval::fem::solid::contact {

/// A rigid surface at its place. That of a sweep: z = height − p(ξ), ξ = x·e − travel. That of a
/// pin: a cylinder of the radius r about the horizontal line across e at x·e = travel, z = height.
struct RigidSurface {
  const surroundings::Surface* profile = nullptr;  ///< p; none: a pin
  double pin = 0;                                  ///< r, m
  double friction = 0;                             ///< Coulomb's μ
  Vector3 direction = Vector3::UnitX();            ///< e, horizontal
  double height = 0;                               ///< H, m
  double travel = 0;                               ///< s, m

  /// Displacement of the surface itself between two places, m.
  Vector3 displacement_from(const RigidSurface& before) const {
    return (travel - before.travel) * direction + (height - before.height) * Vector3::UnitZ();
  }
};

/// A point of the body over the surface's point with the same ξ. With h = H − p − z and
/// w = √(1 + p′²),
///
///   g = h/w,   n = (−p′ e − e_z)/w,   t = (e − p′ e_z)/w,   b = t × n,
///   ∂g/∂x = n − h p′p″/w³ e,   ∂n/∂ξ = −p″/w² t,   ∂t/∂ξ = p″/w² n.
///
/// g = 0 is the surface itself; near it g is the distance, to first order. On a pin, at the
/// distance d from its axis,
///
///   g = d − r,   ∂g/∂x = n,   ∂ξ/∂x = (r/d) t,   ∂n/∂ξ = t/r,   ∂t/∂ξ = −n/r,
///
/// with t = n turned upwards.
struct SurfacePoint {
  double gap = 0;                          ///< g, m; negative where the body penetrates
  Vector3 gap_gradient = Vector3::Zero();  ///< ∂g/∂x
  Vector3 normal = Vector3::Zero();        ///< n, towards the cilium
  Eigen::Matrix<double, 3, 2> tangents =   ///< t along the travel, b across it
      Eigen::Matrix<double, 3, 2>::Zero();
  Vector3 place_gradient = Vector3::Zero();  ///< ∂ξ/∂x
  double curvature = 0;                      ///< κ: ∂n/∂ξ = −κ t; p″/w² or −1/r, 1/m
  Eigen::Vector2d place = Eigen::Vector2d::Zero();  ///< (ξ, x·b): the place on the surface, m
};

/// Beyond the ends of a sampled profile along its last slope. p″ by central differences of p′.
SurfacePoint surface_point(const RigidSurface& surface, const Vector3& x);

}  // namespace ciliaval::fem::solid::contact
