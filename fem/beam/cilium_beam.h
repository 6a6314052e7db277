// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "fem/beam/beam.h"
#include "fem/beam/newton.h"
#include "problem/cilium.h"
#include "problem/load.h"

namespace ciliaval::fem::beam {

/// A system whose vertex `loaded` carries the point load, if the load is one.
struct CiliumBeam {
  System system;
  std::size_t loaded = 0;
  std::vector<std::size_t> segments{};  ///< of each element; of a joint the one above
};

/// Clamped straight beam with 2^refinement equal elements between segment interfaces and `load_at`
/// (m), if given. `loaded` is the vertex at load_at, else the tip. Each joint, if they are
/// corrected, is an element of length zero below its segment; a load at an interface acts below it.
CiliumBeam cilium_beam(const Cilium& cilium, const BeamOptions& options,
                       std::optional<double> load_at = {},
                       const joints::Corrections& corrections = {});

/// The same with a vertex that moves inside segment `host`, at S_host + s for State::shift s: the
/// elements of the host below and above it stretch and shrink in proportion and may vanish.
CiliumBeam cilium_beam_with_moving_vertex(const Cilium& cilium, const BeamOptions& options,
                                          std::size_t host,
                                          const joints::Corrections& corrections = {});

/// Weight and field of the environment that acts under the load.
Loads environment_loads(const Cilium& cilium, const Load& load, const CiliumBeam& beam);
/// NewtonOptions::largest_turn: none without an environment.
std::optional<double> largest_turn(const Load& load);
/// The environment's horizontal force along the load's direction, N.
double environment_force(const Cilium& cilium, const Load& load);

/// Load and environment as forces on the beam; a contact load is its point force on the loaded
/// vertex. Not for a probe, whose force is not known (throws InputError).
Loads loads(const Cilium& cilium, const Load& load, const CiliumBeam& beam);

}  // namespace ciliaval::fem::beam
