// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fem/solid/checkpoint.h"
#include "fem/solid/level.h"
#include "fem/solid/schedule.h"
#include "fem/solid/solid.h"
#include "problem/mechanics_model.h"

namespace ciliaval::fem {

class SharedTasks;
struct TaskResult;

/// The levels of the solid on their way along a load path.
class PathRun {
 public:
  /// The levels from the coarsest to the finest. Path, options and progress must outlive it.
  PathRun(std::vector<std::unique_ptr<Level>> levels, const LoadPath& path,
          const SolidOptions& options, const Progress& progress);

  /// Goes on from where the checkpoint, if there is one, left off, to the end of the path, and
  /// renews the checkpoint on the way. Collective.
  MechanicsResult follow(SolidCheckpoint& saved);

 private:
  const Level& finest() const { return *levels_.back(); }
  void go_on_from(SolidCheckpoint& saved);
  /// All ranks share each step.
  void follow_together(SolidCheckpoint& saved);
  /// The ranks work alone, on blocks of steps, after each of which the checkpoint is renewed.
  void follow_apart(SolidCheckpoint& saved);
  /// How many of the next steps make a block: twice as many as ranks where none gives the others
  /// corrections yet, else as many; and those that would be left over for some ranks. One while a
  /// step is on its way.
  std::size_t block_size() const;
  Corrections corrections(std::size_t count) const;
  bool corrections_are_known(const Load& load) const;
  /// Whether a load at this place has slipped off that was not larger.
  bool has_slipped(const Load& load) const;
  /// Solves the next steps, up to the first one that finds no equilibrium from its guess, and
  /// returns how many it has. Saves them together, if `saved` is not null.
  std::size_t solve_block(std::size_t count, SolidCheckpoint* saved);
  /// A task of the block that begins with step `first`; `before`: the levels' states then.
  TaskResult solve_task(const SolidTask& task, const SharedTasks& tasks,
                        const std::vector<std::optional<LoadPathState>>& before, std::size_t first,
                        const Progress& progress);
  /// A task of the block that makes a deformation.
  TaskResult make_deformation(const SolidTask& task, const SharedTasks& tasks,
                              std::size_t first) const;
  /// Adds a step of the block that all its levels have solved to the results.
  void add(const SharedTasks& tasks, std::size_t step);
  /// The next step, by rank 0 for all.
  void solve_alone(SolidCheckpoint& saved, bool keep);

  /// "step 2/4, ", "steps 1-2/4, "
  std::string label(std::size_t first, std::size_t count) const;
  Progress shown_as(const std::string& label) const;
  /// Step i. If `keep`, saves each equilibrium on the way.
  MechanicsStep solve(std::size_t i, SolidCheckpoint& saved, bool keep);
  /// Adds the step that the levels have ended with.
  void add_to(SolidCheckpoint& saved, const MechanicsStep& step) const;
  void add_deformation(MechanicsStep& step, const SolidState& state) const;
  std::vector<const LoadPathState*> states() const;
  std::vector<std::optional<LoadPathState>> copied_states() const;
  void restore(std::vector<std::optional<LoadPathState>> states);

  std::vector<std::unique_ptr<Level>> levels_;  ///< the coarsest first
  const LoadPath& path_;
  const SolidOptions& options_;
  const Progress& progress_;
  MechanicsResult result_;
};

}  // namespace ciliaval::fem
