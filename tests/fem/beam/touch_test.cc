// SPDX-License-Identifier: LGPL-2.1-or-later
// A pin that touches the beam: against the elastica in the limit that both share, in any direction,
// and out of its plane by the energy.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "analytic/elastica/elastica.h"
#include "fem/beam/beam.h"
#include "problem/lagrange.h"

namespace ciliaval::fem::beam {
namespace {

constexpr double milli = 1e-3;

TouchLaw coulomb(double friction, TouchLaw::At at = TouchLaw::At::axis, double radius = 0) {
  return {TouchLaw::Law::coulomb, friction, at, radius};
}

Load touched(Load load, const TouchLaw& touch) {
  load.set_touch(touch);
  return load;
}

/// 3 mm of 0.1 MPa below 17 mm of 3 MPa, diameter 3 mm.
Cilium paper_cilium() {
  Cilium cilium;
  cilium.diameter = 3 * milli;
  cilium.segments = {
      {.name = "base", .length = 3 * milli, .young_modulus = 0.1e6, .poisson_ratio = 0.49},
      {.name = "magnet", .length = 17 * milli, .young_modulus = 3e6, .poisson_ratio = 0.49}};
  return cilium;
}

BeamOptions rigid_in_shear() {
  BeamOptions options;
  options.shear_rigid = true;
  options.error_estimate = false;
  options.degree = 7;
  return options;
}

std::vector<MechanicsStep> steps_of(const Cilium& cilium, const LoadPath& path,
                                    const BeamOptions& options = rigid_in_shear()) {
  return Beam(options).solve(cilium, path).steps;
}

void expect_same(const MechanicsStep& beam, const MechanicsStep& rod, const Cilium& cilium) {
  ASSERT_EQ(beam.status, rod.status) << beam.message << " / " << rod.message;
  if (beam.slip_off_force) {
    EXPECT_NEAR(*beam.slip_off_force / rod.slip_off_force.value(), 1, 1e-6);
  }
  if (rod.status != Status::converged) return;
  const double level = std::max(std::abs(rod.applied_force), 1e-2 * milli);
  EXPECT_NEAR(beam.applied_force, rod.applied_force, 1e-6 * level);
  EXPECT_NEAR(beam.touch->vertical_force, rod.touch->vertical_force, 1e-6 * level);
  EXPECT_NEAR(beam.touch->base_moment, rod.touch->base_moment, 1e-6 * level * cilium.length());
  EXPECT_NEAR(beam.touch->displacement, rod.touch->displacement, 1e-7 * cilium.length());
  EXPECT_EQ(beam.touch->state, rod.touch->state);
  EXPECT_NEAR(*beam.contact_arclength, *rod.contact_arclength, 1e-7 * cilium.length());
  const Vector3 tip = beam.deformation->centreline.at(cilium.length()).position;
  EXPECT_LT((tip - rod.deformation->centreline.at(cilium.length()).position).norm(),
            1e-7 * cilium.length());
}

// Forward and back, by displacement and by force, on random cilia, heights and pins.
TEST(BeamTouch, WithoutShearIsTheElastica) {
  std::mt19937 random(20261129);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int k = 0; k < 8; ++k) {
    Cilium cilium = paper_cilium();
    cilium.segments[0].young_modulus *= std::pow(30, uniform(random));
    const auto at = k % 3 == 0 ? TouchLaw::At::axis : TouchLaw::At::mantle;
    const TouchLaw law = coulomb(0.6 * uniform(random), at, 1.5 * milli * uniform(random));
    const double height = (0.1 + 0.8 * uniform(random)) * cilium.length();
    LoadPath path;
    for (const double X : {0.05, 0.2, 0.35, 0.3499, 0.34, 0.2, 0.02, 0.1})
      path.push_back(touched(ProbeLoad{X * height, height, 0}, law));
    if (k % 4 == 3) {
      const auto reached = analytic::elastica::Elastica().solve(cilium, path).steps[1];
      path.clear();
      for (const double part : {0.5, 1.0, 0.9, 0.3, 5.0, 0.2})
        path.push_back(touched(ContactLoad{part * reached.applied_force, height, 0}, law));
    }
    const auto rods = analytic::elastica::Elastica().solve(cilium, path).steps;
    const auto beams = steps_of(cilium, path);
    for (std::size_t i = 0; i < path.size(); ++i) {
      SCOPED_TRACE("cilium " + std::to_string(k) + " step " + std::to_string(i));
      expect_same(beams[i], rods[i], cilium);
    }
  }
}

TEST(BeamTouch, IsTheSameInAnyDirection) {
  const Cilium cilium = paper_cilium();
  const TouchLaw law = coulomb(0.3, TouchLaw::At::mantle, 1 * milli);
  const auto at = [&](double azimuth) {
    return steps_of(cilium, {touched(ProbeLoad{6 * milli, 16 * milli, azimuth}, law)}, {}).front();
  };
  const MechanicsStep one = at(0);
  const MechanicsStep other = at(2.1);
  EXPECT_NEAR(other.applied_force / one.applied_force, 1, 1e-9);
  EXPECT_NEAR(other.touch->vertical_force / one.touch->vertical_force, 1, 1e-8);
  const Vector3 tip = one.deformation->centreline.at(cilium.length()).position;
  const Vector3 turned = other.deformation->centreline.at(cilium.length()).position;
  EXPECT_LT((Eigen::AngleAxisd(2.1, Vector3::UnitZ()) * tip - turned).norm(), 1e-9 * tip.norm());
  EXPECT_GT(one.tip_uncertainty.value(), 0);
}

/// Energy of bending and torsion, and of weight.
double energy(const Cilium& cilium, const MechanicsStep& step, const Vector3& gravity) {
  const QuadratureRule rule = gauss_legendre(12, 0, 1);
  const std::vector<double> breaks = step.deformation->centreline.breaks();
  double sum = 0;
  for (std::size_t i = 0; i + 1 < breaks.size(); ++i)
    for (std::size_t q = 0; q < rule.nodes.size(); ++q) {
      const double S = std::lerp(breaks[i], breaks[i + 1], rule.nodes[q]);
      const Segment& segment = cilium.segments[cilium.segment_at(S)];
      const CentrelinePoint point = step.deformation->centreline.at(S);
      const Vector3 m = point.rotation.conjugate() * point.forces.moment;
      const double EI = segment.young_modulus * cilium.second_moment(0);
      const double GJ = EI / (1 + segment.poisson_ratio);
      sum += (breaks[i + 1] - breaks[i]) * rule.weights[q] *
             ((m[0] * m[0] + m[1] * m[1]) / EI + m[2] * m[2] / GJ) / 2;
      sum -= (breaks[i + 1] - breaks[i]) * rule.weights[q] * segment.density * cilium.area() *
             gravity.dot(point.position);
    }
  return sum;
}

// A strong weight across the pin's plane bends the cilium out of it and twists it. Without friction
// the work is the energy all the same; with it the base bears what the pin exerts.
TEST(BeamTouch, OutOfItsPlaneStoresTheWork) {
  Cilium cilium = paper_cilium();
  for (Segment& segment : cilium.segments) segment.density = 1100;
  surroundings::Environment environment;
  environment.gravity = {1, 12, -2};
  for (const double friction : {0.0, 0.4}) {
    const TouchLaw law = coulomb(friction, TouchLaw::At::mantle, 1 * milli);
    LoadPath path;
    constexpr int pieces = 40;
    for (int i = 0; i <= pieces; ++i) {
      path.push_back(touched(ProbeLoad{(2 + 4.0 * i / pieces) * milli, 15 * milli, 0}, law));
      path.back().set_environment(environment);
    }
    const auto steps = steps_of(cilium, path);
    ASSERT_EQ(steps.back().status, Status::converged) << steps.back().message;
    EXPECT_GT(steps.back().deformation->centreline.at(cilium.length()).position.y(), 2 * milli);
    double work = 0;
    for (int i = 0; i + 2 <= pieces; i += 2)
      work +=
          (4.0 / pieces * milli) / 3 *
          (steps[i].applied_force + 4 * steps[i + 1].applied_force + steps[i + 2].applied_force);
    const double stored = energy(cilium, steps.back(), environment.gravity) -
                          energy(cilium, steps.front(), environment.gravity);
    if (friction == 0) {
      EXPECT_NEAR(work / stored, 1, 1e-7);
    } else {
      EXPECT_GT(work / stored, 1.001);
    }
    const SectionForces base = steps.back().deformation->centreline.at(0).forces;
    double weight = 0;
    for (const Segment& segment : cilium.segments)
      weight += segment.density * cilium.area() * segment.length;
    const double level = 1e-8 * base.force.norm();
    EXPECT_NEAR(base.force.x(), steps.back().applied_force + weight * environment.gravity.x(),
                level);
    EXPECT_NEAR(base.force.z(),
                -steps.back().touch->vertical_force + weight * environment.gravity.z(), level);
  }
}

}  // namespace
}  // namespace ciliaval::fem::beam
