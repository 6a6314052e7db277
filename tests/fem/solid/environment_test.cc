// SPDX-License-Identifier: LGPL-2.1-or-later
// The solid under weight and a uniform field, against the beam, which shares no code with it.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "fem/beam/beam.h"
#include "fem/solid/solid.h"
#include "problem/error.h"
#include "tests/fem/solid/cilia.h"

namespace ciliaval::fem::solid {
namespace {

using std::numbers::pi;
using surroundings::Environment;
using surroundings::MagneticEnergy;

double over_deflection(const Environment& environment) {
  const Load load = with_environment(EnvironmentLoad{}, environment);
  const MechanicsStep solid = solved(Solid(), slender(), load);
  const Vector3 rod = tip(solved(beam::Beam(), slender(), load));
  EXPECT_LT(solid.tip_uncertainty.value(), 3e-5 * rod.x());
  return (tip(solid) - rod).norm() / rod.x();
}

// Oracle: the beam, to which the solid comes nearer with the square of the strain (4 % at B₀ = 2 T:
// neo-Hooke's law is not linear). At small loads what is left, 1.3e-5, is a little more than the
// stated 1.15e-5; the shear coefficient is not exact.
TEST(SolidEnvironment, SlenderCiliumBendsLikeTheBeam) {
  EXPECT_LT(over_deflection({.uniform_field = {0.02, 0, 0}}), 2e-5);
  EXPECT_LT(over_deflection({.uniform_field = {0.2, 0, 0}}), 3e-5);
  EXPECT_LT(over_deflection({.uniform_field = {2, 0, 0}}), 1e-3);
  EXPECT_LT(over_deflection({.gravity = {0.05, 0, 0}}), 2e-5);
  EXPECT_LT(over_deflection({.gravity = {5, 0, 0}}), 2e-3);
}

// By the law R the magnet turns with the polar rotation, which under the shear γ is half way
// between the section's d₃ and the tangent of the centreline: the solid's two laws differ by half
// of what the beam's differ by.
TEST(SolidEnvironment, LawsDifferByHalfTheShearOfTheBeam) {
  const auto difference = [](const MechanicsModel& model) {
    const auto deflection = [&](MagneticEnergy law) {
      return tip(solved(model, slender(),
                        with_environment(EnvironmentLoad{},
                                         {.uniform_field = {0.2, 0, 0}, .magnetic_energy = law})))
          .x();
    };
    return deflection(MagneticEnergy::F) - deflection(MagneticEnergy::R);
  };
  const double ratio = difference(Solid()) / difference(beam::Beam());
  EXPECT_NEAR(ratio, 0.5, 0.1);
}

// Oracle: statics. n is that of weight, load and, in the magnet, M A B₀; the forces on the base and
// the couple in between are in balance.
TEST(SolidEnvironment, SectionForcesBalanceWeightFieldAndLoad) {
  const Cilium cilium = stub_and_magnet();
  const Environment environment{.gravity = {3, 0, -9.81}, .uniform_field = {2e-3, 0, -1e-3}};
  for (const Load& load : std::vector<Load>{ContactLoad{1e-3, 16e-3, 0}, ProbeLoad{4e-3, 16e-3, 0},
                                            FlowLoad{0.2, 0}, EnvironmentLoad{}}) {
    const MechanicsStep step =
        solved(Solid({.refinement = 0}), cilium, with_environment(load, environment));
    const Centreline& line = step.deformation->centreline;
    Vector3 weight = Vector3::Zero();
    for (const Segment& s : cilium.segments)
      weight += s.length * cilium.area() * surroundings::weight_per_volume(environment, s);
    const double scale = 5e-3;  // N
    const Vector3 force = line.at(0, 0).forces.force;
    // The mesh's section is 1e-3 smaller than the circle's.
    EXPECT_LT((force - weight - step.applied_force * Vector3::UnitX()).norm(), 2e-3 * scale)
        << type(load);
    const std::size_t upper = line.piece_at(3e-3);
    const SectionState below = line.at(3e-3, upper - 1);
    const SectionState above = line.at(3e-3, upper);
    const Vector3 pole = 75e3 * cilium.area() * environment.uniform_field;
    EXPECT_LT((above.forces.force - below.forces.force - pole).norm(), 2e-3 * pole.norm());
    EXPECT_LT((above.forces.moment - below.forces.moment).norm(), 1e-6 * scale * 3e-3);
    // Nothing but the pole pulls the tip's end face.
    EXPECT_LT((line.at(20e-3).forces.force - pole).norm(), 2e-3 * pole.norm());
    EXPECT_LT(line.at(20e-3).forces.moment.norm(), 1e-3 * scale * 3e-3);
    // m′ = −r′ × n along the magnet.
    const double h = 1e-5;
    for (const double S : {6.1e-3, 11.3e-3}) {
      const CentrelinePoint at = line.at(S);
      const Vector3 slope = (line.at(S + h).forces.moment - line.at(S - h).forces.moment) / (2 * h);
      EXPECT_LT((slope + at.derivative.cross(at.forces.force)).norm(), 2e-3 * scale);
    }
  }
}

TEST(SolidEnvironment, HalfMeshIsThatOfTheWholeAndOutOfThePlaneItIsWhole) {
  const Cilium cilium = stub_and_magnet();
  const double phi = 0.7;
  const Vector3 e(std::cos(phi), std::sin(phi), 0);
  const Load in_plane = with_environment(
      SectionLoad{1e-3, 20e-3, phi},
      {.gravity = {0, 0, -9.81}, .uniform_field = 2e-3 * e, .magnetic_energy = MagneticEnergy::R});
  const MechanicsStep half = solved(Solid({.refinement = 0}), cilium, in_plane);
  const MechanicsStep whole = solved(Solid({.refinement = 0, .symmetry = false}), cilium, in_plane);
  EXPECT_LT(half.unknowns, whole.unknowns);
  EXPECT_LT((tip(half) - tip(whole)).norm(), 1e-8 * 20e-3);
  const Load across = with_environment(SectionLoad{1e-3, 20e-3, phi},
                                       {.uniform_field = 2e-3 * Vector3(-e.y(), e.x(), 0)});
  const MechanicsStep aside = solved(Solid({.refinement = 0}), cilium, across);
  EXPECT_EQ(aside.unknowns, whole.unknowns);
  // The beam goes the same way: 11 % further, its base being softer.
  const Vector3 rod = tip(solved(beam::Beam(), cilium, across));
  EXPECT_GT(std::abs(rod.dot(Vector3(-e.y(), e.x(), 0))), 0.5e-3);
  EXPECT_LT((tip(aside) - rod).norm(), 0.2 * (rod - Vector3(0, 0, 20e-3)).norm());
}

TEST(SolidEnvironment, DoesNotDependOnTheStepsBefore) {
  const Cilium cilium = stub_and_magnet();
  const Environment one{.gravity = {0, 0, -9.81}};
  const Environment other{.gravity = {0, 0, -9.81}, .uniform_field = {2e-3, 0, 0}};
  LoadPath path;
  for (const Environment& environment : {one, other})
    for (const double force : {1e-3, 2e-3})
      path.push_back(with_environment(ContactLoad{force, 16e-3, 0}, environment));
  const Solid model({.refinement = 0});
  const MechanicsResult all = model.solve(cilium, path);
  for (std::size_t i = 0; i < path.size(); ++i) {
    ASSERT_EQ(all.steps[i].status, Status::converged) << all.steps[i].message;
    EXPECT_LT((tip(all.steps[i]) - tip(solved(model, cilium, path[i]))).norm(), 1e-7 * 20e-3);
    EXPECT_NEAR(all.steps[i].applied_force, i % 2 == 0 ? 1e-3 : 2e-3, 1e-9);
  }
  // The weight pulls the tip on, and the field does.
  EXPECT_GT(tip(all.steps[0]).x(),
            tip(solved(model, cilium, ContactLoad{1e-3, 16e-3, 0})).x() * 1.1);
  EXPECT_GT(tip(all.steps[2]).x(), tip(all.steps[0]).x() * 1.1);
}

}  // namespace
}  // namespace ciliaval::fem::solid
