// SPDX-License-Identifier: LGPL-2.1-or-later
// Checkpoints from which an interrupted solution goes on.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "fem/solid/solid.h"
#include "problem/error.h"
#include "tests/fem/solid/cilia.h"

namespace ciliaval::fem::solid {
namespace {

using testing::HasSubstr;

/// A checkpoint in memory, which outlives the solution that it is given to.
class Memory {
 public:
  Checkpoint checkpoint() {
    return {kept, [this](const Checkpoint::Entries& entries) {
              for (const auto& [name, bytes] : entries) kept[name] = bytes;
            }};
  }
  Checkpoint::Entries kept;
};

/// A short cilium, quickly solved.
Cilium stub() {
  return {3e-3, {{"base", 3e-3, 1e5, 0.49, 0}, {"magnet", 3e-3, 3e6, 0.49, 75e3}}};
}
LoadPath path(const std::vector<double>& forces) {
  LoadPath result;
  for (const double force : forces) result.emplace_back(ContactLoad{force, 4.5e-3, 0.4});
  return result;
}
struct Killed {};

/// Progress that ends the solution at its n-th line.
Progress killed_after(int& lines) {
  return [&lines](const ProgressReport&) {
    if (lines-- == 0) throw Killed();
  };
}

void expect_same(const MechanicsResult& a, const MechanicsResult& b, const std::string& what) {
  ASSERT_EQ(a.companions.size(), b.companions.size()) << what;
  for (std::size_t i = 0; i < a.companions.size(); ++i)
    expect_same(a.companions[i], b.companions[i], what + ", companion");
  ASSERT_EQ(a.steps.size(), b.steps.size()) << what;
  for (std::size_t i = 0; i < a.steps.size(); ++i) {
    const MechanicsStep& p = a.steps[i];
    const MechanicsStep& q = b.steps[i];
    EXPECT_EQ(magnitude(p.load), magnitude(q.load)) << what;
    EXPECT_EQ(p.status, q.status) << what;
    EXPECT_EQ(p.applied_force, q.applied_force) << what;
    EXPECT_EQ(p.slip_off_force, q.slip_off_force) << what;
    EXPECT_EQ(p.contact_arclength, q.contact_arclength) << what;
    EXPECT_EQ(p.tip_uncertainty, q.tip_uncertainty) << what;
    EXPECT_EQ(p.tip_angle_uncertainty, q.tip_angle_uncertainty) << what;
    EXPECT_EQ(p.unstable_modes, q.unstable_modes) << what;
    EXPECT_EQ(p.smallest_eigenvalue, q.smallest_eigenvalue) << what;
    EXPECT_EQ(p.iterations, q.iterations) << what;
    EXPECT_EQ(p.unknowns, q.unknowns) << what;
    ASSERT_EQ(p.contact.has_value(), q.contact.has_value()) << what;
    if (p.contact) {
      EXPECT_EQ(p.contact->state, q.contact->state) << what;
      EXPECT_EQ(p.contact->normal_force, q.contact->normal_force) << what;
      EXPECT_EQ(p.contact->point, q.contact->point) << what;
      EXPECT_EQ(p.contact->friction_work, q.contact->friction_work) << what;
      EXPECT_EQ(p.contact->energy_lost, q.contact->energy_lost) << what;
      EXPECT_EQ(p.load.surface(), q.load.surface()) << what;
    }
    ASSERT_EQ(p.deformation.has_value(), q.deformation.has_value()) << what;
    if (!p.deformation) continue;
    const Centreline& r = p.deformation->centreline;
    const Centreline& s = q.deformation->centreline;
    for (const double S : r.breaks()) EXPECT_EQ(r.at(S).position, s.at(S).position) << what;
    const auto& cells = p.deformation->body->cells;
    for (std::size_t c = 0; c < cells.size(); ++c) {
      EXPECT_EQ(cells[c].current, q.deformation->body->cells[c].current) << what;
      EXPECT_EQ(cells[c].cauchy_stress, q.deformation->body->cells[c].cauchy_stress) << what;
    }
  }
}

/// Stops the solution again and again, each time after some more lines of progress than before, and
/// compares what comes of it at last with the solution that nothing has stopped, which it returns.
MechanicsResult stop_and_go_on(const SolidOptions& options, const LoadPath& loads, int stops) {
  int total = 0;
  const MechanicsResult whole =
      Solid(options).solve(stub(), loads, [&total](const ProgressReport&) { ++total; });
  EXPECT_GT(total, 10);
  bool went_on = false;
  for (int first = total / 4; first < total; first += std::max(1, total / stops)) {
    const std::string what = "stopped first at line " + std::to_string(first);
    Memory memory;
    int lines = first;
    EXPECT_THROW(Solid(options).solve_from(stub(), loads, memory.checkpoint(), killed_after(lines)),
                 Killed);
    went_on = went_on || !memory.kept.empty();
    lines = first + total / 3;
    try {
      Solid(options).solve_from(stub(), loads, memory.checkpoint(), killed_after(lines));
    } catch (const Killed&) {
    }
    expect_same(Solid(options).solve_from(stub(), loads, memory.checkpoint()), whole, what);
  }
  EXPECT_TRUE(went_on);
  return whole;
}

// Oracle: the solution that nothing has stopped, to the last bit: steps, iterations, shape, stress.
TEST(SolidCheckpoint, GoesOnToTheSameBits) {
  stop_and_go_on(coarse(), path({2e-3, 4e-3, 1e-3}), 4);
}

// … in a field, where the stability is stated.
TEST(SolidCheckpoint, KeepsTheStability) {
  LoadPath loads;
  for (const double part : {0.5, 1.0})
    loads.push_back(with_environment(EnvironmentLoad{part, 0}, {.uniform_field = {0.05, 0, -0.1}}));
  Memory memory;
  Solid(coarse()).solve_from(stub(), {loads[0]}, memory.checkpoint());
  const MechanicsResult on = Solid(coarse()).solve_from(stub(), loads, memory.checkpoint());
  EXPECT_EQ(on.steps.at(0).unstable_modes, 0);
  expect_same(on, Solid(coarse()).solve(stub(), loads), "in a field");
}

// … on the way to the slip-off and with its bracket half closed.
TEST(SolidCheckpointSlow, GoesOnInTheSearchForTheSlipOff) {
  stop_and_go_on(coarse(), path({3e-3, 1.0}), 2);
}

// … along a sweep with its contact, its prediction and a jump.
TEST(SolidCheckpoint, GoesOnAlongASweep) {
  using namespace surroundings;
  const auto surface = std::make_shared<const Surface>(
      Surface{TrapezoidProfile{
                  .height = 0.3e-3, .top = 4e-3, .bottom = 4e-3, .flank = 0.3e-3, .radius = 0.2e-3},
              0.3, 0});
  const Load start(SweepLoad{0.2e-3, 8.3e-3, 0.01, 0.4}, surface);
  const MechanicsResult whole = stop_and_go_on(coarse(), sweep_path(start, {9.5e-3, 13, false}), 2);
  EXPECT_TRUE(std::ranges::any_of(whole.steps, [](const MechanicsStep& step) {
    return step.contact && step.contact->energy_lost;
  }));
}

// A failed step leaves a state that more iterations can go on from; it ends as it would have.
TEST(SolidCheckpoint, KeepsTheStateBeforeAFailureForMoreIterations) {
  SolidOptions impatient = coarse();
  impatient.initial_guess = InitialGuess::none;
  impatient.max_iterations = 3;
  impatient.max_cutbacks = 0;
  const LoadPath loads = path({1e-6, 6e-3});
  Memory memory;
  const MechanicsResult failed = Solid(impatient).solve_from(stub(), loads, memory.checkpoint());
  EXPECT_EQ(failed.steps.at(0).status, Status::converged) << failed.steps[0].message;
  ASSERT_EQ(failed.steps.at(1).status, Status::failed);
  EXPECT_THAT(failed.steps[1].message, HasSubstr("step 2/2"));
  EXPECT_THAT(failed.steps[1].message, HasSubstr("relative residuals"));
  EXPECT_THAT(failed.steps[1].message, HasSubstr("the last load that converged is 1e-06 N"));
  EXPECT_EQ(memory.checkpoint().finished_steps(), 1u);
  SolidOptions patient = impatient;
  patient.max_iterations = 25;
  const MechanicsResult result = Solid(patient).solve_from(stub(), loads, memory.checkpoint());
  expect_same(result, Solid(patient).solve(stub(), loads), "with more iterations");
}

// A solution that has ended is not solved again: it takes no iteration, hence no progress.
TEST(SolidCheckpoint, OfAFinishedPathIsNotSolvedAgain) {
  const LoadPath loads = path({1e-3, 2e-3});
  Memory memory;
  const MechanicsResult whole = Solid(coarse()).solve_from(stub(), loads, memory.checkpoint());
  EXPECT_EQ(memory.checkpoint().finished_steps(), 2u);
  int lines = 0;
  expect_same(Solid(coarse()).solve_from(stub(), loads, memory.checkpoint(), killed_after(lines)),
              whole, "again");
}

TEST(SolidCheckpoint, ThatCannotBeWrittenEndsTheSolution) {
  const Checkpoint full{{}, [](const Checkpoint::Entries&) { throw CheckpointError("full"); }};
  EXPECT_THROW(Solid(coarse()).solve_from(stub(), path({1e-6}), full), CheckpointError);
}

}  // namespace
}  // namespace ciliaval::fem::solid
