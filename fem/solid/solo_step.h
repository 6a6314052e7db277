// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "fem/solid/equilibrium/load_path.h"
#include "problem/mechanics_model.h"

namespace ciliaval::fem {

/// A solved step of a load path, and what the levels, the coarsest first, go on from after it.
struct SolvedStep {
  MechanicsStep step;  ///< with its deformation on rank 0 only
  std::vector<std::optional<LoadPathState>> levels;
};

/// A step that rank 0 solves by `solve`, alone (RankAlone), with what it gives on all ranks. Throws
/// what that throws, a CheckpointError, InputError or SolverError, on all ranks. Collective.
SolvedStep solve_on_first_rank(const std::function<SolvedStep()>& solve);

}  // namespace ciliaval::fem
