// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <span>

#include "problem/cilium.h"
#include "problem/field_model.h"
#include "problem/load.h"
#include "problem/mechanics_model.h"

namespace ciliaval::analytic {

/// B of a design under one load.
struct DesignField {
  Status status = Status::converged;  ///< or slipped_off: then there is no field
  Field field;
};

/// elastica/volume in one go, for parameter studies: B (T) at the points (m) of the wedge on the
/// elastica under one load, what `Elastica` and `VolumeField` give to `tolerance`, relative to |B|,
/// at a tenth of their cost. A sensor outside the magnet sees the pose of the magnetic segments'
/// end sections alone, so neither the centreline between them nor the slip-off force is computed;
/// where that does not do (a probe, a point that may be inside) the two models are asked. Throws
/// what they throw, SolverError also if the elastica fails.
DesignField design_field(const Cilium& cilium, const Load& load, std::span<const Vector3> points,
                         double tolerance = 1e-10);

}  // namespace ciliaval::analytic
