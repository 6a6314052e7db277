// SPDX-License-Identifier: LGPL-2.1-or-later
// The beam's end section as a disc: its upper edge, its lower edge, its face on an edge of the
// surface, and flush on a flat one.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include "../beams.h"
#include "analytic/elastica/tip_contact.h"
#include "sweeps.h"

namespace {

using namespace ciliaval;
using namespace sweeps;
using beams::measured;
using beams::pi;
using fem::beam::TipShape;
using State = SurfaceContact::State;

const fem::beam::BeamOptions disc = options(false, TipShape::rim);

/// Oracle: the elastica that slides on one end of its section's diameter (analytic, no code
/// shared).
TEST(BeamRim, SlidesOnItsUpperEdgeAsTheElasticaDoes) {
  namespace elastica = analytic::elastica;
  const double mu = 0.3;
  const auto steps = solved(options(true, TipShape::rim), paper(), path(flat(mu), {{1e-3, 0}}));
  elastica::TipProblem problem = elastica::tip_problem(paper());
  problem.rim = 1.5e-3 / L;
  const double force = elastica::tip_stiffness(paper()) / (L * L);
  elastica::TipContact guess;
  const MechanicsStep& step = steps.front();
  const CentrelinePoint tip = step.deformation->centreline.at(L);
  guess.base_moment = step.deformation->centreline.at(0).forces.moment[1] / (force * L);
  guess.force_x = 1.01 * step.applied_force / force;
  guess.force_z = -step.contact->normal_force / force;
  const auto exact = elastica::sliding(problem, flat(mu), {0.95, 0}, 1, guess);
  ASSERT_TRUE(exact);
  EXPECT_LT(measured("N", std::abs(step.contact->normal_force / force / exact->normal_force - 1)),
            1e-9);
  EXPECT_LT(measured("x", std::abs(step.contact->point[0] / L - exact->contact_x)), 1e-9);
  EXPECT_LT(measured("angle", std::abs(tip.theta() - exact->theta)), 1e-9);
}

/// Height of the surface over the points of the section's diameter, the least of them, m.
double least_gap(const MechanicsStep& step, const surroundings::Surface& surface) {
  const auto sweep = step.load.as<SweepLoad>().value();
  const CentrelinePoint tip = step.deformation->centreline.at(L);
  double least = 1;
  for (int i = -200; i <= 200; ++i) {
    const double eta = 1.5e-3 * i / 200;
    const double x = tip.position[0] + eta * std::cos(tip.theta());
    const double z = tip.position[2] - eta * std::sin(tip.theta());
    least = std::min(least, L - sweep.interference - surface.at(x - sweep.travel).height - z);
  }
  return least;
}

/// Whatever touches, nothing of the end section is in the surface.
TEST(BeamRim, KeepsTheFaceOutOfTheSurface) {
  for (const double mu : {0.0, 0.3}) {
    const surroundings::Surface surface = step(mu);
    const auto steps = solved(disc, paper(), path(surface, straight_on(1e-3, 1.7 * L, 850)));
    for (const MechanicsStep& step : steps) {
      ASSERT_TRUE(step.contact) << step.message;
      EXPECT_EQ(step.message, "");
      EXPECT_GT(least_gap(step, surface), -1e-8 * L);
      EXPECT_GE(step.contact->normal_force, 0);
      EXPECT_LE(std::abs(step.contact->friction_force),
                mu * step.contact->normal_force + 1e-9 * step.contact->normal_force);
      const CentrelinePoint tip = step.deformation->centreline.at(L);
      const double eta = (step.contact->point - tip.position)
                             .dot(Vector3(std::cos(tip.theta()), 0, -std::sin(tip.theta())));
      EXPECT_LE(std::abs(eta), 1.5e-3 * (1 + 1e-8));
    }
    EXPECT_GE(jumps(steps).size(), 1U);
  }
}

/// Oracle: a column under pressure, N = δ/Σ(l/EA). A flat surface that comes down on the straight
/// cilium lies flush on it, and both edges bear half. At first it must be higher than the edge of a
/// bent cilium, R²/2L.
TEST(BeamRim, IsPressedFlush) {
  Places places;
  for (int i = -8; i <= 10; ++i) places.emplace_back(0.01e-3 * i, 0);
  const auto steps = solved(disc, paper(), path(flat(0.3), places));
  double compliance = 0;
  for (const Segment& s : paper().segments)
    compliance += s.length / (s.young_modulus * paper().area());
  for (std::size_t i = 0; i < steps.size(); ++i) {
    ASSERT_TRUE(steps[i].contact) << steps[i].message;
    const double pressed = places[i].first;
    if (pressed <= 0) {
      EXPECT_EQ(steps[i].contact->state, State::open);
      continue;
    }
    EXPECT_EQ(steps[i].contact->state, State::stick);
    EXPECT_NEAR(steps[i].contact->normal_force * compliance / pressed, 1, 1e-6);
    EXPECT_NEAR(steps[i].contact->point[0], 0, 1e-6 * L);
    EXPECT_NEAR(steps[i].deformation->centreline.at(L).theta(), 0, 1e-7);
  }
}

/// Oracle: the same column. The crest of a wave, whose curvature the straight cilium's end section
/// can roll on, touches the middle of its face.
TEST(BeamRim, IsPressedByACrest) {
  const surroundings::Surface wave{surroundings::SineProfile{0.2e-3, 40e-3}, 0.3, 0};
  Places places;
  for (int i = -60; i <= 10; ++i) places.emplace_back(-0.2e-3 + 0.01e-3 * i, 30e-3);
  const auto steps = solved(disc, paper(), path(wave, places));
  const SurfaceContact& contact = steps.back().contact.value();
  double compliance = 0;
  for (const Segment& s : paper().segments)
    compliance += s.length / (s.young_modulus * paper().area());
  EXPECT_EQ(steps.front().contact->state, State::open);
  EXPECT_EQ(contact.state, State::stick);
  EXPECT_NEAR(contact.normal_force * compliance / 0.1e-3, 1, 1e-6);
  EXPECT_NEAR(contact.point[0], 0, 1e-6 * L);
}

/// Oracle: the same column; a hollow holds both edges, where it is p(R) higher.
TEST(BeamRim, IsPressedByAHollow) {
  const surroundings::Surface wave{surroundings::SineProfile{0.2e-3, 10e-3}, 0.3, 0};
  Places places;
  for (int i = -100; i <= 20; ++i) places.emplace_back(0.01e-3 * i, 2.5e-3);
  const auto steps = solved(disc, paper(), path(wave, places));
  ASSERT_TRUE(steps.back().contact) << steps.back().message;
  double compliance = 0;
  for (const Segment& s : paper().segments)
    compliance += s.length / (s.young_modulus * paper().area());
  const double pressed = 0.2e-3 + wave.at(1.5e-3 - 2.5e-3).height;
  // Vertical parts of two normal forces.
  const surroundings::ProfilePoint edge = wave.at(1.5e-3 - 2.5e-3);
  const Vector3 force = steps.back().deformation->centreline.at(L).forces.force;
  EXPECT_EQ(steps.front().contact->state, State::open);
  EXPECT_NEAR(-force[2] * compliance / pressed, 1, 1e-4);
  EXPECT_NEAR(steps.back().contact->normal_force, -force[2] * std::hypot(1, edge.slope),
              0.2 * -force[2]);
  EXPECT_NEAR(steps.back().contact->point[0], 0, 1e-4 * L);
}

/// There and back again: every state on the way is one of contact, and the works balance.
TEST(BeamRim, SweepsThereAndBackAgain) {
  for (const TipShape tip : {TipShape::rim, TipShape::point})
    for (const double mu : {0.3, 0.6}) {
      Places places = straight_on(1e-3, 40e-3, 200);
      for (int i = 199; i >= 0; --i) places.push_back(places[static_cast<std::size_t>(i)]);
      const auto steps = solved(options(false, tip), paper(), path(step(mu), places));
      for (const MechanicsStep& step : steps) ASSERT_TRUE(step.contact) << step.message;
      EXPECT_LT(measured("balance", std::abs(imbalance(steps)) / total_work(steps)), 1e-6);
    }
}

/// From flush the surface drags the cilium along: it holds, tips over its edge, slides; and then it
/// is where a long sweep leads.
TEST(BeamRim, TipsOverFromFlush) {
  Places places{{-0.08e-3, 0}, {0.05e-3, 0}};
  for (int i = 1; i <= 200; ++i) places.emplace_back(0.05e-3, 5e-3 * i / 200);
  const auto steps = solved(disc, paper(), path(flat(0.3), places));
  ASSERT_TRUE(steps.back().contact) << steps.back().message;
  EXPECT_EQ(steps[1].contact->state, State::stick);
  EXPECT_EQ(steps.back().contact->state, State::slip);
  const auto swept = solved(disc, paper(), path(flat(0.3), {{0.05e-3, 0}}));
  EXPECT_NEAR(steps.back().contact->point[0], swept[0].contact->point[0], 1e-8 * L);
  EXPECT_NEAR(steps.back().contact->normal_force / swept[0].contact->normal_force, 1, 1e-6);
  EXPECT_LT(measured("balance", std::abs(imbalance(steps)) / total_work(steps)), 1e-6);
}

}  // namespace
