// SPDX-License-Identifier: LGPL-2.1-or-later
// Rectangles and tubes in the beam.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "analytic/elastica/elastica.h"
#include "fem/beam/beam.h"
#include "fem/beam/section.h"
#include "problem/error.h"

namespace ciliaval::fem::beam {
namespace {

using std::numbers::pi;
using Section = CrossSection::Shape;

// Oracle: Timoshenko & Goodier, table of §109: GJ = β G l s³, β of l/s = 1, 2 and 10.
TEST(BeamSections, RectangleTwistsAsInTheTable) {
  const auto beta = [](double l) {
    return rectangular_section(l, 1, 2, 0).GJ / l;  // G = 1
  };
  EXPECT_NEAR(beta(1), 0.1406, 5e-5);
  EXPECT_NEAR(beta(2), 0.2287, 5e-5);
  EXPECT_NEAR(beta(10), 0.3123, 5e-5);
  const SectionStiffness s = rectangular_section(3, 2, 10, 0.25);
  const SectionStiffness turned = rectangular_section(2, 3, 10, 0.25);
  EXPECT_DOUBLE_EQ(s.EI1, 10 * 3 * 8 / 12.0);
  EXPECT_DOUBLE_EQ(s.EI2, 10 * 2 * 27 / 12.0);
  EXPECT_DOUBLE_EQ(s.EI1, turned.EI2);
  EXPECT_DOUBLE_EQ(s.GJ, turned.GJ);
}

// Oracle: a hole of no size is the full circle, and a thin wall has Cowper's k = ½ at ν = 0
// (2(1 + ν)/(4 + 3ν)).
TEST(BeamSections, TubeHasItsLimits) {
  const SectionStiffness full = circular_section(2, 10, 0.3);
  const SectionStiffness pierced = tube_section(2, 1e-6, 10, 0.3);
  EXPECT_NEAR(pierced.kGA1 / full.kGA1, 1, 1e-10);
  EXPECT_NEAR(pierced.EI1 / full.EI1, 1, 1e-12);
  const SectionStiffness thin = tube_section(2, 2 - 2e-4, 2, 0);  // G = 1
  EXPECT_NEAR(thin.kGA1 / (thin.EA / 2), 0.5, 1e-4);
  EXPECT_NEAR(thin.EI1 / thin.EA, 0.5, 1e-3);  // R²/2
  EXPECT_NEAR(thin.GJ / thin.EA, 0.5, 1e-3);
}

Cilium two_materials(const CrossSection& section) {
  return {section.shape == Section::rectangle ? 0 : 3e-3,
          {{"base", 3e-3, 1e6, 0.49, 0, 1000}, {"magnet", 17e-3, 5e6, 0.49, 75e3, 1700}},
          section};
}

// Oracle: the elastica, which shares no code with the beam: over the thin side and over the wide
// one, wherever the rectangle is turned, with and without an environment.
TEST(BeamSections, BendLikeTheElastica) {
  const double turn = 25 * pi / 180;
  const CrossSection plate{
      .shape = Section::rectangle, .width = 2e-3, .height = 1e-3, .orientation = turn};
  const CrossSection hollow{.shape = Section::tube, .inner_diameter = 2e-3};
  const Beam beam({.degree = 6, .refinement = 2, .shear_rigid = true});
  for (const CrossSection& section : {plate, hollow}) {
    const Cilium cilium = two_materials(section);
    for (const double azimuth : {turn, turn + pi / 2, turn - pi}) {
      const Vector3 e(std::cos(azimuth), std::sin(azimuth), 0);
      for (const bool is_surrounded : {false, true}) {
        const double force = section.shape == Section::rectangle ? 0.3e-3 : 5e-3;
        Load load = ContactLoad{force, 16e-3, azimuth};
        if (is_surrounded)
          load.set_environment(
              {.gravity = 2 * e - 9.81 * Vector3::UnitZ(), .uniform_field = 1e-3 * e});
        const MechanicsStep bent = beam.solve(cilium, {load}).steps.at(0);
        const MechanicsStep exact =
            analytic::elastica::Elastica().solve(cilium, {load}).steps.at(0);
        ASSERT_TRUE(bent.deformation && exact.deformation) << bent.message << exact.message;
        const Centreline& line = bent.deformation->centreline;
        const Centreline& reference = exact.deformation->centreline;
        for (const double S : {5e-3, 12e-3, 20e-3}) {
          EXPECT_LT((line.at(S).position - reference.at(S).position).norm(), 1e-8 * 20e-3);
          EXPECT_LT(line.at(S).rotation.angularDistance(reference.at(S).rotation), 1e-7);
        }
        EXPECT_TRUE(bent.load == load);
        EXPECT_GT(std::hypot(line.at(20e-3).position.x(), line.at(20e-3).position.y()), 1e-4);
      }
    }
  }
}

TEST(BeamSections, RefuseALoadThatIsAlongNoSide) {
  const Cilium cilium = two_materials(
      {.shape = Section::rectangle, .width = 2e-3, .height = 1e-3, .orientation = 0.1});
  EXPECT_THROW(Beam().solve(cilium, {ContactLoad{1e-3, 16e-3, 0}}), InputError);
  EXPECT_THROW(analytic::elastica::Elastica().solve(cilium, {ContactLoad{1e-3, 16e-3, 0}}),
               InputError);
}

}  // namespace
}  // namespace ciliaval::fem::beam
