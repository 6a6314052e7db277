// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <optional>

#include "fem/beam/beam.h"
#include "fem/beam/newton.h"
#include "problem/cilium.h"
#include "problem/load.h"

namespace ciliaval::fem::beam {

/// A system whose vertex `loaded` carries the point load, if the load is one.
struct CiliumBeam {
  System system;
  std::size_t loaded = 0;
};

/// Clamped straight beam with 2^refinement equal elements between segment interfaces and `load_at`
/// (m), if given. `loaded` is the vertex at load_at, else the tip.
CiliumBeam cilium_beam(const Cilium& cilium, const BeamOptions& options,
                       std::optional<double> load_at = {});

/// The same with a vertex that moves inside segment `host`, at S_host + s for State::shift s: the
/// elements of the host below and above it stretch and shrink in proportion and may vanish.
CiliumBeam cilium_beam_with_moving_vertex(const Cilium& cilium, const BeamOptions& options,
                                          std::size_t host);

/// The load as forces on the beam; a contact load is its point force on the loaded vertex. Not for
/// a probe, whose force is not known (throws InputError).
Loads loads(const Load& load, const CiliumBeam& beam);

}  // namespace ciliaval::fem::beam
