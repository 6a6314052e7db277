// SPDX-License-Identifier: LGPL-2.1-or-later
// A magnet that pulls the solid in. Oracle: the beam, which shares no code with the solid but for
// the search of the fold in its two numbers, and agrees with an elastica (tests/fem/beam).
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "fem/beam/beam.h"
#include "fem/solid/solid.h"
#include "problem/joints/joints.h"
#include "problem/support/rotation.h"
#include "tests/fem/solid/cilia.h"

namespace ciliaval::fem::solid {
namespace solid_pull_in {

using surroundings::Environment;
using surroundings::magnets::Magnet;
using surroundings::magnets::Shape;

/// The brick of 1.2 T at 12 mm, which leaves no equilibrium.
Environment beside_a_brick() {
  Environment environment;
  environment.magnets = {{"brick",
                          Shape::cuboid,
                          {12e-3, 0, 20e-3},
                          support::turn_to(Vector3::UnitX()),
                          0,
                          0,
                          {6e-3, 4e-3, 5e-3},
                          {0, 0, 1.2 / 1.25663706127e-6}}};
  return environment;
}

// Measured 1 % of the fraction beside the beam with corrected joints.
TEST(SolidPullInSlow, AgreesWithTheBeam) {
  Environment environment = beside_a_brick();
  LoadPath path;
  for (const double scale : {1.0, 0.03})
    path.push_back(with_environment(EnvironmentLoad{scale, 0}, environment));
  SolidOptions options = coarse();
  options.max_cutbacks = 1;  // it fails in any case
  const auto steps = Solid(options).solve(stub_and_magnet(), path).steps;
  ASSERT_EQ(steps[0].status, Status::pulled_in) << steps[0].message;
  const continuation::PullIn& solid = *steps[0].pull_in;
  const MechanicsStep beam = beam::Beam({.joints = joints::Correction::corrected})
                                 .solve(stub_and_magnet(), {path[0]})
                                 .steps[0];
  ASSERT_EQ(beam.status, Status::pulled_in) << beam.message;
  const double fraction = std::abs(solid.fraction / beam.pull_in->fraction - 1);

  EXPECT_LT(fraction, 0.05);
  const double tip = (solid.tip - beam.pull_in->tip).norm() / 20e-3;
  EXPECT_LT(tip, 0.02);
  EXPECT_EQ(solid.magnet, "brick");
  EXPECT_EQ(solid.load, solid.fraction);
  ASSERT_GT(solid.approach.size(), 2U);
  EXPECT_NEAR(solid.approach.front().smallest_eigenvalue, 1, 1e-6);
  for (std::size_t i = 1; i < solid.approach.size(); ++i)
    EXPECT_LT(solid.approach[i].smallest_eigenvalue, solid.approach[i - 1].smallest_eigenvalue);
  EXPECT_LT(std::abs(solid.approach.back().smallest_eigenvalue), 1e-2);
  // The path goes on.
  EXPECT_EQ(steps[1].status, Status::converged) << steps[1].message;
}

}  // namespace solid_pull_in
}  // namespace ciliaval::fem::solid
