// SPDX-License-Identifier: LGPL-2.1-or-later
// Rectangles and tubes in the solid, against the beam.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "fem/beam/beam.h"
#include "fem/solid/solid.h"
#include "problem/error.h"

namespace ciliaval::fem::solid {
namespace {

using std::numbers::pi;
using Section = CrossSection::Shape;

/// Slender and ν = 0, so that nothing but the strain's square parts solid and beam. EI/L² = 1 N.
Cilium slender_rod(CrossSection section) {
  Cilium cilium{section.shape == Section::rectangle ? 0 : 0.05, {{"rod", 1, 1, 0, 1}}, section};
  cilium.segments[0].young_modulus = 1 / cilium.second_moment(section.orientation + pi / 2);
  return cilium;
}

/// Distance of the tips over the deflection, and the solid's estimate of its own error.
std::pair<double, double> off_the_beam(const Cilium& cilium, const Load& load) {
  const MechanicsStep solid = Solid({.refinement = 0}).solve(cilium, {load}).steps.at(0);
  const MechanicsStep rod = beam::Beam().solve(cilium, {load}).steps.at(0);
  EXPECT_EQ(solid.status, Status::converged) << solid.message;
  const Vector3 tip = rod.deformation->centreline.at(1).position;
  const double deflection = std::hypot(tip.x(), tip.y());
  const Centreline& line = solid.deformation->centreline;
  // The section's axes turn as the beam's do.
  EXPECT_LT(line.at(1).rotation.angularDistance(rod.deformation->centreline.at(1).rotation),
            1e-2 * deflection);
  return {(line.at(1).position - tip).norm() / deflection,
          solid.tip_uncertainty.value() / deflection};
}

// Oracle: the beam, whose shear coefficients are not exact: kGA is worth 3 E I/(kGA L²) of the
// deflection, 1e-3 at L/h = 25, of which k may be wrong by some percent.
TEST(SolidSections, SlenderOnesBendLikeTheBeam) {
  const double turn = 0.3;
  const CrossSection plate{
      .shape = Section::rectangle, .width = 0.08, .height = 0.04, .orientation = turn};
  const CrossSection hollow{.shape = Section::tube, .inner_diameter = 0.03, .orientation = 0};
  for (const CrossSection& section : {plate, hollow}) {
    const Cilium cilium = slender_rod(section);
    const double azimuth = section.orientation + pi / 2;  // across the thin side
    const auto [off, estimate] = off_the_beam(cilium, SectionLoad{0.02, 1, azimuth});
    EXPECT_LT(off, 1e-4);
    EXPECT_LT(estimate, 1e-4);
    EXPECT_LT(off_the_beam(cilium, DeadLoad{0.02, azimuth}).first, 1e-4);
  }
  // Over the wide side, four times as stiff.
  EXPECT_LT(off_the_beam(slender_rod(plate), SectionLoad{0.08, 1, turn}).first, 3e-4);
}

// Oracle: half the section with a plane of symmetry is the whole one.
TEST(SolidSections, HalfIsTheWhole) {
  for (const CrossSection& section :
       {CrossSection{.shape = Section::rectangle, .width = 5e-3, .height = 1e-3},
        CrossSection{.shape = Section::tube, .inner_diameter = 1.5e-3}}) {
    const Cilium cilium{section.shape == Section::rectangle ? 0 : 3e-3,
                        {{"base", 3e-3, 0.5e6, 0.49, 0}, {"magnet", 7e-3, 2e6, 0.49, 75e3}},
                        section};
    const Load load = ContactLoad{2e-3, 8e-3, pi / 2};
    const auto tip = [&](bool symmetry) {
      SolidOptions options{.refinement = 0};
      options.symmetry = symmetry;
      const MechanicsStep step = Solid(options).solve(cilium, {load}).steps.at(0);
      EXPECT_EQ(step.status, Status::converged) << step.message;
      return Vector3(step.deformation->centreline.at(10e-3).position);
    };
    EXPECT_LT((tip(true) - tip(false)).norm(), 1e-9 * 10e-3);
  }
}

TEST(SolidSections, RefuseWhatTheyDoNotTake) {
  const Cilium cilium{0,
                      {{"rod", 10e-3, 1e6, 0.49, 0}},
                      {.shape = Section::rectangle, .width = 2e-3, .height = 1e-3}};
  EXPECT_THROW(Solid().solve(cilium, {DeadLoad{0.1, 0.5}}), InputError);
  EXPECT_THROW(Solid().solve(cilium, {DeadLoad{0.1, 0}, DeadLoad{0.1, pi / 2}}), InputError);
  SolidOptions options;
  options.mesh = "own.msh";
  EXPECT_THROW(Solid(options).solve(cilium, {DeadLoad{0.1, 0}}), InputError);
}

}  // namespace
}  // namespace ciliaval::fem::solid
