// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "analytic/forces/charges.h"
#include "problem/cilium.h"
#include "problem/deformation.h"
#include "problem/field_model.h"

namespace ciliaval::analytic::forces {

/// Force and torque between magnets.
struct Wrench {
  Vector3 force = Vector3::Zero();   ///< N
  Vector3 torque = Vector3::Zero();  ///< about a stated point, N·m
  double force_error = 0;            ///< estimate of the quadrature's error and rounding, N
  double torque_error = 0;           ///< N·m

  Wrench& operator+=(const Wrench& other);
};

/// B (T) of other sources at points.
using PointsField = std::function<std::vector<Vector3>(std::span<const Vector3>)>;

/// The force on a magnet at rest in the field of others, F = ∫ σ B dA over its surface charge
/// σ = M·n, which is ∫ (M·∇)B dV, and the torque ∫ (x − about) × σ B dA. The order is raised until
/// the last change is 1e-11 of the force and of the torque, or as small as their rounding. Throws
/// SolverError if order 96 does not do: the magnets are too near to each other.
Wrench wrench(const Charges& charges, const PointsField& field, const Vector3& about);

/// The force of given magnets on the deformed cilium's magnet, about its clamped base: on the
/// charged faces of its body, or else on the end sections of the rod. Throws SolverError if they
/// touch.
Wrench wrench_on_cilium(const Cilium& cilium, const Deformation& deformation,
                        const std::vector<surroundings::magnets::Magnet>& magnets);

/// The force of the deformed cilium, by its field of the model `mesh` or else `volume`, on a given
/// magnet, about the magnet's centre.
Wrench wrench_on_magnet(const Cilium& cilium, const Deformation& deformation,
                        const surroundings::magnets::Magnet& magnet);

}  // namespace ciliaval::analytic::forces
