// SPDX-License-Identifier: LGPL-2.1-or-later
#include "analytic/elastica/sweep.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <variant>
#include <vector>

#include "problem/error.h"
#include "tests/analytic/elastica/sweeps.h"

namespace ciliaval::analytic::elastica {
using namespace surroundings;
namespace {

const Cilium paper_rod{3e-3, {{"base", 3e-3, 1e5, 0.49, 0}, {"magnet", 17e-3, 3e6, 0.49, 75e3}}};
const Cilium thin_rod{1e-3, {{"rod", 20e-3, 1e6, 0.49, 0}}};

/// A plateau of 1 mm, with flanks of 45 degrees.
Surface step(double friction) {
  return {TrapezoidProfile{
              .height = 1e-3, .top = 15e-3, .bottom = 15e-3, .flank = 1e-3, .radius = 0.5e-3},
          friction, 0};
}

Surface teeth(const TrapezoidProfile& trapezoid, double friction) {
  TrapezoidProfile in_metres = trapezoid;  // of L = 20 mm
  for (double* length :
       {&in_metres.height, &in_metres.top, &in_metres.bottom, &in_metres.flank, &in_metres.radius})
    *length *= 20e-3;
  return {in_metres, friction, 0};
}

double missing_energy(const std::vector<SweepSample>& samples) {
  double sum = 0;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    sum += samples[i].surface_work - samples[i].friction_work;
    for (const TipJump& jump : samples[i].jumps) sum -= jump.energy_lost;
  }
  return sum - (samples.back().contact.energy - samples.front().contact.energy);
}

/// Oracle: the closed form of the flat surface (tip_contact_test.cc); the friction's work is μN s.
TEST(Sweep, SlidesEvenlyOnAFlatSurface) {
  const auto samples =
      sweep(tip_problem(thin_rod), {FlatProfile{}, 0.3, 0}, straight_on(0.9, 0.5, 10));
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
  const auto samples = sweep(tip_problem(thin_rod), {FlatProfile{}, mu, 0}, places);
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
    const auto samples = sweep(tip_problem(paper_rod), step(friction), straight_on(0.95, 1.7, 170));
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
    const auto samples = sweep(tip_problem(paper_rod), step(friction), straight_on(0.95, 1.7, 170));
    double total = 0;
    for (std::size_t i = 1; i < samples.size(); ++i) total += std::abs(samples[i].surface_work);
    EXPECT_NEAR(missing_energy(samples), 0, 1e-6 * total) << friction;
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
  const auto few = sweep(tip_problem(paper_rod), step(0.3), straight_on(0.95, 1.7, 17));
  const auto many = sweep(tip_problem(paper_rod), step(0.3), straight_on(0.95, 1.7, 340));
  EXPECT_NEAR(place(few), place(many), 1e-6);
  EXPECT_NEAR(jumps(few).at(0).energy_lost, jumps(many).at(0).energy_lost, 1e-6);
  EXPECT_NEAR(few.back().contact.contact_x, many.back().contact.contact_x, 1e-6);
}

TEST(Sweep, LeavesACiliumAloneThatTheSurfaceDoesNotReach) {
  const auto samples =
      sweep(tip_problem(paper_rod), {FlatProfile{}, 0.3, 0}, straight_on(1.01, 0.5, 5));
  for (const SweepSample& sample : samples) {
    EXPECT_EQ(sample.state, TipState::open);
    EXPECT_EQ(sample.contact.energy, 0);
  }
}

/// A plateau that reaches the cilium, which the valleys do not: it is bent and springs back.
TEST(Sweep, SpringsBackBehindAPlateau) {
  const auto samples = sweep(tip_problem(paper_rod), step(0.1), straight_on(1.01, 1.8, 180));
  EXPECT_EQ(samples.front().state, TipState::open);
  double largest = 0;
  for (const SweepSample& sample : samples) largest = std::max(largest, sample.contact.contact_x);
  EXPECT_GT(largest, 0.25);
  EXPECT_EQ(samples.back().state, TipState::open);
  EXPECT_EQ(samples.back().contact.energy, 0);
}

/// The tip that falls off a tooth meets the next one before it is straight.
TEST(Sweep, LandsOnTheNextTooth) {
  const auto samples =
      sweep(tip_problem(thin_rod),
            teeth({.height = 0.1, .top = 0.03, .bottom = 0.12, .flank = 0.02, .radius = 0.005}, 0),
            straight_on(1.04, 0.6, 60));
  bool was_bent = false;
  for (const SweepSample& sample : samples) {
    if (was_bent && !sample.jumps.empty()) {
      EXPECT_NE(sample.state, TipState::open);
    }
    was_bent = sample.contact.energy > 0.05;
  }
  EXPECT_GE(jumps(samples).size(), 2U);
  EXPECT_NEAR(missing_energy(samples), 0, 1e-5);
}

/// Edges of 20 and 40 µm, beyond which the held tip is soon pulled hard.
TEST(Sweep, FollowsNarrowEdges) {
  for (const double radius : {0.02e-3, 0.04e-3})
    for (const double friction : {0.0, 0.3}) {
      Surface surface = step(friction);
      std::get<TrapezoidProfile>(surface.profile).radius = radius;
      std::vector<SurfacePlace> places;  // from the plateau down
      for (int i = 0; i <= 20; ++i) places.push_back({0.95, 1.5 + 0.01 * i});
      const auto samples = sweep(tip_problem(paper_rod), surface, places);
      ASSERT_EQ(jumps(samples).size(), 1U) << radius << " " << friction;
      EXPECT_GT(jumps(samples)[0].energy_lost, 0);
      EXPECT_NEAR(missing_energy(samples), 0, 1e-5);
    }
}

/// The mirror image of a surface that moves the other way.
TEST(Sweep, IsTheMirrorImageOfABackwardSweep) {
  const Surface surface{SineProfile{1e-3, 30e-3}, 0.3, 0};
  // sin(k(−x)) = sin(kx + π): the mirror image of the profile is half a wavelength, 0.75 L,
  // further.
  std::vector<SurfacePlace> forward;
  std::vector<SurfacePlace> back;
  for (int i = 0; i <= 140; ++i) {
    forward.push_back({1.02, 0.01 * i});
    back.push_back({1.02, 0.75 - 0.01 * i});
  }
  const auto there = sweep(tip_problem(paper_rod), surface, forward);
  const auto here = sweep(tip_problem(paper_rod), surface, back);
  EXPECT_TRUE(std::ranges::any_of(
      there, [](const SweepSample& sample) { return sample.state != TipState::open; }));
  for (std::size_t i = 0; i < there.size(); ++i) {
    EXPECT_EQ(there[i].state, here[i].state) << i;
    EXPECT_NEAR(there[i].contact.contact_x, -here[i].contact.contact_x, 1e-7) << i;
  }
}

TEST(Sweep, StaysWhereTheSurfaceStays) {
  const auto samples =
      sweep(tip_problem(thin_rod), {FlatProfile{}, 0.3, 0}, {{0.9, 0}, {0.9, 0}, {0.9, 0.1}});
  EXPECT_EQ(samples[1].contact.contact_x, samples[0].contact.contact_x);
  EXPECT_NEAR(samples[2].contact.contact_x, samples[0].contact.contact_x, 1e-9);
}

/// Corrugations under which a tip that is pressed straight down would buckle.
TEST(Sweep, IsPressedOntoCorrugations) {
  for (const auto& [amplitude, wavelength, friction] :
       {std::tuple{0.0025, 0.1, 0.0}, {0.005, 0.2, 0.0}, {0.0025, 0.05, 0.2}}) {
    const Surface surface{SineProfile{amplitude * 20e-3, wavelength * 20e-3}, friction, 0};
    const auto samples = sweep(tip_problem(paper_rod), surface, {{0.95, 0}});
    EXPECT_EQ(samples[0].state, TipState::slip);
    EXPECT_NEAR(samples[0].contact.contact_x, 0.304, 0.06) << amplitude;
    EXPECT_LT(samples[0].contact.energy, 0.2);
  }
}

/// Newton's trials leave a profile that the tip itself does not.
TEST(Sweep, StaysOnAMeasuredProfile) {
  std::vector<double> x;
  for (int i = 0; i <= 20; ++i) x.push_back(-8e-3 + i * 14.8e-3 / 20);  // up to 0.34 L
  const SampledProfile flat(x, std::vector<double>(x.size(), 0.0));
  const auto samples = sweep(tip_problem(paper_rod), {flat, 0.3, 0}, {{0.95, 0.03}, {0.95, 0.1}});
  EXPECT_NEAR(samples[1].contact.contact_x, samples[0].contact.contact_x, 1e-9);
}

TEST(Sweep, RefusesToLeaveAMeasuredProfile) {
  const SampledProfile short_one({-10e-3, -5e-3, 5e-3, 10e-3}, {0, 0, 0, 0});
  EXPECT_THROW(sweep(tip_problem(paper_rod), {short_one, 0.1, 0}, straight_on(0.95, 2, 20)),
               InputError);
}

}  // namespace
}  // namespace ciliaval::analytic::elastica
