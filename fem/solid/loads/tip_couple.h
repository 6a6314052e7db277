// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <array>

#include "fem/solid/discretisation/extruded_quadrature.h"
#include "fem/solid/discretisation/space.h"
#include "fem/solid/loads/external_forces.h"
#include "problem/load.h"

namespace ciliaval::fem::solid::loads {

/// A dead couple M about a = e_z × e on the end face, as the traction x_e p/A that varies linearly
/// over the face, x_e = X·e from its centroid. With the face's first moment
///
///   G(u) = ∫ x_e x dA,   e(ψ) = e cos ψ − e_z sin ψ,   t(ψ) = a × e(ψ),   ψ where G·t(ψ) = 0,
///
/// p = M t(ψ)/(G·e(ψ)): the moment G × p is M a in a plane motion, however the face warps or
/// stretches, and the resultant is zero. It is the derivative of the work M ψ.
class TipCouple {
 public:
  /// Collective. Throws InputError if the mesh has no plane at the tip.
  TipCouple(const discretisation::SolidSpace& space,
            const discretisation::ExtrudedQuadrature& quadrature, const MomentLoad& load);

  /// ψ, rad, the turn of the end face about a, between −π and π. Collective, as all below.
  double angle(const discretisation::Vector& u) const;
  /// The nodal forces at ψ(u), without their derivative.
  ExternalForces forces() const;
  /// The same forces with ψ as the unknown amplitude, for the bordered tangent: the radial part of
  /// ∂p/∂u, which is of the order of the strain, alone is left out of it.
  UnknownForce with_unknown_angle(const discretisation::Vector& u) const;

 private:
  Vector3 first_moment(const discretisation::Vector& u) const;  ///< G, m⁴
  Vector3 radial(double psi) const;                             ///< e(ψ)
  Vector3 tangential(double psi) const;                         ///< t(ψ)
  void add(const Vector3& p, discretisation::Vector& forces) const;

  double moment_ = 0;                              ///< M, N·m
  double of_mesh_ = 1;                             ///< part of the body that is meshed
  Vector3 direction_;                              ///< e
  Vector3 at_rest_ = Vector3::Zero();              ///< G at u = 0, m⁴
  std::array<discretisation::Vector, 3> weights_;  ///< ∫ N x_e dA at the component's nodes, m³
};

}  // namespace ciliaval::fem::solid::loads
