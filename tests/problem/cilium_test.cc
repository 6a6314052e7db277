// SPDX-License-Identifier: LGPL-2.1-or-later
#include "problem/cilium.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "problem/error.h"

namespace ciliaval {
namespace {

Cilium paper() {
  return {3e-3, {{"base", 3e-3, 1e5, 0.49, 0}, {"magnet", 17e-3, 3e6, 0.49, 75e3}}};
}

// Oracle: hand calculation, π·3⁴/64 = 3.976078 mm⁴ and π·3²/4 = 7.068583 mm².
TEST(Cilium, HasTheSectionOfACircle) {
  EXPECT_NEAR(paper().second_moment(), 3.976078e-12, 1e-18);
  EXPECT_NEAR(paper().area(), 7.068583e-6, 1e-12);
}

Cilium rectangle(double width, double height, double orientation) {
  Cilium cilium = paper();
  cilium.diameter = 0;
  cilium.section = {.shape = CrossSection::Shape::rectangle,
                    .width = width,
                    .height = height,
                    .orientation = orientation};
  return cilium;
}

// Oracle: ab³/12 and π(d⁴ − d_i⁴)/64 by hand.
TEST(Cilium, HasTheSectionOfARectangleAndATube) {
  const Cilium plate = rectangle(5e-3, 0.84e-3, 0.3);
  EXPECT_NEAR(plate.area(), 4.2e-6, 1e-18);
  EXPECT_NEAR(plate.second_moment(0.3), 0.84e-3 * 125e-9 / 12, 1e-22);
  const double right_angle = std::numbers::pi / 2;
  EXPECT_NEAR(plate.second_moment(0.3 - right_angle), 2.46960e-13, 1e-18);
  EXPECT_EQ(plate.extent(0.3 + 2 * right_angle), 5e-3);
  EXPECT_EQ(plate.extent(0.3 + right_angle), 0.84e-3);
  EXPECT_EQ(turned(plate, -0.3).extent(0), 5e-3);
  EXPECT_EQ(plate.thickness(), 0.84e-3);
  EXPECT_NEAR(plate.radius(), 2.535034e-3, 1e-9);
  EXPECT_THROW(plate.second_moment(0.31), InputError);
  EXPECT_THROW(plate.extent(0), InputError);

  Cilium tube = paper();
  tube.section = {.shape = CrossSection::Shape::tube, .inner_diameter = 1e-3};
  EXPECT_NEAR(tube.second_moment(1), 3.976078e-12 - 0.049087e-12, 1e-18);
  EXPECT_NEAR(tube.area(), 7.068583e-6 - 0.785398e-6, 1e-12);
  EXPECT_NEAR(tube.thickness(), 1e-3, 1e-18);
}

TEST(Cilium, FindsTheSegmentOfAMaterialPoint) {
  const Cilium cilium = paper();
  EXPECT_DOUBLE_EQ(cilium.length(), 20e-3);
  EXPECT_EQ(cilium.segment_at(-1), 0U);
  EXPECT_EQ(cilium.segment_at(0), 0U);
  EXPECT_EQ(cilium.segment_at(2.999e-3), 0U);
  EXPECT_EQ(cilium.segment_at(3e-3), 1U);  // at an interface the upper one
  EXPECT_EQ(cilium.segment_at(cilium.length()), 1U);
  EXPECT_EQ(cilium.segment_at(1), 1U);
}

// Oracle: E = 9Kμ/(3K+μ) (isotropic elasticity).
TEST(Segment, ModuliAreConsistent) {
  const Segment s{"s", 1, 2e5, 0.49, 0};
  EXPECT_NEAR(9 * s.bulk_modulus() * s.shear_modulus() / (3 * s.bulk_modulus() + s.shear_modulus()),
              2e5, 1e-6);
}

TEST(Cilium, RefusesWhatIsNotPhysical) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto refused = [](auto change) {
    Cilium cilium = paper();
    change(cilium);
    EXPECT_THROW(require_valid(cilium), InputError);
  };
  EXPECT_NO_THROW(require_valid(paper()));
  EXPECT_NO_THROW(require_valid(rectangle(1e-3, 2e-3, 0)));
  EXPECT_THROW(require_valid(rectangle(1e-3, 0, 0)), InputError);
  EXPECT_THROW(require_valid(rectangle(nan, 1e-3, 0)), InputError);
  EXPECT_THROW(require_valid(rectangle(1e-3, 1e-3, nan)), InputError);
  for (const double hole : {0.0, -1e-3, 3e-3, nan})
    refused([&](Cilium& c) {
      c.section = {.shape = CrossSection::Shape::tube, .inner_diameter = hole};
    });
  refused([](Cilium& c) { c.diameter = 0; });
  refused([&](Cilium& c) { c.diameter = nan; });
  refused([](Cilium& c) { c.segments.clear(); });
  refused([](Cilium& c) { c.segments[0].length = -1; });
  refused([&](Cilium& c) { c.segments[1].length = nan; });
  refused([](Cilium& c) { c.segments[0].young_modulus = 0; });
  refused([](Cilium& c) { c.segments[0].poisson_ratio = 0.5; });
  refused([](Cilium& c) { c.segments[0].poisson_ratio = -1; });
  refused([&](Cilium& c) { c.segments[0].poisson_ratio = nan; });
  refused([&](Cilium& c) { c.segments[1].magnetization = nan; });
}

}  // namespace
}  // namespace ciliaval
