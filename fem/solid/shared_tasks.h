// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "fem/parallel.h"
#include "fem/solid/equilibrium/load_path.h"
#include "fem/solid/schedule.h"
#include "problem/deformation.h"

namespace ciliaval::fem {

/// What a task ended with: an equilibrium, or a deformation of the tasks that make one; neither
/// where it, or one that it needs, found none.
struct TaskResult {
  std::optional<Equilibrium> equilibrium{};
  std::optional<Deformation> deformation{};  ///< of a task that makes one
  int iterations = 0;
  double seconds = 0;
};

/// The tasks of a block of steps (schedule()) on their ranks, which tell one another what they
/// find.
class SharedTasks {
 public:
  /// The tasks of all steps and levels, those of the deformations included, the same on all ranks.
  SharedTasks(std::vector<SolidTask> tasks, std::size_t steps, std::size_t levels);

  /// Does this rank's tasks by `solve`, alone (RankAlone), each when those that it needs have been
  /// done; what `solve` throws counts as no result. Returns when the results of all tasks are
  /// here. Collective.
  void run(const std::function<TaskResult(const SolidTask&)>& solve);

  /// The result of a task; null if it is not here yet. For `solve`: what its task needs is here,
  /// with its equilibrium.
  const TaskResult* result(std::size_t step, std::size_t level) const;

  /// To be called now and then by `solve`: sends what this rank has found on its way.
  void move_mail() const;

 private:
  std::size_t index(std::size_t step, std::size_t level) const { return index_[level][step]; }
  /// Those whose equilibria a task needs.
  std::vector<std::size_t> needed_by(const SolidTask& task) const;
  void collect(std::size_t task);

  std::vector<SolidTask> tasks_;
  std::vector<std::vector<std::size_t>> index_;  ///< in tasks_, by level and step
  std::vector<std::optional<TaskResult>> results_;
  int rank_;
  Mail mail_;
};

}  // namespace ciliaval::fem
