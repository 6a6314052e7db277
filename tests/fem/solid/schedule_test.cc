// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/schedule.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace ciliaval::fem {
namespace {

const std::vector<std::size_t> default_levels{2079, 5049, 9315, 14877};  // docs/solid.md

using Done = std::set<std::pair<std::size_t, std::size_t>>;  // step, level

/// Whether all that the task needs is done.
bool possible(const SolidTask& task, const Done& done) {
  if (task.level == 0) return true;
  if (!done.contains({task.step, task.level - 1})) return false;
  return std::all_of(task.corrected_by.begin(), task.corrected_by.end(), [&](std::size_t step) {
    return done.contains({step, task.level}) && done.contains({step, task.level - 1});
  });
}

/// The block as its ranks go through it, each in order: the number of turns in which each rank does
/// one task if it can; 0 if they wait for one another forever.
std::size_t turns(const std::vector<SolidTask>& tasks, int ranks) {
  std::vector<std::vector<SolidTask>> left(static_cast<std::size_t>(ranks));
  for (const SolidTask& task : tasks) {
    auto& own = left.at(static_cast<std::size_t>(task.rank));
    own.insert(own.begin(), task);
  }
  Done done;
  for (std::size_t turn = 1;; ++turn) {
    const Done before = done;
    for (auto& own : left)
      if (!own.empty() && possible(own.back(), before)) {
        done.insert({own.back().step, own.back().level});
        own.pop_back();
      }
    if (done.size() == tasks.size()) return turn;
    if (done.size() == before.size()) return 0;
  }
}

TEST(SolidSchedule, HasEachTaskOnceAfterThoseThatItNeeds) {
  for (const std::vector<std::size_t>& levels :
       {std::vector<std::size_t>{3000}, {500, 4000}, default_levels, {2000, 5000, 9000, 15000, 9}})
    for (const std::size_t steps : {1U, 2U, 3U, 4U, 7U})
      for (const int ranks : {1, 2, 3, 5})
        for (const Corrections corrections :
             {Corrections::before, Corrections::within, Corrections::none}) {
          const std::string what = std::to_string(levels.size()) + " levels, " +
                                   std::to_string(steps) + " steps, " + std::to_string(ranks) +
                                   " ranks";
          const std::vector<SolidTask> tasks = schedule(levels, steps, ranks, corrections);
          EXPECT_EQ(tasks.size(), steps * (levels.size() + 1)) << what;
          Done done;
          for (const SolidTask& task : tasks) {
            EXPECT_LT(task.step, steps) << what;
            EXPECT_LE(task.level, levels.size()) << what;
            EXPECT_TRUE(possible(task, done)) << what;
            EXPECT_TRUE(done.insert({task.step, task.level}).second) << what;
            EXPECT_LE(task.corrected_by.size(), corrections == Corrections::within ? 2U : 0U);
            EXPECT_TRUE(task.level < levels.size() || task.corrected_by.empty()) << what;
          }
          EXPECT_GT(turns(tasks, ranks), 0U) << what;
        }
}

// fig3b: rank 0 leads with the first step, rank 1 finds the others' coarser equilibria; no other
// step goes without corrections, and both ranks have finest tasks.
TEST(SolidSchedule, FirstStepLeadsWhereTheOthersGainByItsCorrections) {
  std::size_t finest_of_rank_1 = 0;
  for (const SolidTask& task : schedule(default_levels, 4, 2, Corrections::within)) {
    if (task.level == default_levels.size()) continue;
    const bool leads = task.step == 0;
    const bool finest = task.level == 3;
    if (leads || !finest) {
      EXPECT_EQ(task.rank, leads ? 0 : 1);
    } else if (task.rank == 1) {
      ++finest_of_rank_1;
    }
    EXPECT_EQ(task.corrected_by.empty(), leads || task.level == 0);
  }
  EXPECT_EQ(finest_of_rank_1, 1U);
}

// … which has time left at the end, and makes deformations then.
TEST(SolidSchedule, DeformationsAreMadeByTheRankThatIsFree) {
  std::set<int> ranks;
  for (const SolidTask& task : schedule(default_levels, 4, 2, Corrections::within))
    if (task.level == default_levels.size() && task.step < 3) ranks.insert(task.rank);
  EXPECT_EQ(ranks, std::set<int>{1});
}

// Where corrections are known, or there are none, each rank follows its own steps.
TEST(SolidSchedule, EachRankTakesItsOwnStepsOtherwise) {
  for (const Corrections corrections : {Corrections::before, Corrections::none})
    for (const SolidTask& task : schedule(default_levels, 2, 2, corrections))
      EXPECT_EQ(task.rank, static_cast<int>(task.step));
}

// The nearest steps serve: of those behind, the last two.
TEST(SolidSchedule, CorrectsByTheNearestSteps) {
  for (const SolidTask& task : schedule(default_levels, 6, 1, Corrections::within)) {
    if (task.level == default_levels.size()) continue;
    std::vector<std::size_t> expected;
    if (task.level > 0 && task.step > 0) expected.push_back(task.step - 1);
    if (task.level > 0 && task.step > 1) expected.push_back(task.step - 2);
    EXPECT_EQ(task.corrected_by, expected) << "step " << task.step << ", level " << task.level;
  }
}

}  // namespace
}  // namespace ciliaval::fem
