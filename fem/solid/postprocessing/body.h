// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include "fem/solid/discretisation/extruded_quadrature.h"
#include "fem/solid/discretisation/space.h"
#include "problem/cilium.h"
#include "problem/solid_body.h"

namespace ciliaval::fem::solid::postprocessing {

/// The solid of a cilium as patches of the elements' own polynomials X and x = X + u, with
/// J = det(1 + ∂u/∂X) and the Cauchy stress of (F, p) at the nodes. Charged
/// faces are the horizontal planes across which M₃ jumps, end faces and interfaces, and the mantle
/// of segments that are magnetised across the axis. At an interface
/// the lower segment is `inside`; its normal is +Z. A half body is completed by its image in y = 0.
/// Collective; whole on each rank.
SolidBody solid_body(const discretisation::SolidSpace& space,
                     const discretisation::ExtrudedQuadrature& quadrature, const Cilium& cilium,
                     const discretisation::SolidState& state);

}  // namespace ciliaval::fem::solid::postprocessing
