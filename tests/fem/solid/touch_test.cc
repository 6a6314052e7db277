// SPDX-License-Identifier: LGPL-2.1-or-later
// A rigid pin that presses on the solid's mantle. Oracle: the beam with corrected joints.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

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

TEST(SolidTouch, IsTheCorrectedBeamOfASlenderCilium) {
  SolidOptions options;
  options.refinement = 0;
  for (const double friction : {0.0, 0.3, 0.6}) {
    LoadPath path;
    for (const double X : {2e-3, 5e-3, 4.9e-3, 3e-3})
      path.push_back(touched(ProbeLoad{X, 16e-3, 0.4}, mantle(friction)));
    const auto solids = Solid(options).solve(slender, path).steps;
    const auto beams = beam(slender, path).steps;
    for (std::size_t i = 0; i < path.size(); ++i) {
      SCOPED_TRACE("friction " + std::to_string(friction) + " step " + std::to_string(i));
      const MechanicsStep& solid = solids[i];
      ASSERT_EQ(solid.status, Status::converged) << solid.message;
      std::printf("mu %g X %g: H %.6g / %.6g (%+.3f %%), V %.4g / %.4g, M %+.3f %%, S %.5g / %.5g state %d %d, %zu unknowns %d its %.1f s unc %.2g\n",
        friction, magnitude(path[i]), solid.applied_force, beams[i].applied_force, 100*(solid.applied_force/beams[i].applied_force-1),
        solid.touch->vertical_force, beams[i].touch->vertical_force, 100*(solid.touch->base_moment/beams[i].touch->base_moment-1), *solid.contact_arclength, *beams[i].contact_arclength,
        (int)solid.touch->state, (int)beams[i].touch->state, solid.unknowns, solid.iterations, solid.seconds, solid.applied_force_uncertainty.value_or(-1));
      const SectionForces base = solid.deformation->centreline.at(0).forces;
      std::printf("   base F.e %.9g  z %.9g\n", base.force.x()*std::cos(.4)+base.force.y()*std::sin(.4), base.force.z());
    }
  }
}

}  // namespace
}  // namespace ciliaval::fem::solid
