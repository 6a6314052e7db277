// SPDX-License-Identifier: LGPL-2.1-or-later
// The solid that is magnetised across its axis, too: against the beam, statics, and dipoles all
// over its volume.
#include <gtest/gtest.h>
#include <Eigen/LU>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "analytic/body/mesh_field.h"
#include "analytic/forces/wrench.h"
#include "analytic/sources/dipole.h"
#include "fem/beam/beam.h"
#include "fem/solid/solid.h"
#include "problem/cilium.h"
#include "problem/error.h"
#include "problem/lagrange.h"
#include "tests/analytic/oracles/bent_rods.h"
#include "tests/fem/solid/cilia.h"

namespace ciliaval::fem::solid {
namespace {

using oracle::record;
using std::numbers::pi;
using surroundings::Environment;
using surroundings::MagneticEnergy;
using surroundings::magnets::Shape;

/// ν = 0: no bonded end that cannot contract. EI/L² = 1 N, A M L²/EI = 1 per T.
Cilium slender_across(double d) {
  Segment segment{"rod", 1, 64 / (pi * std::pow(d, 4)), 0, 0};
  segment.transverse_magnetization = {4 / (pi * d * d), 0};
  return {d, {segment}};
}

Cilium across_its_axis(const Vector3& M = {40e3, -30e3, 50e3}) {
  Segment magnet{"magnet", 17e-3, 3e6, 0.49, M.z()};
  magnet.transverse_magnetization = {M.x(), M.y()};
  return {3e-3, {{"base", 3e-3, 0.1e6, 0.49, 0}, magnet}};
}

// Oracle: the beam at a small load. Couples turn in the solid the mean of −∂u_z/∂X over the
// section, which under a shear force Q is Q/(GA) (1/k − 1) less than the beam's rotation; by the
// reciprocal theorem the tips differ by (1/k − 1) 3EI/(GAL²) = d²/(16L²) of the deflection (law F,
// k = 6/7), and by the law R by d²/(16L²) − 3d²/(16L²).
TEST(SolidAcrossItsAxis, SlenderCiliumBendsLikeTheBeam) {
  for (const double d : {0.1, 0.05})
    for (const MagneticEnergy law : laws) {
      const Load load = in({.uniform_field = {0, 0, 0.005}, .magnetic_energy = law});
      const double rod = tip(solved(beam::Beam(), slender_across(d), load)).x();
      const double body = tip(solved(Solid(), slender_across(d), load)).x();
      EXPECT_NEAR(rod, -0.005 / 3, 1e-6);
      const double difference = (body - rod) / rod;
      record(law == MagneticEnergy::F ? "solid to beam, law F" : "solid to beam, law R",
             difference / (d * d));
      EXPECT_LT(std::abs(difference), 0.25 * d * d);
    }
}

// Oracle: the beam twisted by the same couple, cL²/(2GJ).
TEST(SolidAcrossItsAxis, TwistsLikeTheBeam) {
  for (const MagneticEnergy law : laws) {
    const Load load = in({.uniform_field = {0, 0.005, 0}, .magnetic_energy = law});
    const Quaternion end =
        solved(Solid(), slender_across(0.05), load).deformation->centreline.at(1).rotation;
    const double twist = (end * Vector3::UnitX()).y();
    record("twist over cL²/(2GJ)", twist / 0.0025);
    EXPECT_NEAR(twist / 0.0025, 1, 5e-3);
  }
}

/// A (M₁ d₁ + M₂ d₂) dS + A M₃ dr of the magnet above S.
Vector3 moment_above(const Cilium& cilium, const Centreline& line, double S) {
  const Vector3 M = magnetization(cilium.segments.back());
  Vector3 sum = M.z() * (line.at(line.length()).position - line.at(S).position);
  const QuadratureRule rule = gauss_legendre(60, S, line.length());
  for (std::size_t i = 0; i < rule.nodes.size(); ++i)
    sum += rule.weights[i] * (line.at(rule.nodes[i]).rotation * Vector3(M.x(), M.y(), 0));
  return cilium.area() * sum;
}

// Oracle: statics. The section bears the couple on the magnet above it. The mesh's section is 1e-3
// smaller than the circle's, and M across the axis is stretched with it where it is bonded.
TEST(SolidAcrossItsAxis, SectionsBearTheCoupleAbove) {
  const Cilium cilium = across_its_axis();
  const Environment around{.uniform_field = {1e-3, 0.5e-3, 2e-3}};
  const MechanicsStep step = solved(Solid({.refinement = 0}), cilium, in(around));
  const Centreline& line = step.deformation->centreline;
  const Vector3 base = moment_above(cilium, line, 3e-3).cross(around.uniform_field);
  record("base", (line.at(0, 0).forces.moment - base).norm() / base.norm());
  EXPECT_LT((line.at(0, 0).forces.moment - base).norm(), 5e-3 * base.norm());
  for (const double S : {6.1e-3, 11.3e-3}) {
    const Vector3 exact = moment_above(cilium, line, S).cross(around.uniform_field);
    record("section", (line.at(S).forces.moment - exact).norm() / base.norm());
    EXPECT_LT((line.at(S).forces.moment - exact).norm(), 1e-2 * base.norm());
  }
}

// Oracle: the force on the charges of the body, mantle and ends.
TEST(SolidAcrossItsAxis, TheBaseBearsTheForceOfMagnets) {
  Environment around;
  around.magnets = {{"cuboid",
                     Shape::cuboid,
                     {12e-3, 2e-3, 26e-3},
                     Quaternion(Eigen::AngleAxisd(0.4, Vector3(1, 2, 0.5).normalized())),
                     0,
                     0,
                     {6e-3, 4e-3, 5e-3},
                     {6e5, 0, -6e5}}};
  const Cilium cilium = across_its_axis();
  const MechanicsStep step = solved(Solid({.refinement = 0}), cilium, in(around));
  const auto wrench = analytic::forces::wrench_on_cilium(cilium, *step.deformation, around.magnets);
  const SectionForces base = step.deformation->centreline.at(0, 0).forces;
  record("force", (base.force - wrench.force).norm() / wrench.force.norm());
  record("moment", (base.moment - wrench.torque).norm() / wrench.torque.norm());
  EXPECT_LT((base.force - wrench.force).norm(), 1e-4 * wrench.force.norm());
  EXPECT_LT((base.moment - wrench.torque).norm(), 1e-4 * wrench.torque.norm());
}

TEST(SolidAcrossItsAxis, HalfMeshIsThatOfTheWholeIfTheMagnetLiesInThePlane) {
  const double phi = 0.7;
  const Vector3 e(std::cos(phi), std::sin(phi), 0);
  const Cilium in_plane = across_its_axis(40e3 * e + 50e3 * Vector3::UnitZ());
  const std::vector<Vector3> sensor{{-0.1e-3, 0.2e-3, -1.55e-3}};
  for (const MagneticEnergy law : laws) {
    const Load load =
        in({.uniform_field = {e.x() * 1e-3, e.y() * 1e-3, 2e-3}, .magnetic_energy = law}, phi);
    const MechanicsStep half = solved(Solid({.refinement = 0}), in_plane, load);
    const MechanicsStep whole = solved(Solid({.refinement = 0, .symmetry = false}), in_plane, load);
    EXPECT_LT(half.unknowns, whole.unknowns);
    EXPECT_LT((tip(half) - tip(whole)).norm(), 1e-8 * 20e-3);
    const analytic::body::MeshField mesh;
    const Vector3 B = mesh.field(in_plane, *whole.deformation, sensor).B[0];
    EXPECT_LT((mesh.field(in_plane, *half.deformation, sensor).B[0] - B).norm(), 1e-6 * B.norm());
    EXPECT_EQ(solved(Solid({.refinement = 0}), across_its_axis(), load).unknowns, whole.unknowns);
  }
}

/// Dipoles F·M dV all over the body.
Vector3 by_dipoles(const SolidBody& body, const Vector3& x) {
  const QuadratureRule rule = gauss_legendre(6, 0, 1);
  Vector3 B = Vector3::Zero();
  for (const SolidCell& cell : body.cells)
    for (std::size_t i = 0; i < 6; ++i)
      for (std::size_t j = 0; j < 6; ++j)
        for (std::size_t k = 0; k < 6; ++k) {
          const SolidPoint p =
              evaluate(body.nodes, cell, {rule.nodes[i], rule.nodes[j], rule.nodes[k]});
          const double dV = rule.weights[i] * rule.weights[j] * rule.weights[k] *
                            p.reference_gradient.determinant();
          B += analytic::sources::dipole_field(dV * p.deformation_gradient * cell.magnetization,
                                               x - p.current);
        }
  return B;
}

// Oracle: dipoles. A load without a field leaves the half mesh, whatever M is.
TEST(SolidAcrossItsAxis, ChargesOfItsFacesAreTheFieldOfItsVolume) {
  const Cilium cilium = across_its_axis();
  const std::vector<Vector3> points{{-0.1e-3, 0.2e-3, -1.55e-3}, {14e-3, 5e-3, 12e-3}};
  const MechanicsStep step =
      solved(Solid({.refinement = 0}), cilium, SectionLoad{2e-3, 20e-3, 0.7});
  const Field field = analytic::body::MeshField().field(cilium, *step.deformation, points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector3 exact = by_dipoles(*step.deformation->body, points[i]);
    record("faces to dipoles", (field.B[i] - exact).norm() / exact.norm());
    EXPECT_LT((field.B[i] - exact).norm(), 1e-6 * exact.norm());
  }
  // M turns with the cilium from where it is in the reference.
  const Vector3 along =
      step.deformation->centreline.at(12e-3).rotation * magnetization(cilium.segments[1]);
  const Vector3 far_away(0.3, -0.4, 0.5);
  const Vector3 dipole = analytic::sources::dipole_field(
      cilium.area() * 17e-3 * along, far_away - step.deformation->centreline.at(11.5e-3).position);
  const Vector3 B = analytic::body::MeshField()
                        .field(cilium, *step.deformation, std::vector<Vector3>{far_away})
                        .B[0];
  EXPECT_LT((B - dipole).norm(), 0.03 * dipole.norm());
}

TEST(SolidAcrossItsAxis, RefusesAPathOfTwoAzimuths) {
  EXPECT_THROW(
      Solid({.refinement = 0})
          .solve(across_its_axis(), {SectionLoad{1e-3, 20e-3, 0}, SectionLoad{1e-3, 20e-3, 0.5}}),
      InputError);
}

}  // namespace
}  // namespace ciliaval::fem::solid
