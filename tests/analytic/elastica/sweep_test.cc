// SPDX-License-Identifier: LGPL-2.1-or-later
#include "analytic/elastica/sweep.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "problem/error.h"

namespace ciliaval::analytic::elastica {
using namespace surroundings;
namespace {

const Cilium paper{3e-3, {{"base", 3e-3, 1e5, 0.49, 0}, {"magnet", 17e-3, 3e6, 0.49, 75e3}}};
const Cilium uniform{1e-3, {{"rod", 20e-3, 1e6, 0.49, 0}}};

/// A plateau of 1 mm, with flanks of 45 degrees.
Surface step(double friction) {
  return {TrapezoidProfile{
              .height = 1e-3, .top = 15e-3, .bottom = 15e-3, .flank = 1e-3, .radius = 0.5e-3},
          friction, 0};
}

std::vector<SurfacePlace> straight_on(double height, double travel, int samples) {
  std::vector<SurfacePlace> places;
  for (int i = 0; i <= samples; ++i) places.push_back({height, travel * i / samples});
  return places;
}

std::vector<TipJump> jumps(const std::vector<SweepSample>& samples) {
  std::vector<TipJump> all;
  for (const SweepSample& sample : samples)
    all.insert(all.end(), sample.jumps.begin(), sample.jumps.end());
  return all;
}

/// Oracle: the closed form of the flat surface (tip_contact_test.cc); the friction's work is μN s.
TEST(Sweep, SlidesEvenlyOnAFlatSurface) {
  const auto samples =
      sweep(tip_problem(uniform), {FlatProfile{}, 0.3, 0}, straight_on(0.9, 0.5, 10));
  double friction = 0;
  double work = 0;
  for (const SweepSample& sample : samples) {
    EXPECT_EQ(sample.state, TipState::slip);
    EXPECT_NEAR(sample.contact.normal_force, 1.6804930144, 1e-9);
    EXPECT_NEAR(sample.contact.x, 0.3924850548, 1e-9);
    EXPECT_TRUE(sample.jumps.empty());
    friction += sample.friction_work;
    work += sample.surface_work;
  }
  EXPECT_NEAR(friction, 0.3 * 1.6804930144 * 0.5, 1e-9);
  EXPECT_NEAR(work, friction, 1e-9);
}

/// The surface's travel reversed: the tip sticks until the pull has turned, then slides the other
/// way.
TEST(Sweep, SticksBeforeItSlidesBack) {
  const double mu = 0.1;
  std::vector<SurfacePlace> places = straight_on(0.9, 0.1, 5);
  for (int i = 1; i <= 200; ++i) places.push_back({0.9, 0.1 - 0.0005 * i});
  const auto samples = sweep(tip_problem(uniform), {FlatProfile{}, mu, 0}, places);
  EXPECT_EQ(samples[5].state, TipState::slip);
  EXPECT_EQ(samples[6].state, TipState::stick);
  for (std::size_t i = 6; i < samples.size(); ++i) {
    const SweepSample& sample = samples[i];
    if (sample.state == TipState::stick) {
      EXPECT_NEAR(sample.contact.contact_x - sample.place.travel,
                  samples[5].contact.contact_x - 0.1, 1e-10);
      EXPECT_LE(std::abs(sample.contact.friction_force), mu * sample.contact.normal_force + 1e-9);
    } else {
      EXPECT_NEAR(sample.contact.friction_force, -mu * sample.contact.normal_force, 1e-9);
    }
  }
  EXPECT_EQ(samples.back().state, TipState::slip);
}

/// Up a step without a jump, down with one: the state before and after both is that of the flat.
TEST(Sweep, JumpsDownAStep) {
  for (const double friction : {0.0, 0.3}) {
    const auto samples = sweep(tip_problem(paper), step(friction), straight_on(0.95, 1.7, 170));
    for (std::size_t i = 0; i <= 158; ++i) EXPECT_TRUE(samples[i].jumps.empty()) << i;
    ASSERT_EQ(jumps(samples).size(), 1U);
    EXPECT_GT(jumps(samples)[0].energy_lost, 0);
    const TipContact& first = samples.front().contact;
    const TipContact& last = samples.back().contact;
    EXPECT_NEAR(last.contact_x, first.contact_x, 1e-4);
    EXPECT_GT(samples[120].contact.energy, 1.9 * first.energy);  // on the plateau
  }
}

/// Work of the surface = elastic energy + friction + what jumps lose.
TEST(Sweep, KeepsTheBalanceOfEnergy) {
  for (const double friction : {0.0, 0.3}) {
    const auto samples = sweep(tip_problem(paper), step(friction), straight_on(0.95, 1.7, 170));
    double sum = 0;
    double total = 0;
    for (std::size_t i = 1; i < samples.size(); ++i) {
      sum += samples[i].surface_work - samples[i].friction_work;
      total += std::abs(samples[i].surface_work);
      for (const TipJump& jump : samples[i].jumps) sum -= jump.energy_lost;
    }
    EXPECT_NEAR(sum, samples.back().contact.energy - samples.front().contact.energy, 1e-6 * total)
        << friction;
  }
}

/// The place of the jump and its energy, whatever the samples.
TEST(Sweep, DoesNotDependOnTheSamples) {
  const auto place = [](const std::vector<SweepSample>& samples) {
    for (std::size_t i = 1; i < samples.size(); ++i)
      if (!samples[i].jumps.empty())
        return std::lerp(samples[i - 1].place.travel, samples[i].place.travel,
                         samples[i].jumps.front().at);
    return 0.0;
  };
  const auto few = sweep(tip_problem(paper), step(0.3), straight_on(0.95, 1.7, 17));
  const auto many = sweep(tip_problem(paper), step(0.3), straight_on(0.95, 1.7, 340));
  EXPECT_NEAR(place(few), place(many), 1e-6);
  EXPECT_NEAR(jumps(few).at(0).energy_lost, jumps(many).at(0).energy_lost, 1e-6);
  EXPECT_NEAR(few.back().contact.contact_x, many.back().contact.contact_x, 1e-6);
}

TEST(Sweep, LeavesACiliumAloneThatTheSurfaceDoesNotReach) {
  const auto samples =
      sweep(tip_problem(paper), {FlatProfile{}, 0.3, 0}, straight_on(1.01, 0.5, 5));
  for (const SweepSample& sample : samples) {
    EXPECT_EQ(sample.state, TipState::open);
    EXPECT_EQ(sample.contact.energy, 0);
  }
}

/// A plateau that reaches the cilium, which the valleys do not: it is bent and springs back.
TEST(Sweep, SpringsBackBehindAPlateau) {
  const auto samples = sweep(tip_problem(paper), step(0.1), straight_on(1.01, 1.8, 180));
  EXPECT_EQ(samples.front().state, TipState::open);
  double largest = 0;
  for (const SweepSample& sample : samples) largest = std::max(largest, sample.contact.contact_x);
  EXPECT_GT(largest, 0.25);
  EXPECT_EQ(samples.back().state, TipState::open);
  EXPECT_EQ(samples.back().contact.energy, 0);
}

TEST(Sweep, RefusesToLeaveAMeasuredProfile) {
  const SampledProfile short_one({-10e-3, -5e-3, 5e-3, 10e-3}, {0, 0, 0, 0});
  EXPECT_THROW(sweep(tip_problem(paper), {short_one, 0.1, 0}, straight_on(0.95, 2, 20)),
               InputError);
}

}  // namespace
}  // namespace ciliaval::analytic::elastica
