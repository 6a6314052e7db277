// SPDX-License-Identifier: LGPL-2.1-or-later
// Magnets whose field is known.
#pragma once

#include <memory>

#include "problem/cilium.h"
#include "problem/deformation.h"

namespace ciliaval::test {

inline constexpr double R = 1.5e-3;  ///< of the paper's cilium, m

/// A ball about the origin, uniformly magnetised: eight cells of degree 5, a cube mapped onto the
/// ball by x_i = R u_i √(1 − u_j²/2 − u_k²/2 + u_j²u_k²/3).
std::shared_ptr<const SolidBody> ball(double radius, const Vector3& magnetization);

/// B (T) of a dipole (A·m²) at the origin.
Vector3 dipole_field(const Vector3& moment, const Vector3& x);

/// The paper's cilium: 3 mm thick, magnetised with 75 kA/m from S = 3 to 20 mm.
Cilium paper_cilium();
/// The paper's cilium, its centreline bent to an arc of constant curvature (1/m) in the x-z plane;
/// straight for 0.
Deformation arc(double curvature);

/// The paper's sensor, m.
inline Vector3 paper_sensor() {
  return {-0.1e-3, 0.2e-3, -1.55e-3};
}

}  // namespace ciliaval::test
