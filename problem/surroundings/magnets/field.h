// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <array>
#include <vector>

#include "problem/surroundings/magnets/magnet.h"
#include "problem/types.h"

namespace ciliaval::surroundings::magnets {

/// A magnetic field about a point. Outside of magnets all derivatives are symmetric in all indices
/// (∇×B = 0) and their traces vanish (∇·B = 0).
struct FieldJet {
  Vector3 B = Vector3::Zero();         ///< flux density, T
  Matrix3 gradient = Matrix3::Zero();  ///< ∂B_i/∂x_j, T/m
  /// second[k](i, j) = ∂²B_i/∂x_j∂x_k, T/m²
  std::array<Matrix3, 3> second{Matrix3::Zero(), Matrix3::Zero(), Matrix3::Zero()};

  FieldJet& operator+=(const FieldJet& other);
};

FieldJet operator*(double factor, const FieldJet& jet);

/// Field of a dipole of moment m (A·m²) at the offset a (m) from it, with c = μ₀/4π:
///   B = c m·∇∇(1/a), and its derivatives c m·∇∇∇(1/a), c m·∇∇∇∇(1/a).  Not finite at a = 0.
FieldJet dipole_jet(const Vector3& moment, const Vector3& offset);

/// Field of the magnet at the point x (m) outside of it.
/// Ball: the dipole at its centre. Cuboid: B = μ₀/4π Σ ± M·∇∇G over its corners, with
/// ∂x∂yG = log(z + r), ∂x∂xG = −atan(yz/(xr)) (Yang, Roberts, Morris, Supercond. Sci. Technol. 3,
/// 591, 1990), and, beyond six of its radii, where these cancel, Gauss's rule for its dipoles.
/// Cylinder: two charged discs (`disc_jet`). Rounding: below 1e-12 of each derivative where the
/// magnet's size and distance are alike; far from a flat cylinder that times distance over length.
/// Throws SolverError if x is not outside the magnet.
FieldJet jet(const Magnet& magnet, const Vector3& x);

/// The sum of the magnets' fields.
FieldJet jet(const std::vector<Magnet>& magnets, const Vector3& x);

}  // namespace ciliaval::surroundings::magnets
