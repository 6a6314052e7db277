// SPDX-License-Identifier: LGPL-2.1-or-later
// The field of rods of rectangular and hollow section.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "analytic/elastica/elastica.h"
#include "analytic/rod/field_models.h"
#include "problem/error.h"
#include "tests/analytic/oracles/bent_rods.h"

namespace ciliaval::analytic::rod {
namespace {

using std::numbers::pi;
using Shape = CrossSection::Shape;

Cilium two_materials(const CrossSection& section) {
  return {section.shape == Shape::rectangle ? 0 : 3e-3,
          {{"base", 3e-3, 0.3e6, 0.49, 0}, {"magnet", 17e-3, 1e6, 0.49, 75e3}},
          section};
}

// Oracle: dipoles all over the volume of the bent rod.
TEST(RodSections, FieldOfTheEndFacesIsThatOfTheVolume) {
  const double turn = 30 * pi / 180;
  const CrossSection plate{
      .shape = Shape::rectangle, .width = 4e-3, .height = 1e-3, .orientation = turn};
  const CrossSection hollow{.shape = Shape::tube, .inner_diameter = 1.6e-3};
  const std::vector<Vector3> points{{0, 0, -1.55e-3}, {2e-3, -3e-3, -1e-3}, {9e-3, 4e-3, 12e-3}};
  for (const CrossSection& section : {plate, hollow}) {
    const Cilium cilium = two_materials(section);
    const double azimuth = section.shape == Shape::rectangle ? turn + pi / 2 : 0.4;
    const double force = section.shape == Shape::rectangle ? 0.5e-3 : 5e-3;
    const Deformation bent = elastica::Elastica()
                                 .solve(cilium, {ContactLoad{force, 16e-3, azimuth}})
                                 .steps.at(0)
                                 .deformation.value();
    EXPECT_GT(bent.centreline.at(20e-3).theta(), 0.2);
    const Field field = VolumeField().field(cilium, bent, points);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vector3 exact = oracle::by_dipoles(cilium, bent.centreline, points[i]);
      EXPECT_LT((field.B[i] - exact).norm(), 1e-6 * exact.norm()) << i;
      EXPECT_LT(field.uncertainty[i].norm(), 1e-10 * exact.norm()) << i;
    }
  }
}

// Oracle: inside, ∇·B = 0 is that the normal component of B does not jump across the end face.
TEST(RodSections, NormalFieldIsContinuousThroughTheEndFace) {
  const CrossSection plate{.shape = Shape::rectangle, .width = 4e-3, .height = 1e-3};
  const Cilium cilium = two_materials(plate);
  const Deformation straight =
      elastica::Elastica().solve(cilium, {ContactLoad{0, 16e-3, 0}}).undeformed;
  const double step = 1e-9;
  const Field field = VolumeField().field(cilium, straight,
                                          std::vector<Vector3>{{1e-3, 0.2e-3, 20e-3 - step},
                                                               {1e-3, 0.2e-3, 20e-3 + step},
                                                               {1e-3, 0.6e-3, 20e-3 - step},
                                                               {1e-3, 0.6e-3, 20e-3 + step}});
  EXPECT_NEAR(field.B[0].z(), field.B[1].z(), 1e-6);
  EXPECT_GT(field.B[0].z(), 0.03);
  EXPECT_LT((field.B[2] - field.B[3]).norm(), 1e-6);
}

TEST(RodSections, RefuseWhatHasNoClosedForm) {
  const Cilium cilium = two_materials({.shape = Shape::tube, .inner_diameter = 1e-3});
  const Deformation straight =
      elastica::Elastica().solve(cilium, {ContactLoad{0, 16e-3, 0}}).undeformed;
  const std::vector<Vector3> below{{0, 0, -2e-3}};
  EXPECT_THROW(
      VolumeField({.slices = VolumeOptions::Slices::stacked}).field(cilium, straight, below),
      InputError);
  EXPECT_THROW(VolumeField({.method = Method::uniform}).field(cilium, straight, below), InputError);
  EXPECT_NO_THROW(VolumeField({.method = Method::quadrature}).field(cilium, straight, below));
  const Cilium plate = two_materials({.shape = Shape::rectangle, .width = 4e-3, .height = 1e-3});
  EXPECT_THROW(VolumeField().field(plate, straight, std::vector<Vector3>{{2e-3, 0, 20e-3}}),
               InputError);
}

}  // namespace
}  // namespace ciliaval::analytic::rod
