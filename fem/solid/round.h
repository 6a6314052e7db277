// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "fem/solid/load_path.h"
#include "problem/mechanics_model.h"

namespace ciliaval::fem {

/// A solved step of a load path, and what the levels, the coarsest first, go on from after it.
struct SolvedStep {
  MechanicsStep step;  ///< with its deformation on the rank that solved it only
  std::vector<std::optional<LoadPathState>> levels;
};

/// A round: the next `count` steps of a load path, each solved by one rank alone (RankAlone) by
/// `solve`, which is given its number, 0 … count − 1, and goes on from where all ranks are.
/// Returns, on all ranks, those up to the first one that did not converge, which is to be solved
/// again, in a round of its own, from the step before it, as on a single rank. A step in a round of
/// its own is returned as it is. The caller puts the levels where the last step returned left them.
/// Collective; count must not exceed the number of ranks. Throws what the first step threw, a
/// CheckpointError, InputError or SolverError, on all ranks.
std::vector<SolvedStep> solve_round(std::size_t count,
                                    const std::function<SolvedStep(std::size_t)>& solve);

}  // namespace ciliaval::fem
