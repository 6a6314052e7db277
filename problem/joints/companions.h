// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <functional>
#include <string_view>
#include <vector>

#include "problem/joints/joints.h"
#include "problem/mechanics_model.h"

namespace ciliaval::joints {

/// Largest strain ε = |κ| d/2 of bending up to which the corrections were compared with the solid.
inline constexpr double largest_strain = 0.6;

/// Relative error of a probe's displacement, because the load deforms the section that it moves
/// (docs/evidence/joints.md).
inline constexpr double probe_error = 6e-4;

/// ErrorPart::direction of the corrections' uncertainty.
inline constexpr std::string_view error_direction = "joints";

/// The largest ε of each segment.
std::vector<double> strains(const Cilium& cilium, const Centreline& centreline);

/// Solves a path with other corrections than the result's.
using Solve =
    std::function<std::vector<MechanicsStep>(const LoadPath& path, const Corrections& corrections)>;

/// Adds the companion whose corrections and probes are off by their uncertainty, and its error part
/// "joints".
void add_companion(MechanicsResult& result, const Cilium& cilium, Corrections corrections,
                   const Solve& solve);

/// Adds a remark to the converged steps in which the ε of a segment is above largest_strain.
void remark_on_strains(const Cilium& cilium, std::vector<MechanicsStep>& steps);

}  // namespace ciliaval::joints
