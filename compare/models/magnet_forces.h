// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string>
#include <vector>

#include "problem/cilium.h"
#include "problem/mechanics_model.h"

namespace ciliaval::compare::models {

/// Force and torque of the deformed cilium on a magnet beside it.
struct MagnetForce {
  std::string name;  ///< of the magnet
  Vector3 force;     ///< N
  Vector3 torque;    ///< about the magnet's centre, N·m
};

/// Force and torque on each magnet of the step's environment: the reaction to its field's force on
/// the charged faces of the body, or on the end sections of a rod. Empty without a deformation, or
/// where the bodies are too near to each other for the quadrature.
std::vector<MagnetForce> forces_on_magnets(const Cilium& cilium, const MechanicsStep& step);

}  // namespace ciliaval::compare::models
