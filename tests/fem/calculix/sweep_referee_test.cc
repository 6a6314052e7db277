// SPDX-License-Identifier: LGPL-2.1-or-later
// The solid under a sweeping surface against CalculiX: another program, another element, a contact
// by penalty with a meshed plate. Both let nodes touch; the rim's one node bears all.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <numbers>
#include <vector>

#include "fem/solid/solid.h"
#include "tests/fem/calculix/sweep_deck.h"
#include "tests/support/temporary_folder.h"

namespace ciliaval::fem::calculix {
namespace {

using namespace surroundings;

constexpr double friction = 0.3;
constexpr double degree = std::numbers::pi / 180;

Cilium paper_cilium() {
  return {3e-3, {{"base", 3e-3, 1e5, 0.49, 0}, {"magnet", 17e-3, 3e6, 0.49, 75e3}}};
}

RefereeSweep flat_sweep(unsigned int refinement) {
  return {paper_cilium(), refinement, {FlatProfile{}, friction, 0}, 1e-3, {0}};
}

std::vector<SweepState> solid_sweep(const RefereeSweep& sweep) {
  solid::SolidOptions options;
  options.refinement = sweep.refinement;
  const auto surface = std::make_shared<const Surface>(sweep.surface);
  LoadPath path;
  for (const double s : sweep.travels)
    path.emplace_back(SweepLoad{sweep.interference, s, 0.01, 0}, surface);
  std::vector<SweepState> states;
  for (const MechanicsStep& step : solid::Solid(options).solve(sweep.cilium, path).steps) {
    EXPECT_EQ(step.status, Status::converged) << step.message;
    if (!step.contact) break;
    const CentrelinePoint tip = step.deformation->centreline.at(sweep.cilium.length());
    states.push_back(
        {step.contact->normal_force, step.contact->friction_force, tip.position, tip.theta()});
  }
  return states;
}

struct Pair {
  std::vector<SweepState> calculix;
  std::vector<SweepState> solid;
};

Pair run_both(const RefereeSweep& sweep) {
  const test::TemporaryFolder folder;
  Pair pair{run_referee(sweep, folder.path()), solid_sweep(sweep)};
  for (const auto* states : {&pair.calculix, &pair.solid})
    for (const SweepState& s : *states)
      std::printf("%s: N %.4f mN, T/N %.5f, tip %.4f %.4f mm, %.3f deg\n",
                  states == &pair.solid ? "solid" : "ccx", 1e3 * s.normal_force,
                  s.friction_force / s.normal_force, 1e3 * s.tip.x(), 1e3 * s.tip.z(),
                  s.angle / degree);
  return pair;
}

/// N, x, z, angle.
std::array<double, 4> numbers(const SweepState& state) {
  return {state.normal_force, state.tip.x(), state.tip.z(), state.angle};
}

class CalculixSweepSlow : public testing::Test {
 protected:
  void SetUp() override {
    if (std::system("command -v ccx > /dev/null 2>&1") != 0)
      GTEST_SKIP() << "CalculiX is not installed: apt-get install calculix-ccx";
  }
};

// Oracle: each other, on two meshes. Their difference on the finer mesh is below 1.5 times what the
// step to it changes in both. Measured: N 0.46, x 0.036, z 0.005, angle 0.07 % apart; the changes
// are as large or larger.
TEST_F(CalculixSweepSlow, SlidesOnAFlatSurfaceAsTheSolid) {
  const Pair coarse = run_both(flat_sweep(1));
  const Pair fine = run_both(flat_sweep(2));
  ASSERT_EQ(coarse.solid.size(), 1U);
  ASSERT_EQ(fine.solid.size(), 1U);
  const auto theirs = numbers(fine.calculix[0]);
  const auto ours = numbers(fine.solid[0]);
  for (std::size_t i = 0; i < ours.size(); ++i) {
    const double changes = std::abs(theirs[i] - numbers(coarse.calculix[0])[i]) +
                           std::abs(ours[i] - numbers(coarse.solid[0])[i]);
    EXPECT_LT(changes, 0.01 * ours[i]) << i;  // measured: 0.86, 0.09, 0.02, 0.14 %
    EXPECT_LT(std::abs(theirs[i] - ours[i]), 1.5 * changes) << i;
  }
  // On the solid's rim the nodes beside the lowest one have slid sideways, too, as it came down.
  EXPECT_NEAR(fine.solid[0].friction_force, friction * fine.solid[0].normal_force,
              1e-5 * fine.solid[0].normal_force);
  EXPECT_NEAR(fine.calculix[0].friction_force, friction * fine.calculix[0].normal_force,
              1e-6 * fine.calculix[0].normal_force);
}

// Over a sine of 0.3 mm, 20 mm long, on the coarsest mesh (on the next one CalculiX gives up). N is
// as far apart as on the flat surface with this mesh, 2.0 %, which the one above brings down to
// 0.5. Measured: 1.9, 2.0 %; x 0.14 and 0.05, z 0.04 and 0.02 %; the rise of N from sample to
// sample by 0.06 %.
TEST_F(CalculixSweepSlow, FollowsASineAsTheSolid) {
  const Pair flat = run_both(flat_sweep(0));
  ASSERT_EQ(flat.solid.size(), 1U);
  const double on_the_flat = flat.calculix[0].normal_force / flat.solid[0].normal_force;
  RefereeSweep sweep = flat_sweep(0);
  sweep.surface.profile = SineProfile{0.3e-3, 20e-3};
  sweep.travels = {0, 4e-3};
  const auto [theirs, ours] = run_both(sweep);
  ASSERT_EQ(ours.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(theirs[i].normal_force / ours[i].normal_force, on_the_flat, 0.003);
    EXPECT_NEAR(theirs[i].tip.x() / ours[i].tip.x(), 1, 0.005);
    EXPECT_NEAR(theirs[i].tip.z() / ours[i].tip.z(), 1, 0.001);
    EXPECT_NEAR(theirs[i].angle, ours[i].angle, 0.2 * degree);
    // CalculiX's T/N is that of the plate's 8-node faces: 3e-5 off.
    EXPECT_NEAR(theirs[i].friction_force / theirs[i].normal_force, friction, 2e-4);
  }
  const double rise = theirs[1].normal_force / theirs[0].normal_force;
  EXPECT_GT(rise, 1.1);
  EXPECT_NEAR(ours[1].normal_force / ours[0].normal_force, rise, 0.001 * rise);
}

}  // namespace
}  // namespace ciliaval::fem::calculix
