// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include "fem/beam/cilium_beam.h"
#include "fem/beam/newton.h"
#include "problem/load.h"
#include "problem/mechanics_model.h"

namespace ciliaval::fem::beam::stability {

/// The way from an equilibrium to a load.
struct Way {
  State start;
  Loads from;  ///< with which `start` is in equilibrium
  Loads to;
  double magnitude_before = 0;  ///< of the load at the start
  double magnitude = 0;         ///< at the end
};

/// Where beside magnets the branch of equilibria from the start of the way turns back in a fold
/// before its end, a step that has no equilibrium, or whose equilibrium `end` touches a magnet, is
/// pulled in; one that has another equilibrium has jumped to it. Where the cilium touches a magnet
/// at the fold itself, the step is failed. Otherwise it stays as it is.
void judge_pull_in(const Cilium& cilium, CiliumBeam& beam, const Way& way,
                   const NewtonOptions& options, const State& end, MechanicsStep& step);

/// Marks the step as failed if the bent cilium touches a magnet, and says so.
bool touches_magnet(const Cilium& cilium, const Centreline& centreline, MechanicsStep& step);

}  // namespace ciliaval::fem::beam::stability
