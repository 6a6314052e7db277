// SPDX-License-Identifier: LGPL-2.1-or-later
// The solid under the surface of a sweep.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "analytic/elastica/sweep.h"
#include "fem/solid/solid.h"
#include "problem/error.h"

namespace ciliaval::fem::solid {
using namespace surroundings;
namespace {

const Cilium paper{3e-3, {{"base", 3e-3, 1e5, 0.49, 0}, {"magnet", 17e-3, 3e6, 0.49, 75e3}}};
const Cilium uniform{1e-3, {{"rod", 20e-3, 1e6, 0.3, 0}}};

MechanicsResult swept(const Cilium& cilium, const Surface& surface, double interference,
                      double from, double to, unsigned int samples, double azimuth = 0,
                      bool back = false) {
  SolidOptions options;
  options.refinement = 0;
  const Load start(SweepLoad{interference, from, 0.01, azimuth},
                   std::make_shared<const Surface>(surface));
  return Solid(options).solve(cilium, sweep_path(start, {to, samples, back}));
}

/// The energy that does not balance over the path, J.
double imbalance(const MechanicsResult& result) {
  double sum = 0;
  for (std::size_t i = 1; i < result.steps.size(); ++i) {
    const SurfaceContact& contact = *result.steps[i].contact;
    sum += contact.surface_work - contact.friction_work - contact.energy_lost.value_or(0);
  }
  return sum - (result.steps.back().contact->elastic_energy -
                result.steps.front().contact->elastic_energy);
}

/// Oracle: the elastica that touches with the rim of its end's disc. Its first state is that of the
/// centreline's tip. A slender rod; shear, the clamp and its indented rim remain.
TEST(SolidSweep, SlidesOnAFlatSurfaceAsTheElastica) {
  using namespace analytic::elastica;
  const Surface flat{FlatProfile{}, 0.3, 0};
  const auto result = swept(uniform, flat, 2e-3, 0, 0.4e-3, 3, 0.5);
  TipProblem problem = tip_problem(uniform);
  TipContact centre = sweep(problem, flat, {{0.9, 0}})[0].contact;
  problem.rim = uniform.radius() / uniform.length();
  const auto oracle = sliding(problem, flat, {0.9, 0}, 1, centre);
  ASSERT_TRUE(oracle);
  const double L = uniform.length();
  const double EI = 1e6 * uniform.second_moment();
  for (const MechanicsStep& step : result.steps) {
    ASSERT_EQ(step.status, Status::converged);
    const SurfaceContact& contact = *step.contact;
    EXPECT_EQ(contact.state, SurfaceContact::State::slip);
    EXPECT_EQ(contact.where, SurfaceContact::Where::surface);
    // Where the rim has just come down, the nodes beside its lowest one have slid sideways, too.
    EXPECT_NEAR(contact.friction_force, 0.3 * contact.normal_force,
                (&step == &result.steps.front() ? 1e-5 : 1e-9) * contact.normal_force);
    EXPECT_NEAR(step.applied_force, contact.friction_force, 1e-9 * contact.normal_force);
    EXPECT_NEAR(contact.point.z(), 0.9 * L, 1e-6 * uniform.diameter);
    EXPECT_NEAR(contact.point.y(), std::tan(0.5) * contact.point.x(), 1e-12);
    // Measured: 0.1, 0.2 and 0.1 %.
    EXPECT_NEAR(contact.normal_force * L * L / EI / oracle->normal_force, 1, 0.004);
    EXPECT_NEAR(contact.point.x() / std::cos(0.5) / L / oracle->contact_x, 1, 0.004);
    EXPECT_NEAR(contact.elastic_energy * L / EI / oracle->energy, 1, 0.004);
    EXPECT_FALSE(contact.energy_lost);
  }
  const SurfaceContact& last = *result.steps[2].contact;
  EXPECT_NEAR(last.friction_work, last.friction_force * 0.2e-3, 1e-6 * last.friction_work);
  EXPECT_NEAR(last.surface_work, last.friction_work, 1e-6 * last.friction_work);
}

/// Up the steepest part of a sine and back: it slides, sticks while the surface turns, and the
/// energies balance.
TEST(SolidSweep, SticksWhereTheSurfaceTurnsAndKeepsTheBalanceOfEnergy) {
  const Surface sine{SineProfile{0.3e-3, 20e-3}, 0.3, 0};
  const auto result = swept(paper, sine, 1e-3, 0, 1e-3, 6, 0, true);
  double total = 0;
  bool stuck = false;
  for (const MechanicsStep& step : result.steps) {
    ASSERT_EQ(step.status, Status::converged) << step.message;
    total += std::abs(step.contact->surface_work);
    EXPECT_LE(std::abs(step.contact->friction_force),
              0.3 * step.contact->normal_force * (1 + 1e-9));
    stuck = stuck || step.contact->state == SurfaceContact::State::stick;
  }
  EXPECT_TRUE(stuck);
  EXPECT_EQ(result.steps[5].contact->state, SurfaceContact::State::slip);
  EXPECT_NEAR(imbalance(result), 0, 1e-3 * total);
}

TEST(SolidSweep, LeavesACiliumAloneThatTheSurfaceDoesNotReach) {
  const auto result = swept(paper, {FlatProfile{}, 0.3, 0}, -0.1e-3, 0, 1e-3, 2);
  for (const MechanicsStep& step : result.steps) {
    EXPECT_EQ(step.status, Status::converged);
    EXPECT_EQ(step.contact->state, SurfaceContact::State::open);
    EXPECT_EQ(step.contact->elastic_energy, 0);
  }
}

TEST(SolidSweep, RefusesASurfacePressedOnTooFar) {
  EXPECT_THROW(swept(paper, {FlatProfile{}, 0.3, 0}, 12e-3, 0, 1e-3, 2), InputError);
}

/// From the edge of a plateau of 1 mm down a flank of 45 degrees: the energy lost is that of the
/// elastica (tip on the centreline) to the order, and the state after it is that on the flat
/// valley.
TEST(SolidSweepSlow, JumpsDownAStep) {
  const Surface step{
      TrapezoidProfile{
          .height = 1e-3, .top = 15e-3, .bottom = 15e-3, .flank = 1e-3, .radius = 0.5e-3},
      0.3, 0};
  const auto result = swept(paper, step, 1e-3, 31.9e-3, 32.3e-3, 3);
  const auto flat = swept(paper, {FlatProfile{}, 0.3, 0}, 1e-3, 0, 1e-3, 2);
  ASSERT_EQ(result.steps[2].status, Status::converged);
  double lost = 0;
  for (const MechanicsStep& at : result.steps) lost += at.contact->energy_lost.value_or(0);
  EXPECT_NEAR(result.steps[2].contact->normal_force, flat.steps[1].contact->normal_force,
              1e-6 * flat.steps[1].contact->normal_force);
  EXPECT_NEAR(result.steps[2].contact->elastic_energy, flat.steps[1].contact->elastic_energy,
              1e-6 * flat.steps[1].contact->elastic_energy);
  EXPECT_GT(lost, 0.2 * (result.steps[0].contact->elastic_energy));
  EXPECT_LT(lost,
            result.steps[0].contact->elastic_energy - result.steps[2].contact->elastic_energy);
}

}  // namespace
}  // namespace ciliaval::fem::solid
