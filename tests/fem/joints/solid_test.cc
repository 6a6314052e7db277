// SPDX-License-Identifier: LGPL-2.1-or-later
// Corrected beams against the solid, which shares no code with the table but the material.
#include "fem/solid/solid.h"

#include <gtest/gtest.h>

#include <cstdio>

#include "fem/beam/beam.h"

namespace ciliaval::fem {
namespace {

constexpr double d = 3e-3;  // m

Cilium two_segments(double length, double poisson, double ratio) {
  Cilium cilium;
  cilium.diameter = d;
  cilium.segments = {{"base", length * d, 1e5, poisson},
                     {"magnet", 17e-3, ratio * 1e5, poisson, 75e3}};
  return cilium;
}

MechanicsResult corrected(const Cilium& cilium, const LoadPath& path) {
  return beam::Beam({.joints = joints::Correction::corrected}).solve(cilium, path);
}

/// Displacement of the tip, m.
double deflection(const Cilium& cilium, const MechanicsStep& step) {
  const double L = cilium.length();
  return (step.deformation.value().centreline.at(L).position - L * Vector3::UnitZ()).norm();
}

double tip_difference(const Cilium& cilium, const MechanicsStep& a, const MechanicsStep& b) {
  const double L = cilium.length();
  return (a.deformation.value().centreline.at(L).position -
          b.deformation.value().centreline.at(L).position)
             .norm() /
         deflection(cilium, a);
}

// A few entries of the table in the solid: loads so small that all is linear.
TEST(CorrectedJoints, AreTheSolidsAtSmallLoads) {
  struct Entry {
    double length, poisson, ratio;
  };
  for (const auto& [length, poisson, ratio] :
       {Entry{0.5, 0.49, 30}, Entry{1, 0.3, 10}, Entry{1, 0.45, 1000}, Entry{3, 0.49, 3}}) {
    const Cilium cilium = two_segments(length, poisson, ratio);
    const LoadPath path{SectionLoad{1e-6, 0.9 * cilium.length(), 0}};
    const MechanicsResult solid = solid::Solid().solve(cilium, path);
    const double stated =
        solid.steps[0].tip_uncertainty.value() / deflection(cilium, solid.steps[0]);
    const double error = tip_difference(cilium, solid.steps[0], corrected(cilium, path).steps[0]);
    std::printf("L1/d %g, nu %g, E2/E1 %g: %.1e, the solid states %.1e\n", length, poisson, ratio,
                error, stated);
    EXPECT_LT(error, 1e-3);
  }
}

// The paper's case: 11 % without the correction.
TEST(CorrectedJoints, TheStubOfThePaper) {
  const Cilium cilium = two_segments(1, 0.49, 30);
  LoadPath path;
  for (const double force : {1e-3, 2e-3, 3e-3, 4e-3}) path.push_back(ContactLoad{force, 16e-3, 0});
  const MechanicsResult solid = solid::Solid().solve(cilium, path);
  const MechanicsResult rod = corrected(cilium, path);
  const MechanicsResult plain = beam::Beam().solve(cilium, path);
  for (std::size_t i = 0; i < path.size(); ++i) {
    const double error = tip_difference(cilium, solid.steps[i], rod.steps[i]);
    const double stated = rod.steps[i].tip_uncertainty.value() / deflection(cilium, solid.steps[i]);
    std::printf("%g mN: %.2e, states %.2e; plain %.2e\n", 1e3 * magnitude(path[i]), error, stated,
                tip_difference(cilium, solid.steps[i], plain.steps[i]));
    EXPECT_LT(error, 5e-3);
    EXPECT_GT(tip_difference(cilium, solid.steps[i], plain.steps[i]), 0.1);
  }
}

}  // namespace
}  // namespace ciliaval::fem
