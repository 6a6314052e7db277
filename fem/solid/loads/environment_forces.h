// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <Eigen/Core>
#include <array>

#include "fem/solid/discretisation/space.h"
#include "fem/solid/loads/external_forces.h"
#include "problem/cilium.h"
#include "problem/surroundings/environment.h"

namespace ciliaval::fem::solid::loads {

/// Energy e = B₀·R M of a magnet per reference volume but for its sign, R the rotation of F = R U,
/// with its derivatives by F. With RᵀδF − δFᵀR = [a]×, δR = R [ω]× where G ω = a, G = tr(U) I − U;
/// so ∂e/∂F = R [y]×, G y = M × RᵀB₀. docs/theory/environment.md.
struct TurnedMagnet {
  double energy = 0;
  Matrix3 first;                       ///< ∂e/∂F
  Eigen::Matrix<double, 9, 9> second;  ///< ∂²e/∂F∂F, entries of F by columns
  Vector3 direction;                   ///< R M = ∂e/∂B₀
  std::array<Matrix3, 3> by_field;     ///< ∂²e/∂F∂B₀ₖ
};
TurnedMagnet turned_magnet(const Matrix3& F, const Vector3& magnetization, const Vector3& field);

/// The work m·B(x) of a magnet per reference volume, m = F M or R M, in the field of which x is in
/// the middle, with its derivatives by F and x.
struct MagnetInField {
  double work = 0;
  Matrix3 by_F;
  Vector3 by_x;
  Eigen::Matrix<double, 9, 9> FF;  ///< entries of F by columns
  std::array<Matrix3, 3> Fx;       ///< ∂²/∂F∂xₖ
  Matrix3 xx;
};
MagnetInField magnet_in_field(const Matrix3& F, const Vector3& magnetization,
                              const surroundings::magnets::FieldJet& field,
                              surroundings::MagneticEnergy law);

/// Nodal forces of weight and fields: dead, but for the law R and magnets. The mesh's cells have
/// the segments' numbers as material ids.
ExternalForces environment_forces(const discretisation::SolidSpace& space, const Cilium& cilium,
                                  const surroundings::Environment& environment);

/// Resultant of the weight on the mesh, N. A uniform field has none.
Vector3 weight_of(const discretisation::SolidSpace& space, const Cilium& cilium,
                  const surroundings::Environment& environment);
/// Resultant of the magnets' forces on the deformed mesh, N.
Vector3 force_of_magnets(const discretisation::SolidSpace& space, const Cilium& cilium,
                         const surroundings::Environment& environment,
                         const discretisation::Vector& displacement);

}  // namespace ciliaval::fem::solid::loads
