// SPDX-License-Identifier: LGPL-2.1-or-later
// The second variation of the solid: buckling loads in closed form, and the beam, which shares
// nothing with it but Lanczos's method.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "analytic/elastica/elastica.h"
#include "analytic/elastica/environment/step.h"
#include "fem/beam/beam.h"
#include "fem/solid/solid.h"
#include "tests/fem/solid/cilia.h"

namespace ciliaval::fem::solid {
namespace {

using std::numbers::pi;
using surroundings::Environment;

Load alone(const Environment& environment) {
  return with_environment(EnvironmentLoad{}, environment);
}

// Oracles: the elastica's critical load (Greenhill's weight, (π/2)² of an opposing field), which
// `ciliaval validate` states; the beam, which shears and is compressed as the solid is.
TEST(SolidStability, StraightCiliumBucklesAtTheCriticalWeightAndField) {
  for (const Environment& one :
       {Environment{.gravity = {0, 0, -1}}, Environment{.uniform_field = {0, 0, -1}}}) {
    const double critical =
        analytic::elastica::environment::critical_factor(slender(), one, 20).value();
    const auto crossing = [&](const MechanicsModel& model) {
      std::array<double, 2> eigenvalues{};
      for (const int above : {0, 1}) {
        const double factor = critical * (above == 0 ? 0.98 : 1.02);
        const MechanicsStep step = solved(
            model, slender(),
            alone({.gravity = factor * one.gravity, .uniform_field = factor * one.uniform_field}));
        EXPECT_EQ(step.unstable_modes, 2 * above);  // round: in both planes
        eigenvalues.at(static_cast<std::size_t>(above)) = step.smallest_eigenvalue.value();
        EXPECT_LT(std::abs(step.deformation->centreline.at(1).position.x()), 1e-6);
        EXPECT_EQ(step.message.empty(), above == 0) << step.message;
      }
      return 0.98 + 0.04 * eigenvalues[0] / (eigenvalues[0] - eigenvalues[1]);
    };
    const double solid = crossing(Solid(coarse()));
    const double beam = crossing(beam::Beam());
    std::printf("critical load %.4f: of the solid %.5f times that, of the beam %.5f\n", critical,
                solid, beam);
    EXPECT_NEAR(solid, 1, 5e-3);
    EXPECT_NEAR(solid / beam, 1, 2e-3);
  }
}

// Oracle: the beam, of a straight and of a bent cilium.
TEST(SolidStability, SmallestEigenvalueIsTheBeams) {
  for (const Environment& environment :
       {Environment{.gravity = {0, 0, -4}}, Environment{.gravity = {0, 0, 10}},
        Environment{.gravity = {5, 0, -9}}, Environment{.uniform_field = {0.2, 0, -4}}}) {
    const MechanicsStep solid = solved(Solid(coarse()), slender(), alone(environment));
    const MechanicsStep beam = solved(beam::Beam(), slender(), alone(environment));
    EXPECT_EQ(solid.unstable_modes, 0);
    EXPECT_EQ(beam.unstable_modes, 0);
    std::printf("smallest eigenvalue: solid %.5f, beam %.5f\n", *solid.smallest_eigenvalue,
                *beam.smallest_eigenvalue);
    EXPECT_NEAR(*solid.smallest_eigenvalue / *beam.smallest_eigenvalue, 1, 1e-2);
  }
}

// Oracle: the whole mesh. The modes of half a mesh are those that it shares with its mirror image
// and those against it. ν = 0.49: the eliminated pressures take no part in the count, which is the
// elastica's in each of two planes.
TEST(SolidStability, HalfMeshHasTheModesOfTheWhole) {
  SolidOptions whole = coarse();
  whole.symmetry = false;
  const auto compare = [&](const Environment& environment) {
    const MechanicsStep half = solved(Solid(coarse()), stub_and_magnet(), alone(environment));
    const MechanicsStep both = solved(Solid(whole), stub_and_magnet(), alone(environment));
    EXPECT_LT(half.unknowns, both.unknowns);
    EXPECT_EQ(half.unstable_modes, both.unstable_modes);
    EXPECT_NEAR(*half.smallest_eigenvalue / *both.smallest_eigenvalue, 1, 1e-6);
    EXPECT_EQ(half.message, both.message);
    return half;
  };
  const Environment opposing{.uniform_field = {0, 0, -20e-3}};
  const MechanicsStep straight = compare(opposing);
  EXPECT_EQ(
      solved(analytic::elastica::Elastica(), stub_and_magnet(), alone(opposing)).unstable_modes, 1);
  EXPECT_EQ(straight.unstable_modes, 2);
  EXPECT_LT(*straight.smallest_eigenvalue, 0);
  EXPECT_EQ(straight.message, "this equilibrium is not stable: it buckles in 2 modes");
  // The mode of a bent cilium's smallest eigenvalue lies across the plane of bending.
  EXPECT_EQ(compare({.uniform_field = {2e-3, 0, -2e-3}}).unstable_modes, 0);
}

TEST(SolidStability, IsNotJudgedWithoutPotentialEnvironmentOrFactors) {
  const Environment weight{.gravity = {0, 0, -9.81}};
  const auto is_judged = [](const SolidOptions& options, const Load& load) {
    const MechanicsStep step = solved(Solid(options), stub_and_magnet(), load);
    EXPECT_EQ(step.unstable_modes.has_value(), step.smallest_eigenvalue.has_value());
    return step.unstable_modes.has_value();
  };
  SolidOptions iterative = coarse();
  iterative.solver = solvers::SolverKind::iterative;
  EXPECT_TRUE(is_judged(coarse(), with_environment(DeadLoad{0.02, 0}, weight)));
  EXPECT_FALSE(is_judged(coarse(), DeadLoad{0.02, 0}));
  EXPECT_FALSE(is_judged(coarse(), with_environment(ContactLoad{1e-3, 16e-3, 0}, weight)));
  EXPECT_FALSE(is_judged(iterative, alone(weight)));
}

}  // namespace
}  // namespace ciliaval::fem::solid
