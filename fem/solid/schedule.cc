// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/schedule.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>

namespace ciliaval::fem {
namespace {

// The model of the times, from the paper's fig3b at refinements 1 and 2 (docs/solid.md, MPI): only
// ratios matter, and a wrong one costs time but changes no result beyond rounding error.
/// A task takes unknowns^1.5 (by a square root, which is the same on all processors), three times
/// that on the coarsest level, which no coarser one gives a guess, …
constexpr double cost_of_coarsest = 3;
/// … times this where nothing corrects its guess (the first step of a path is as a rule the
/// smallest), …
constexpr double cost_of_first_step = 1.35;
constexpr double cost_uncorrected = 1.55;
/// … and this part more when its rank makes the level's solver.
constexpr double set_up = 0.25;
/// A deformation takes this part of the time of its equilibrium.
constexpr double cost_of_deformation = 0.025;

class Schedule {
 public:
  Schedule(std::span<const std::size_t> unknowns, std::size_t steps, int ranks,
           Corrections corrections, bool first_leads)
      : steps_(steps),
        corrections_(corrections),
        first_leads_(first_leads),
        free_(static_cast<std::size_t>(ranks), 0.0),
        end_(unknowns.size(), std::vector<std::optional<double>>(steps)),
        has_solver_(unknowns.size(), std::vector<bool>(free_.size(), false)) {
    for (const std::size_t n : unknowns)
      cost_.push_back(static_cast<double>(n) * std::sqrt(static_cast<double>(n)));
    cost_.front() *= cost_of_coarsest;
    while (tasks_.size() < steps * cost_.size()) assign_next();
    assign_deformations();
  }

  double duration() const { return *std::max_element(free_.begin(), free_.end()); }
  std::vector<SolidTask> tasks() && { return std::move(tasks_); }

 private:
  /// When all that the task needs is there; empty before that is known, if the task is taken, or if
  /// it is not for this rank.
  std::optional<double> ready(std::size_t step, std::size_t level, std::size_t rank) const {
    if (end_[level][step] || (first_leads_ && step == 0 && rank != 0)) return std::nullopt;
    if (level == 0) return 0;
    const std::optional<double> coarser = end_[level - 1][step];
    if (!first_leads_ || step == 0) return coarser;
    const std::optional<double> leader = end_[level][0];
    return coarser && leader ? std::optional(std::max(*coarser, *leader)) : std::nullopt;
  }

  /// Which of the tasks that can be begun at the same time goes first.
  std::tuple<bool, std::size_t, std::size_t> order(std::size_t step, std::size_t level) const {
    if (first_leads_) return {step != 0, level, step};
    return {false, step, level};
  }

  /// Gives the rank that is free first, of those that find one, the task that it can begin first.
  void assign_next() {
    std::vector<std::size_t> ranks(free_.size());
    std::iota(ranks.begin(), ranks.end(), std::size_t{0});
    std::stable_sort(ranks.begin(), ranks.end(),
                     [this](auto a, auto b) { return free_[a] < free_[b]; });
    for (const std::size_t rank : ranks) {
      using Choice = std::pair<double, std::tuple<bool, std::size_t, std::size_t>>;
      std::optional<Choice> best;
      SolidTask task;
      for (std::size_t level = 0; level < cost_.size(); ++level)
        for (std::size_t step = 0; step < steps_; ++step) {
          const std::optional<double> from = ready(step, level, rank);
          if (!from) continue;
          const Choice choice{std::max(*from, free_[rank]), order(step, level)};
          if (best && !(choice < *best)) continue;
          best = choice;
          task = {step, level, static_cast<int>(rank)};
        }
      if (best) return assign(std::move(task), best->first);
    }
  }

  void assign(SolidTask task, double start) {
    const auto [step, level] = std::pair(task.step, task.level);
    const auto rank = static_cast<std::size_t>(task.rank);
    if (corrections_ == Corrections::within && level > 0) task.corrected_by = known(task, start);
    double cost = relative_cost(task);
    if (!has_solver_[level][rank]) cost += set_up;
    has_solver_[level][rank] = true;
    free_[rank] = start + cost * cost_[level];
    end_[level][step] = free_[rank];
    tasks_.push_back(std::move(task));
  }

  /// Each to the rank that can begin it first; of several to the one that has found its equilibrium
  /// and need not send it.
  void assign_deformations() {
    std::vector<std::size_t> steps(steps_);
    std::iota(steps.begin(), steps.end(), std::size_t{0});
    const auto& end = end_.back();
    std::stable_sort(steps.begin(), steps.end(),
                     [&end](auto a, auto b) { return *end[a] < *end[b]; });
    for (const std::size_t step : steps) {
      const auto has_solved = std::find_if(tasks_.begin(), tasks_.end(), [&](const auto& task) {
        return task.step == step && task.level + 1 == cost_.size();
      });
      auto best = static_cast<std::size_t>(has_solved->rank);
      const auto start = [&](std::size_t rank) { return std::max(free_[rank], *end[step]); };
      for (std::size_t rank = 0; rank < free_.size(); ++rank)
        if (start(rank) < start(best)) best = rank;
      free_[best] = start(best) + cost_of_deformation * cost_.back();
      tasks_.push_back({step, cost_.size(), static_cast<int>(best)});
    }
  }

  double relative_cost(const SolidTask& task) const {
    if (corrections_ == Corrections::before || task.level == 0) return 1;
    if (!task.corrected_by.empty()) return 1;
    return task.step == 0 ? cost_of_first_step : cost_uncorrected;
  }

  /// The two steps nearest to the task's whose equilibria are there by then.
  std::vector<std::size_t> known(const SolidTask& task, double time) const {
    std::vector<std::size_t> result;
    for (std::size_t other = 0; other < steps_; ++other)
      if (end_[task.level][other] && *end_[task.level][other] <= time) result.push_back(other);
    const auto distance = [&task](std::size_t other) {
      return other < task.step ? task.step - other : other - task.step;
    };
    std::stable_sort(result.begin(), result.end(),
                     [&](auto a, auto b) { return distance(a) < distance(b); });
    if (result.size() > 2) result.resize(2);
    return result;
  }

  std::size_t steps_;
  Corrections corrections_;
  bool first_leads_;
  std::vector<double> cost_;                             ///< of each level
  std::vector<double> free_;                             ///< from when on each rank is free
  std::vector<std::vector<std::optional<double>>> end_;  ///< of each level's tasks
  std::vector<std::vector<bool>> has_solver_;            ///< level, rank
  std::vector<SolidTask> tasks_;
};

}  // namespace

std::vector<SolidTask> schedule(std::span<const std::size_t> unknowns, std::size_t steps, int ranks,
                                Corrections corrections) {
  Schedule each_its_own(unknowns, steps, ranks, corrections, false);
  if (corrections != Corrections::within) return std::move(each_its_own).tasks();
  Schedule first_leads(unknowns, steps, ranks, corrections, true);
  return first_leads.duration() < each_its_own.duration() ? std::move(first_leads).tasks()
                                                          : std::move(each_its_own).tasks();
}

}  // namespace ciliaval::fem
