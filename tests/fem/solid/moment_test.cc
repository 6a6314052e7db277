// SPDX-License-Identifier: LGPL-2.1-or-later
// A dead couple on the end face, in the solid.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "fem/solid/solid.h"
#include "tests/fem/solid/cilia.h"

namespace ciliaval::fem::solid {
namespace {

using std::numbers::pi;

Vector3 axis(const Load& load) {
  return Vector3::UnitZ().cross(direction(load));
}

// Oracle: statics. Each section bears the couple and no force, on the half mesh and the whole one,
// also where two materials meet.
TEST(SolidMoment, EverySectionBearsTheCoupleAndNoForce) {
  const Cilium cilium{3e-3, {{"base", 3e-3, 1e5, 0.49, 0}, {"magnet", 7e-3, 3e6, 0.49, 75e3}}};
  const double M = 0.5 * 1e5 * cilium.second_moment(0) / 3e-3;
  for (const bool symmetry : {true, false}) {
    const Solid exact({.refinement = 0, .symmetry = symmetry, .newton_tolerance = 1e-11});
    const Load load = MomentLoad{M, 0.3};
    const MechanicsStep step = solved(exact, cilium, load);
    EXPECT_NEAR(step.applied_force, 0, 1e-9 * M / 10e-3);
    EXPECT_GT(tip(step).dot(direction(load)), 2e-3);
    for (const double S : {0.0, 0.7e-3, 3e-3, 5e-3, 9.9e-3, 10e-3}) {
      const auto forces = step.deformation->centreline.at(S).forces;
      EXPECT_LT((forces.moment - M * axis(load)).norm(), 1e-8 * M) << S;
      EXPECT_LT(forces.force.norm() * 10e-3, 1e-8 * M) << S;
    }
  }
}

// Oracle: κ = M/(EI) of a rod with ν = 0, whose ends may warp freely: half a turn and a whole one,
// from rest in one step. The mesh's twelve cells across are 0.2 % off the circle's EI.
TEST(SolidMoment, ASlenderRodRollsUpIntoACircle) {
  const Cilium rod = slender();
  for (const double turn : {pi, 2 * pi}) {
    const MechanicsStep step = solved(Solid(coarse()), rod, MomentLoad{turn, 0});
    const CentrelinePoint middle = step.deformation->centreline.at(0.5);
    EXPECT_NEAR(middle.curvature.y() / turn, 1, 0.02);
    const Vector3 end = tip(step);
    EXPECT_NEAR(end.x(), (1 - std::cos(turn)) / turn, 0.01);
    EXPECT_NEAR(end.z(), std::sin(turn) / turn, 0.01);
  }
}

// Claim: the bordered tangent leaves out what is of the order of the strain alone. Oracle: a dead
// force on the tip, whose tangent is exact, that bends as far; measured: as many iterations.
TEST(SolidMoment, ConvergesAsFastAsADeadForce) {
  const auto iterations = [](const Load& load) {
    return solved(Solid(coarse()), stub_and_magnet(), load).iterations;
  };
  EXPECT_LE(iterations(MomentLoad{4e-5, 0.4}), iterations(SectionLoad{3e-3, 20e-3, 0.4}) + 2);
}

}  // namespace
}  // namespace ciliaval::fem::solid
