// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include "fem/solid/discretisation/space.h"
#include "problem/cilium.h"

namespace ciliaval::fem::solid::postprocessing {

/// Largest compression of the mantle.
struct MantleCompression {
  double ratio = 1;    ///< λₙ/λ₁
  double stretch = 1;  ///< λ₁, along the mantle
  double height = 0;   ///< Z, m
};

/// The largest ratio λₙ/λ₁ of the stretch across the mantle to the smallest one along it. Where it
/// reaches 2.4, a free neo-Hookean surface folds into creases (Hong, Zhao, Suo, Appl. Phys. Lett.
/// 95, 111901, 2009). With C the two by two matrix of the products of the tangent vectors F t_i:
///
///   λ₁² = smallest eigenvalue of C,   λₙ = det F/√det C  (a free surface has no shear across it).
///
/// At the 2 × 2 Gauss points of the mantle's faces; those at the rims of the clamped end and of the
/// interfaces, where the strain is singular, are left out: nearer than 0.1 diameters, or a fifth
/// of the segment if that is less. Infinite where the mantle is turned inside out.
MantleCompression mantle_compression(const discretisation::SolidSpace& space, const Cilium& cilium,
                                     const discretisation::SolidState& state);

}  // namespace ciliaval::fem::solid::postprocessing
