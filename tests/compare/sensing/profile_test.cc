// SPDX-License-Identifier: LGPL-2.1-or-later
// Levels of a surface read back from simulated readings of a sweep over it.
#include "compare/sensing/profile.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <random>
#include <string>
#include <vector>

#include "compare/models/registry.h"
#include "compare/models/run.h"
#include "tests/support/case_texts.h"

namespace ciliaval::compare::sensing {
namespace {

using Status = HeightReading::Status;

constexpr double noise = 1e-6;  ///< T
const models::ModelPair pair{"elastica", "volume"};

input::Case sweep() {
  return input::read_case(plateau_sweep(R"(travel = "52 mm"
samples = 209
azimuth = "20 deg"
[sensor]
position = [["-0.1 mm", "0.2 mm", "-1.55 mm"], ["2 mm", "0 mm", "-1.55 mm"]]
)"),
                          "steps.toml", models::known());
}

const models::CaseResult& followed() {
  static const models::CaseResult result =
      models::run(sweep(), models::mechanics_models(), models::field_models());
  return result;
}

const LevelCurve& curve() {
  static const LevelCurve value(sweep(), pair, 4e-3);
  return value;
}

/// `offset_rows`: unloaded readings, whose mean is taken off; 0: none.
SensorReadings readings(std::uint32_t seed, int offset_rows = 0) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal(0, noise);
  SensorReadings result;
  result.measured_offset = true;
  Eigen::VectorXd offset = Eigen::VectorXd::Zero(6);
  if (offset_rows > 0) {
    result.offset_variance = 1. / offset_rows;
    for (double& component : offset) component = normal(generator) / std::sqrt(offset_rows);
  }
  for (const auto& step : followed().fields.front().steps) {
    Sample sample{"", Eigen::VectorXd(6)};
    for (std::size_t s = 0; s < 2; ++s)
      sample.change.segment<3>(static_cast<Eigen::Index>(3 * s)) =
          *step->dB[s] + Vector3(normal(generator), normal(generator), normal(generator));
    sample.change -= offset;
    result.samples.push_back(std::move(sample));
  }
  return result;
}

TEST(SensedProfile, StepsOfASurfaceAreFoundWithinTheirIntervals) {
  int levels = 0;
  int inside = 0;
  std::vector<double> errors;
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    const SensedProfile profile = sense_profile(curve(), readings(seed), noise);
    // The valley, two plateaus and two valleys; the first plateau is left at once.
    ASSERT_GE(profile.levels.size(), 4U) << seed;
    for (const Level& level : profile.levels) {
      const double truth = level.interference > 1.5e-3 ? 2e-3 : 1e-3;
      errors.push_back(std::abs(level.interference - truth));
      ++levels;
      inside += errors.back() <= level.interval ? 1 : 0;
    }
  }
  std::ranges::sort(errors);
  std::cout << "levels inside their intervals: " << inside << " of " << levels
            << "; errors, um, median " << 1e6 * errors[errors.size() / 2] << ", largest "
            << 1e6 * errors.back() << '\n';
  EXPECT_GE(inside, 0.85 * levels);
  EXPECT_LT(errors.back(), 20e-6);  // of steps of 1 mm
}

// The readings of a level have the offset's noise in common: their mean has it too.
TEST(SensedProfile, IntervalsOfLevelsHoldTheNoiseOfTheOffset) {
  int levels = 0;
  int inside = 0;
  for (std::uint32_t seed = 1; seed <= 40; ++seed)
    for (const Level& level : sense_profile(curve(), readings(seed, 1), noise).levels) {
      const double truth = level.interference > 1.5e-3 ? 2e-3 : 1e-3;
      ++levels;
      inside += std::abs(level.interference - truth) <= level.interval ? 1 : 0;
    }
  EXPECT_GE(levels, 100);
  EXPECT_GE(inside, 0.85 * levels);
}

// They are of the case's path, not of the curve's.
TEST(LevelCurve, LeavesExternalModelsOfTheCaseAside) {
  input::Case c = sweep();
  input::external::ExternalModel other;
  other.name = "other";
  for (std::size_t i = 0; i < c.load_path.size(); ++i) {
    other.centrelines.push_back(straight_centreline(c.cilium.interfaces()));
    other.remarks.emplace_back();
  }
  c.external = {other};
  const LevelCurve of_case(c, pair, 4e-3);
  EXPECT_EQ(of_case.largest(), 4e-3);
  EXPECT_EQ(of_case.limit(), "");
  const Eigen::VectorXd change = readings(1).samples.front().change;
  EXPECT_EQ(of_case.nearest(change).interference, curve().nearest(change).interference);
}

TEST(SensedProfile, SaysWhereNoLevelSurfaceGivesTheReading) {
  SensorReadings read = readings(1);
  read.samples.resize(3);
  read.samples[0].change[1] += 20e-6;
  read.samples[1].change *= 3;
  const SensedProfile profile = sense_profile(curve(), read, noise);
  EXPECT_EQ(profile.readings[0].status, Status::off_curve);
  EXPECT_TRUE(profile.readings[1].status == Status::beyond ||
              profile.readings[1].status == Status::off_curve);
  EXPECT_EQ(profile.readings[2].status, Status::level);
  EXPECT_TRUE(profile.levels.empty());
}

TEST(SensedProfile, TextNamesTheSteps) {
  SensedProfile profile = sense_profile(curve(), readings(3), noise);
  profile.case_name = "steps";
  profile.models = pair;
  const std::string text = profile_text(profile);
  EXPECT_THAT(text, testing::HasSubstr("steps: levels of the surface by elastica/volume"));
  EXPECT_THAT(text, testing::HasSubstr("of 209 readings belong to levels"));
}

}  // namespace
}  // namespace ciliaval::compare::sensing
