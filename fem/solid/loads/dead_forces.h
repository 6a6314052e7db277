// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <deal.II/lac/vector.h>

#include <functional>

#include "fem/solid/discretisation/space.h"
#include "fem/solid/loads/external_forces.h"

namespace ciliaval::fem::solid::loads {

/// Dead forces on any mesh, in the reference configuration.

/// Nodal forces ∫ N_a b(X) dV of a body force b, N/m³.
dealii::Vector<double> body_force(const discretisation::SolidSpace& space,
                                  const std::function<Vector3(const Vector3& X)>& b);

/// Nodal forces ∫ N_a t(X, N) dA of a traction t, N/m², on a part of the boundary with the outward
/// normal N.
dealii::Vector<double> traction(
    const discretisation::SolidSpace& space, dealii::types::boundary_id boundary,
    const std::function<Vector3(const Vector3& X, const Vector3& N)>& t);

/// The given nodal forces, whatever the displacement.
ExternalForces dead_forces(dealii::Vector<double> forces);

/// Σ_a f_a: the resultant of nodal forces, N.
Vector3 resultant(const discretisation::SolidSpace& space, const dealii::Vector<double>& forces);

}  // namespace ciliaval::fem::solid::loads
