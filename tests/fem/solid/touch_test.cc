// SPDX-License-Identifier: LGPL-2.1-or-later
// A rigid pin that presses on the solid's mantle. Oracle: the beam with corrected joints.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "fem/beam/beam.h"
#include "fem/solid/solid.h"
#include "problem/error.h"

namespace ciliaval::fem::solid {
namespace {

/// Two materials, 20 diameters long.
const Cilium slender{1e-3, {{"base", 5e-3, 1e6, 0.45, 0}, {"magnet", 15e-3, 3e6, 0.45, 75e3}}};

Load touched(Load load, const TouchLaw& touch) {
  load.set_touch(touch);
  return load;
}

TouchLaw mantle(double friction, double radius = 1e-3) {
  return {TouchLaw::Law::coulomb, friction, TouchLaw::At::mantle, radius};
}

MechanicsResult beam(const Cilium& cilium, const LoadPath& path) {
  beam::BeamOptions options;
  options.joints = joints::Correction::corrected;
  options.error_estimate = false;
  return beam::Beam(options).solve(cilium, path);
}

/// Force and base moment at given displacements within 1 % and 0.2 % of the beam's; measured
/// without friction: 0.13 %, 0.02 %. The contact's force is the base's reaction.
void expect_corrected_beam(double friction, const std::vector<double>& displacements) {
  SolidOptions options;
  options.refinement = 0;
  LoadPath path;
  for (const double displacement : displacements)
    path.push_back(touched(ProbeLoad{displacement, 16e-3, 0.4}, mantle(friction)));
  const auto solids = Solid(options).solve(slender, path).steps;
  const auto beams = beam(slender, path).steps;
  for (std::size_t i = 0; i < path.size(); ++i) {
    SCOPED_TRACE("friction " + std::to_string(friction) + " step " + std::to_string(i));
    const MechanicsStep& solid = solids[i];
    ASSERT_EQ(solid.status, Status::converged) << solid.message;
    EXPECT_NEAR(solid.applied_force / beams[i].applied_force, 1, 1e-2);
    EXPECT_NEAR(solid.touch->base_moment / beams[i].touch->base_moment, 1, 2e-3);
    EXPECT_NEAR(solid.touch->vertical_force, beams[i].touch->vertical_force,
                0.03 * solid.applied_force);
    EXPECT_NEAR(*solid.contact_arclength, *beams[i].contact_arclength, 0.03e-3);
    EXPECT_EQ(solid.touch->state, beams[i].touch->state);
    EXPECT_NEAR(solid.touch->displacement, displacements[i], 1e-12);
    const SectionForces base = solid.deformation->centreline.at(0).forces;
    const Vector3 e(std::cos(0.4), std::sin(0.4), 0);
    EXPECT_NEAR(base.force.dot(e) / solid.applied_force, 1, 1e-7);
    EXPECT_NEAR(base.force.z(), -solid.touch->vertical_force, 1e-7 * solid.applied_force);
    EXPECT_GT(solid.applied_force_uncertainty.value(), 0);
  }
}

TEST(SolidTouch, IsTheCorrectedBeamOfASlenderCilium) {
  expect_corrected_beam(0.3, {1e-3, 0.98e-3});
}

TEST(SolidTouchSlow, IsTheCorrectedBeamToAndFro) {
  for (const double friction : {0.0, 0.3, 0.6})
    expect_corrected_beam(friction, {2e-3, 5e-3, 4.9e-3, 3e-3});
}

TEST(SolidTouchSlow, FindsThePlaceOfAForce) {
  SolidOptions options;
  options.refinement = 0;
  const Load load = touched(ContactLoad{0.05e-3, 16e-3, 0}, mantle(0.3));
  const MechanicsStep step = Solid(options).solve(slender, {load}).steps.front();
  ASSERT_EQ(step.status, Status::converged) << step.message;
  EXPECT_NEAR(step.applied_force / 0.05e-3, 1, 1e-7);
  const MechanicsStep rod = beam(slender, {load}).steps.front();
  EXPECT_NEAR(step.touch->displacement / rod.touch->displacement, 1, 1e-2);
}

TEST(SolidTouchSlow, SlipsOffAtTheFold) {
  SolidOptions options;
  options.refinement = 0;
  const Load load = touched(ContactLoad{1e-3, 16e-3, 0}, mantle(0));
  const MechanicsStep step = Solid(options).solve(slender, {load}).steps.front();
  EXPECT_EQ(step.status, Status::slipped_off) << step.message;
  const MechanicsStep rod = beam(slender, {load}).steps.front();
  EXPECT_NEAR(*step.slip_off_force / *rod.slip_off_force, 1, 1e-2);
}

TEST(SolidTouch, RefusesWhatItDoesNotModel) {
  SolidOptions options;
  options.refinement = 0;
  const auto refuses = [&](const LoadPath& path) {
    EXPECT_THROW(Solid(options).solve(slender, path), InputError);
  };
  const ProbeLoad probe{1e-3, 16e-3, 0};
  refuses({touched(probe, mantle(0.3, 0))});
  refuses({touched(probe, {TouchLaw::Law::coulomb, 0.3, TouchLaw::At::axis, 1e-3})});
  refuses({touched(probe, {TouchLaw::Law::horizontal, 0, TouchLaw::At::mantle, 1e-3})});
  refuses({touched(probe, mantle(0.3)), touched(ProbeLoad{1e-3, 15e-3, 0}, mantle(0.3))});
  Load in_field = touched(probe, mantle(0.3));
  surroundings::Environment field;
  field.uniform_field = {1e-3, 0, 0};
  in_field.set_environment(field);
  refuses({in_field});
}

}  // namespace
}  // namespace ciliaval::fem::solid
