// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <functional>

#include "fem/solid/discretisation/space.h"
#include "fem/solid/loads/external_forces.h"

namespace ciliaval::fem::solid::loads {

/// Nodal forces ∫ N_a b(X) dV of a dead body force b, N/m³ of the reference volume.
discretisation::Vector body_force(const discretisation::SolidSpace& space,
                                  const std::function<Vector3(const Vector3& X)>& b);

/// The given nodal forces at any displacement.
ExternalForces dead_forces(discretisation::Vector forces);

/// Σ_a f_a: the resultant of nodal forces, N.
Vector3 resultant(const discretisation::SolidSpace& space, const discretisation::Vector& forces);

}  // namespace ciliaval::fem::solid::loads
