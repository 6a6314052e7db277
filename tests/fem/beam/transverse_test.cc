// SPDX-License-Identifier: LGPL-2.1-or-later
// The beam that is magnetised across its axis, too. Oracles: linear theory, the elastica, statics,
// and the turned problem.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "analytic/elastica/elastica.h"
#include "fem/beam/beam.h"
#include "problem/cilium.h"
#include "problem/error.h"
#include "problem/lagrange.h"

namespace ciliaval::fem::beam {
namespace {

using std::numbers::pi;
using surroundings::Environment;
using surroundings::MagneticEnergy;
using surroundings::magnets::Shape;
constexpr std::array laws{MagneticEnergy::F, MagneticEnergy::R};

/// EI/L² = 1 N and A |M| L²/EI = 1 per T for M of unit length.
Cilium unit_cilium(const Vector3& M) {
  const double d = 1e-2;
  const double scale = 4 / (pi * d * d);
  Segment segment{"rod", 1, 64 / (pi * std::pow(d, 4)), 0.3, scale * M.z()};
  segment.transverse_magnetization = {scale * M.x(), scale * M.y()};
  return {d, {segment}};
}

Cilium two_materials() {
  Segment magnet{"magnet", 17e-3, 3e6, 0.49, 50e3};
  magnet.transverse_magnetization = {40e3, -30e3};
  return {3e-3, {{"base", 3e-3, 0.1e6, 0.49, 0}, magnet}};
}

Deformation solved(const MechanicsModel& model, const Cilium& cilium, const Environment& around,
                   double azimuth = 0) {
  const Load load = with_environment(EnvironmentLoad{1, azimuth}, around);
  const MechanicsStep step = model.solve(cilium, {load}).steps.at(0);
  EXPECT_EQ(step.status, Status::converged) << step.message;
  return step.deformation.value();
}

// Oracle: a couple c = A M B per length bends the tip by cL³/(3EI), against M towards the field.
TEST(BeamAcrossItsAxis, BendsInAFieldAlongTheAxis) {
  constexpr double field = 1e-4;
  for (const MagneticEnergy law : laws) {
    const Environment around{.uniform_field = {0, 0, field}, .magnetic_energy = law};
    const Vector3 tip = solved(Beam(), unit_cilium({0, 1, 0}), around).centreline.at(1).position;
    EXPECT_NEAR(tip.y() / field, -1.0 / 3, 1e-7);
    EXPECT_NEAR(tip.x(), 0, 1e-12);
  }
}

// Oracle: the same couple about the axis twists it by cL²/(2GJ), GJ = EI/(1 + ν).
TEST(BeamAcrossItsAxis, TwistsInAFieldAcross) {
  constexpr double field = 1e-4;
  for (const MagneticEnergy law : laws) {
    const Environment around{.uniform_field = {0, field, 0}, .magnetic_energy = law};
    const CentrelinePoint tip = solved(Beam(), unit_cilium({1, 0, 0}), around).centreline.at(1);
    EXPECT_NEAR((tip.rotation * Vector3::UnitX()).y() / field, 1.3 / 2, 1e-6);
    EXPECT_LT((tip.position - Vector3::UnitZ()).norm(), 1e-12);
  }
}

// Oracle: the elastica, which knows the same couple as that of end forces in the turned field.
TEST(BeamAcrossItsAxis, BendsLikeTheElasticaInThePlaneOfTheField) {
  const double azimuth = 0.6;
  const Vector3 e(std::cos(azimuth), std::sin(azimuth), 0);
  const Cilium cilium = unit_cilium(0.8 * e + 0.6 * Vector3::UnitZ());
  for (const MagneticEnergy law : laws)
    for (const Vector3& field : std::vector<Vector3>{1.5 * e - 0.7 * Vector3::UnitZ(),
                                                     0.5 * e + 4 * Vector3::UnitZ(), -2 * e}) {
      const Environment around{.uniform_field = field, .magnetic_energy = law};
      const Vector3 exact =
          solved(analytic::elastica::Elastica(), cilium, around, azimuth).centreline.at(1).position;
      const Vector3 tip =
          solved(Beam({.refinement = 3, .shear_rigid = true}), cilium, around, azimuth)
              .centreline.at(1)
              .position;
      EXPECT_GT(std::abs(exact.dot(e)), 0.1);
      EXPECT_LT((tip - exact).norm(), 1e-8) << field.transpose();
    }
}

// Turned by a right angle about the field, what was along the axis is across it.
TEST(BeamAcrossItsAxis, IsTheAxialOneInTheTurnedField) {
  const Vector3 axial =
      solved(analytic::elastica::Elastica(), unit_cilium({0, 0, 1}), {.uniform_field = {2, 0, 1}})
          .centreline.at(1)
          .position;
  const Vector3 across =
      solved(analytic::elastica::Elastica(), unit_cilium({1, 0, 0}), {.uniform_field = {1, 0, -2}})
          .centreline.at(1)
          .position;
  EXPECT_LT((axial - across).norm(), 1e-12);
}

TEST(BeamAcrossItsAxis, TheElasticaRefusesWhatTurnsItOutOfThePlane) {
  const Environment around{.uniform_field = {0, 0, 1}};
  const Load load = with_environment(EnvironmentLoad{}, around);
  EXPECT_THROW(analytic::elastica::Elastica().solve(unit_cilium({0, 1, 1}), {load}), InputError);
  // Without a field nothing turns it.
  EXPECT_NO_THROW(
      analytic::elastica::Elastica().solve(unit_cilium({0, 1, 1}), {SectionLoad{0.1, 1, 0}}));
}

Environment in_a_field_beside(MagneticEnergy law) {
  Environment environment{.uniform_field = {1e-3, -2e-3, 1e-3}, .magnetic_energy = law};
  environment.magnets = {{"cuboid",
                          Shape::cuboid,
                          {12e-3, 2e-3, 26e-3},
                          Quaternion(Eigen::AngleAxisd(0.4, Vector3(1, 2, 0.5).normalized())),
                          0,
                          0,
                          {6e-3, 4e-3, 5e-3},
                          {6e5, 0, -6e5}}};
  return environment;
}

/// Force and moment about the base of the fields on the dipoles A (M₁ d₁ + M₂ d₂ + M₃ a) dS of the
/// centreline, a = r' by the law F and d₃ by the law R.
SectionForces on_dipoles(const Cilium& cilium, const Centreline& line, const Environment& around) {
  SectionForces sum;
  for (std::size_t piece = 0; piece < line.pieces().size(); ++piece) {
    const auto& S = line.pieces()[piece].S;
    const Vector3 M = magnetization(cilium.segments[cilium.segment_at((S.front() + S.back()) / 2)]);
    const QuadratureRule rule = gauss_legendre(20, S.front(), S.back());
    for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
      const CentrelinePoint p = line.at(rule.nodes[i], piece);
      const Vector3 a = around.magnetic_energy == MagneticEnergy::F ? p.derivative : p.normal();
      const Vector3 m =
          cilium.area() * (p.rotation * Vector3(M.x(), M.y(), 0) + M.z() * a) * rule.weights[i];
      const auto jet = surroundings::field_of_magnets(around, p.position);
      const Vector3 force = jet.gradient.transpose() * m;
      sum.force += force;
      sum.moment += m.cross(around.uniform_field + jet.B) + p.position.cross(force);
    }
  }
  return sum;
}

// Oracle: statics. By the law F the axial part acts as poles, whose sum is the same.
TEST(BeamAcrossItsAxis, TheBaseBearsForceAndCoupleOfItsDipoles) {
  const Cilium cilium = two_materials();
  for (const MagneticEnergy law : laws) {
    const Environment around = in_a_field_beside(law);
    const Centreline line = solved(Beam({.refinement = 2}), cilium, around).centreline;
    const SectionForces exact = on_dipoles(cilium, line, around);
    const SectionForces base = line.at(0, 0).forces;
    EXPECT_GT(exact.force.norm(), 1e-5);
    EXPECT_LT((base.force - exact.force).norm(), 1e-8 * exact.force.norm());
    EXPECT_LT((base.moment - exact.moment).norm(), 1e-8 * exact.moment.norm());
  }
}

TEST(BeamAcrossItsAxis, TurnsWithItsSurroundings) {
  const double angle = 1.1;
  const Quaternion q(Eigen::AngleAxisd(angle, Vector3::UnitZ()));
  const Environment around = in_a_field_beside(MagneticEnergy::F);
  const Centreline line = solved(Beam(), two_materials(), around).centreline;
  const Centreline other =
      solved(Beam(), turned(two_materials(), angle), surroundings::turned(around, angle))
          .centreline;
  const CentrelinePoint tip = line.at(20e-3);
  EXPECT_GT((tip.position - Vector3(0, 0, 20e-3)).norm(), 1e-3);
  EXPECT_LT((other.at(20e-3).position - q * tip.position).norm(), 1e-10);
  EXPECT_LT(
      (other.at(20e-3).rotation * (q * Vector3::UnitX()) - q * (tip.rotation * Vector3::UnitX()))
          .norm(),
      1e-7);
}

}  // namespace
}  // namespace ciliaval::fem::beam
