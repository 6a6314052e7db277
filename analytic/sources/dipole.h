// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include "problem/types.h"

namespace ciliaval::analytic::sources {

struct Dipole {
  Vector3 position;  ///< m
  Vector3 moment;    ///< A·m²
};

/// Flux density (T) of a dipole of moment m (A·m²) at the offset a (m) from it, paper's Eq. 5:
///   B = μ₀/4π [3(m·a)a/a⁵ − m/a³].  Not finite at a = 0.
Vector3 dipole_field(const Vector3& moment, const Vector3& offset);

/// The largest |B| (T), on the axis, of a dipole of this size (A·m²) at the distance a (m):
/// μ₀m/(2πa³).
double largest_dipole_field(double moment, double a);

/// Flux density (T) of a magnetic pole of strength q (A·m) at the offset a (m) from it:
///   B = μ₀ q a/(4π a³).  Not finite at a = 0.
Vector3 pole_field(double strength, const Vector3& offset);

/// ∂B_i/∂x_j (T/m) of the dipole:
///   μ₀/4π · 3/a⁵ [m aᵀ + a mᵀ + (m·a)(I − 5 a aᵀ/a²)].
Matrix3 dipole_gradient(const Vector3& moment, const Vector3& offset);

/// ∂B_i/∂x_j (T/m) of the pole: μ₀ q/(4π a³) (I − 3 a aᵀ/a²).
Matrix3 pole_gradient(double strength, const Vector3& offset);

}  // namespace ciliaval::analytic::sources
