// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include "fem/beam/system.h"
#include "problem/centreline.h"

namespace ciliaval::fem::beam {

/// The beam's state as a centreline: one piece for each element of positive length, on the
/// element's nodes. Section forces and the curvature K + K₀, which live at the Gauss points, are
/// extrapolated to the nodes as polynomials of degree p − 1 in material components and then turned.
Centreline centreline(const System& system, const State& state);

}  // namespace ciliaval::fem::beam
