// SPDX-License-Identifier: LGPL-2.1-or-later
// fem::Beam, the layer for the cilium, under its four loads.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "fem/beam/beam.h"
#include "fem/beam/section.h"
#include "oracles.h"
#include "problem/error.h"

namespace {

using namespace ciliaval;

Cilium paper_cilium() {
  return {3e-3, {{"base", 3e-3, 0.1e6, 0.49, 0}, {"magnet", 17e-3, 3e6, 0.49, 75e3}}};
}

std::vector<oracle::Stretch> stretches(const Cilium& cilium, bool shear_rigid) {
  std::vector<oracle::Stretch> beam;
  for (const Segment& s : cilium.segments) {
    const auto k = fem::beam::circular_section(cilium.diameter, s.young_modulus, s.poisson_ratio);
    const double E = shear_rigid ? 0 : 1 / k.EA;
    const double G = shear_rigid ? 0 : 1 / k.kGA1;
    beam.push_back({s.length, k.EI1, E - G, E, G});
  }
  return beam;
}

TEST(BeamContact, SlipsOffAtTheForceOfTheElastica) {
  // Oracle: closed form of the shear-rigid contact elastica, 5.862 mN (root of its arc length).
  fem::BeamOptions options;
  options.shear_rigid = true;
  const Cilium cilium = paper_cilium();
  const auto result = fem::Beam(options).solve(cilium, {ContactLoad{6e-3, 16e-3, 0}});
  const double exact = oracle::slip_off_force(stretches(cilium, true), 16e-3);
  EXPECT_NEAR(exact, 5.862e-3, 1e-6);
  ASSERT_TRUE(result.steps[0].slip_off_force);
  printf("slip %.3e\n", *result.steps[0].slip_off_force / exact - 1);
}

}  // namespace
