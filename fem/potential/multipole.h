// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include "problem/types.h"

namespace ciliaval::fem::potential {

/// Dipole and quadrupole of a distribution of moments about a centre:
///
///     ψ = [m·x/r³ + (3 xᵀT x/r⁵ − tr T/r³)]/4π,   m = Σ m_q,  T = Σ m_q x_qᵀ,
///
/// positions from the centre. The terms left out fall like 1/r⁴ (J. D. Jackson, Classical
/// Electrodynamics, 3rd ed., section 4.1).
struct Multipole {
  Vector3 centre = Vector3::Zero();   ///< m
  Vector3 dipole = Vector3::Zero();   ///< A·m²
  Matrix3 moments = Matrix3::Zero();  ///< T, A·m³

  void add(const Vector3& position, const Vector3& moment);
  /// ψ, A.
  double potential(const Vector3& position) const;
};

/// ψ of a single dipole at the origin, A.
double dipole_potential(const Vector3& moment, const Vector3& position);

}  // namespace ciliaval::fem::potential
