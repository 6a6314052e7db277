// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include "fem/solid/fibres.h"
#include "fem/solid/space.h"
#include "problem/centreline.h"

namespace ciliaval::fem {

/// Centreline of an extruded solid: one piece for each layer of cells, four Gauss–Lobatto stations
/// on each. At a station,
///
///   r = 1/A ∫ x dA,
///   Λ: d₁, d₂ = the two columns of B (BᵀB)^(−1/2), B = [∫ (x − r) X dA, ∫ (x − r) Y dA], d₃ = d₁ ×
///   d₂
///      (the rotation that fits the section best, orthogonal Procrustes),
///   κ = 2 vec(q′ q̄), q the quaternion of Λ, by its interpolation on the layer,
///   n = ∫ P e_z dA,  m = ∫ (x − r) × P e_z dA,
///
/// n and m are integrated at the two Gauss planes of the layer, where the stresses of quadratic
/// elements are most accurate, and continued linearly to the stations. r is the element's own
/// quadratic, so that it is exact and continuous from layer to layer.
Centreline centreline(const SolidSpace& space, const Fibres& fibres, const SolidState& state);

/// The rotation that fits the columns b₁, b₂ of a section best (see centreline()). Throws
/// SolverError if they are parallel or not finite.
Quaternion section_rotation(const Eigen::Matrix<double, 3, 2>& B);

}  // namespace ciliaval::fem
