// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace ciliaval::fem {

/// Finding the equilibrium of one level under the load of one step of a block, the work of one rank
/// at a time. It needs the equilibrium of the coarser level under the same load. With the level
/// beyond the finest: making the deformation of the finest one's equilibrium.
struct SolidTask {
  std::size_t step = 0;   ///< in the block
  std::size_t level = 0;  ///< 0: the coarsest
  int rank = 0;
  /// Steps of the block, the nearest first, at most two, whose equilibria on this level and the
  /// coarser one correct the guess.
  std::vector<std::size_t> corrected_by{};
};

/// Where the guesses of a block of steps can have their corrections from: the steps before the
/// block, those in it, or none.
enum class Corrections { before, within, none };

/// Distributes a block of steps over the ranks: the tasks in an order in which each comes after
/// those that it needs, so that ranks which do theirs in this order never wait for one another in
/// vain. Of two ways the one is taken that a model of the tasks' times finds shorter:
/// - each rank takes the next step and solves it on all levels, as long as there are enough steps;
/// - rank 0 leads with the first step, and the others follow it level by level with the next ones,
///   which so have its corrections; then all share what is left.
/// The deformations come last, each on the rank that can begin it first.
/// Depends on nothing but its arguments: the ranks agree on it without a word.
std::vector<SolidTask> schedule(std::span<const std::size_t> unknowns, std::size_t steps, int ranks,
                                Corrections corrections);

}  // namespace ciliaval::fem
