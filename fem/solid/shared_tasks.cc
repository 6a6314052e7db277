// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/shared_tasks.h"

#include <algorithm>
#include <exception>
#include <string>
#include <utility>

#include "fem/solid/archive.h"

namespace ciliaval::fem {
namespace {

std::string packed(const TaskResult& result) {
  return serialized(result.equilibrium, result.deformation, result.iterations, result.seconds);
}

TaskResult unpacked(const std::string& bytes) {
  TaskResult result;
  deserialize(bytes, result.equilibrium, result.deformation, result.iterations, result.seconds);
  return result;
}

/// Without a result if `solve` throws: whoever does the same again meets that again.
TaskResult attempt(const SolidTask& task,
                   const std::function<TaskResult(const SolidTask&)>& solve) {
  const RankAlone alone;
  try {
    return solve(task);
  } catch (const std::exception&) {
    return {};
  }
}

}  // namespace

SharedTasks::SharedTasks(std::vector<SolidTask> tasks, std::size_t steps, std::size_t levels)
    : tasks_(std::move(tasks)),
      index_(levels + 1, std::vector<std::size_t>(steps)),
      results_(tasks_.size()),
      rank_(rank()),
      mail_(tasks_.size()) {
  for (std::size_t i = 0; i < tasks_.size(); ++i) index_[tasks_[i].level][tasks_[i].step] = i;
}

const TaskResult* SharedTasks::result(std::size_t step, std::size_t level) const {
  const std::optional<TaskResult>& result = results_[index(step, level)];
  return result ? &*result : nullptr;
}

std::vector<std::size_t> SharedTasks::needed_by(const SolidTask& task) const {
  std::vector<std::size_t> needed;
  if (task.level == 0) return needed;
  needed.push_back(index(task.step, task.level - 1));
  for (const std::size_t step : task.corrected_by) {
    needed.push_back(index(step, task.level));
    needed.push_back(index(step, task.level - 1));
  }
  return needed;
}

void SharedTasks::collect(std::size_t task) {
  if (!results_[task])
    results_[task] = unpacked(mail_.collect(tasks_[task].rank, static_cast<int>(task)));
}

void SharedTasks::move_mail() const {
  mail_.arrived(rank_, 0);
}

void SharedTasks::run(const std::function<TaskResult(const SolidTask&)>& solve) {
  for (std::size_t i = 0; i < tasks_.size(); ++i) {
    if (tasks_[i].rank != rank_) continue;
    bool possible = true;
    for (const std::size_t needed : needed_by(tasks_[i])) {
      collect(needed);
      possible = possible && results_[needed]->equilibrium;
    }
    results_[i] = possible ? attempt(tasks_[i], solve) : TaskResult{};
    mail_.post(static_cast<int>(i), packed(*results_[i]));
  }
  for (std::size_t i = 0; i < tasks_.size(); ++i) collect(i);
  mail_.finish();
}

}  // namespace ciliaval::fem
