// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <memory>

#include "fem/beam/beam.h"
#include "problem/joints/joints.h"
#include "problem/pin/body.h"

namespace ciliaval::fem::beam::touch {

/// The beam that the pin of a load touches; weight, fields and magnets may bend it out of the
/// pin's plane. The pin's axis is across e. Friction acts along the cilium, none across it. The
/// contact is a vertex that moves along the cilium, its arc length, N and T three more unknowns of
/// Newton's method (docs/theory/touch.md). Throws InputError.
std::unique_ptr<pin::Body> pinned_beam(const Cilium& cilium, const Load& load,
                                       const BeamOptions& options,
                                       const joints::Corrections& corrections);

}  // namespace ciliaval::fem::beam::touch
