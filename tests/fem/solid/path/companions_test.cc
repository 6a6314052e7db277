// SPDX-License-Identifier: LGPL-2.1-or-later
// A companion that fails costs the error estimate, not the solution.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "fem/parallel.h"
#include "fem/solid/contact_run.h"
#include "fem/solid/path_run.h"
#include "problem/error.h"
#include "problem/error_estimate.h"
#include "tests/fem/solid/cilia.h"

namespace ciliaval::fem::solid {
namespace {

using testing::HasSubstr;

const Cilium rod{1e-3, {{"rod", 20e-3, 1e6, 0.3, 0}}};

std::vector<material::Hyperelastic> neo_hooke() {
  const Segment& segment = rod.segments.front();
  return {material::Hyperelastic::neo_hooke(segment.shear_modulus(), segment.bulk_modulus())};
}

/// A mesh with these planes. Few iterations make a level that finds no equilibrium.
void add_level(Levels& levels, bool has_coarser, std::vector<double> planes,
               unsigned int iterations = 25, double length = 20e-3) {
  meshes::cylinder::CylinderMeshOptions mesh = level_mesh(0);
  mesh.half = true;
  mesh.planes = std::move(planes);
  LevelOptions options{{{1e-9, iterations, 1e-9}, 2, 0.5e-3}};
  Cilium cilium = rod;
  cilium.segments.front().length = length;
  levels.all.push_back(std::make_unique<Level>(cilium, mesh, neo_hooke(), options,
                                               has_coarser ? levels.all.front().get() : nullptr));
}

const LoadPath forces{SectionLoad{1e-5, 15e-3, 0}, SectionLoad{2e-5, 15e-3, 0}};

MechanicsResult bent(Levels levels, const Checkpoint& checkpoint = {}) {
  const SolidOptions options = coarse();
  return PathRun(std::move(levels), forces, options, checkpoint, {}, MPI_COMM_WORLD).follow();
}

/// The coarsest mesh, the result's and that of the section's companion, which throws without a
/// plane at the loaded section.
Levels path_levels(const std::vector<double>& planes_of_companion) {
  Levels levels;
  add_level(levels, false, {15e-3});
  add_level(levels, true, {15e-3});
  add_level(levels, true, planes_of_companion);
  levels.finest = 1;
  levels.companions = {0, 0, 2};
  levels.error_parts = {{"all directions", 0, 1, 1}, {"section", 3, 2, 1}};
  return levels;
}

TEST(Companions, OfAPathThatThrowCostTheEstimateAlone) {
  fem::start_mpi();
  const MechanicsResult usual = bent(path_levels({15e-3}));
  for (const MechanicsStep& step : usual.steps) {
    EXPECT_TRUE(step.tip_uncertainty);
    EXPECT_EQ(step.message, "");
  }
  const auto expect_no_estimate = [&](const MechanicsResult& result, const std::string& reason) {
    ASSERT_EQ(result.steps.size(), usual.steps.size());
    for (std::size_t i = 0; i < usual.steps.size(); ++i) {
      const MechanicsStep& step = result.steps[i];
      ASSERT_EQ(step.status, Status::converged) << step.message;
      EXPECT_EQ(tip(step), tip(usual.steps[i]));
      EXPECT_FALSE(step.tip_uncertainty);
      EXPECT_THAT(step.message, HasSubstr("the numerical error is not known"));
      EXPECT_THAT(step.message, HasSubstr(reason));
    }
  };
  expect_no_estimate(bent(path_levels({})), "no plane at the loaded section");
}

TEST(Companions, OfASweepThatDoNotStartOrAreLostCostTheEstimateAlone) {
  fem::start_mpi();
  const Load start(SweepLoad{1e-3, 0, 0.01, 0},
                   std::make_shared<const surroundings::Surface>(
                       surroundings::Surface{surroundings::FlatProfile{}, 0.3, 0}));
  const LoadPath path = sweep_path(start, {0.2e-3, 3, false});
  const auto swept = [&](unsigned int iterations, double length,
                         const Checkpoint& checkpoint = {}) {
    Levels levels;
    add_level(levels, false, {}, iterations, length);
    add_level(levels, false, {});
    levels.finest = 1;
    levels.companions = {0};
    levels.error_parts = {{"all directions", 0, 1, 1}};
    const SolidOptions options = coarse();
    return ContactRun(std::move(levels), path, options, checkpoint, {}, MPI_COMM_WORLD).follow();
  };
  const MechanicsResult usual = swept(25, 20e-3);
  for (const MechanicsStep& step : usual.steps) EXPECT_TRUE(step.tip_uncertainty);
  Checkpoint::Entries kept;
  const Checkpoint keeps{{}, [&](const Checkpoint::Entries& entries) {
                           for (const auto& [name, bytes] : entries) kept[name] = bytes;
                         }};
  // Newton's method does not bend the first one aside; the second one is pressed on too far.
  for (const auto& [iterations, length] : {std::pair(1U, 20e-3), std::pair(25U, 1.5e-3)}) {
    const MechanicsResult result = swept(iterations, length, keeps);
    ASSERT_EQ(result.steps.size(), usual.steps.size());
    for (std::size_t i = 0; i < usual.steps.size(); ++i) {
      const MechanicsStep& step = result.steps[i];
      ASSERT_EQ(step.status, Status::converged) << step.message;
      EXPECT_EQ(tip(step), tip(usual.steps[i]));
      EXPECT_FALSE(step.tip_uncertainty);
      EXPECT_THAT(step.message, HasSubstr("the numerical error is not known"));
      EXPECT_THAT(step.message, HasSubstr("step 1/3"));
    }
    // A run that goes on from its first step says the same.
    Checkpoint::Entries first{{"sweep", kept.at("sweep")}};
    for (const char* name : {"1", "2", "3"}) first[name] = kept.at(name);
    const MechanicsResult again = swept(iterations, length, {first, {}});
    for (std::size_t i = 0; i < usual.steps.size(); ++i)
      EXPECT_EQ(again.steps[i].message, result.steps[i].message);
  }
}

TEST(Companions, ThatThrowHaveFailedStepsWithTheReason) {
  MechanicsResult result;
  result.steps.resize(2);
  const MechanicsResult companion =
      companion_of(result, []() -> MechanicsResult { throw InputError("too many nodes"); });
  ASSERT_EQ(companion.steps.size(), 2u);
  for (const MechanicsStep& step : companion.steps) {
    EXPECT_EQ(step.status, Status::failed);
    EXPECT_EQ(step.message, "too many nodes");
  }
  EXPECT_THROW(companion_of(result, []() -> MechanicsResult { throw RankFailure("alone"); }),
               RankFailure);
}

}  // namespace
}  // namespace ciliaval::fem::solid
