// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <functional>
#include <vector>

#include "problem/joints/joints.h"
#include "problem/mechanics_model.h"

namespace ciliaval::joints {

/// Largest strain ε = |κ| d/2 of bending up to which the corrections were compared with the solid.
inline constexpr double largest_strain = 0.6;
/// c: the solid's law is not the rods' linear one, which changes the bending flexibility of a
/// segment by some 1 + c ε².
inline constexpr double nonlinearity = 0.1;

/// The largest ε of each segment.
std::vector<double> strains(const Cilium& cilium, const Centreline& centreline);

/// The joints as they are if all are wrong by their uncertainties.
std::vector<Joint> changed_joints(const Corrections& corrections);

/// Solves a path with other joints than the result's.
using Solve = std::function<std::vector<MechanicsStep>(const Cilium& cilium, const LoadPath& path,
                                                       const std::vector<Joint>& joints)>;

/// Adds two companions with their error parts to a result with these corrections: "joints", with
/// the changed joints, and "law", whose Young's moduli are E/(1 + c ε²), step by step. A step that
/// did not converge has no ε and is its own companion.
void add_companions(MechanicsResult& result, const Cilium& cilium, const Corrections& corrections,
                    const Solve& solve);

/// Adds a remark to the converged steps in which the ε of a segment is above largest_strain.
void remark_on_strains(const Cilium& cilium, std::vector<MechanicsStep>& steps);

}  // namespace ciliaval::joints
