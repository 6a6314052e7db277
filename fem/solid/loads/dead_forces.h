// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <deal.II/lac/vector.h>

#include <functional>

#include "fem/solid/equilibrium/newton.h"
#include "fem/solid/discretisation/space.h"

namespace ciliaval::fem {

/// Dead forces on any mesh, in the reference configuration.

/// Nodal forces ∫ N_a b(X) dV of a body force b, N/m³.
dealii::Vector<double> body_force(const SolidSpace& space,
                                  const std::function<Vector3(const Vector3& X)>& b);

/// Nodal forces ∫ N_a t(X, N) dA of a traction t, N/m², on a part of the boundary with the outward
/// normal N.
dealii::Vector<double> traction(
    const SolidSpace& space, dealii::types::boundary_id boundary,
    const std::function<Vector3(const Vector3& X, const Vector3& N)>& t);

/// The given nodal forces, whatever the displacement.
ExternalForces dead_forces(dealii::Vector<double> forces);

/// Σ_a f_a: the resultant of nodal forces, N.
Vector3 resultant(const SolidSpace& space, const dealii::Vector<double>& forces);

}  // namespace ciliaval::fem
