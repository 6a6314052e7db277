// SPDX-License-Identifier: LGPL-2.1-or-later
// The field of rods that are magnetised across their axis, too.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "analytic/elastica/elastica.h"
#include "analytic/forces/wrench.h"
#include "analytic/rod/field_models.h"
#include "analytic/sources/dipole.h"
#include "problem/cilium.h"
#include "problem/error.h"
#include "problem/lagrange.h"
#include "problem/surroundings/magnets/field.h"
#include "tests/analytic/oracles/bent_rods.h"

namespace ciliaval::analytic::rod {
namespace {

using Shape = CrossSection::Shape;
using std::numbers::pi;
constexpr double M = 75e3;

double measured(const std::string& what, double value) {
  oracle::record(what, value);
  return value;
}

Segment segment(double length, const Vector3& magnetization) {
  return {
      "magnet", length, 1e6, 0.49, magnetization.z(), 0, {magnetization.x(), magnetization.y()}};
}

Cilium across_its_axis(const CrossSection& section) {
  return {section.shape == Shape::rectangle ? 0 : 3e-3,
          {{"base", 3e-3, 0.3e6, 0.49, 0}, segment(17e-3, {30e3, -50e3, 40e3})},
          section};
}

Deformation straight(const Cilium& cilium) {
  return {straight_centreline(cilium.interfaces()), nullptr};
}

Deformation bent(const Cilium& cilium, const Load& load) {
  return elastica::Elastica().solve(cilium, {load}).steps.at(0).deformation.value();
}

// Oracle: H at the middle of a cylinder of length 2h by hand, from the charge M cos φ on its
// mantle: −M/2 h/√(h² + R²); of a long one B = μ₀M/2. Measured 6e-15; margin 15.
TEST(TransverseRod, FieldInTheMiddleOfACylinder) {
  for (const double half : {0.5e-3, 2e-3, 30e-3}) {
    const Cilium cilium{3e-3, {segment(2 * half, {0, M, 0})}};
    const double h = half / std::hypot(half, 1.5e-3);
    const Field field =
        VolumeField().field(cilium, straight(cilium), std::vector<Vector3>{{0, 0, half}});
    const Vector3 exact = vacuum_permeability * M * (1 - h / 2) * Vector3::UnitY();
    EXPECT_LT(measured("middle of a cylinder", (field.B[0] - exact).norm() / exact.norm()), 1e-13);
  }
}

// Oracle: the same block lying, magnetised along its axis: closed forms of its end faces alone.
// Measured 7e-15; margin 15.
TEST(TransverseRod, AStandingBlockIsALyingOne) {
  const double a = 2e-3;
  const double b = 3e-3;
  const double c = 5e-3;
  const Cilium standing{
      0, {segment(c, {M, 0, 0})}, {.shape = Shape::rectangle, .width = a, .height = b}};
  const Cilium lying{
      0, {segment(a, {0, 0, M})}, {.shape = Shape::rectangle, .width = c, .height = b}};
  // The lying one's axis is x of the standing one, its first side −z.
  const Quaternion turn(Eigen::AngleAxisd(pi / 2, Vector3::UnitY()));
  const std::vector<Vector3> around{
      {0, 0, -2e-3}, {3e-3, 1e-3, 2e-3}, {-2e-3, 4e-3, 7e-3}, {0.3e-3, -0.4e-3, 2e-3}};
  std::vector<Vector3> in_lying;
  for (const Vector3& x : around)
    in_lying.push_back(turn.conjugate() * (x - Vector3(0, 0, c / 2)) + Vector3(0, 0, a / 2));
  const Field of_mantle = VolumeField().field(standing, straight(standing), around);
  const Field of_ends = VolumeField().field(lying, straight(lying), in_lying);
  for (std::size_t i = 0; i < around.size(); ++i) {
    const Vector3 exact = turn * of_ends.B[i];
    EXPECT_LT(measured("lying block", (of_mantle.B[i] - exact).norm() / exact.norm()), 1e-13) << i;
  }
}

// Oracle: dipoles all over the volume of the bent rod, of each section. Measured 7e-11 below the
// plate, where the dipoles' own rule is the coarser one, and 1e-14 elsewhere; margin 15.
TEST(TransverseRod, ChargesOfMantleAndEndsAreTheFieldOfTheVolume) {
  const double turn = 30 * pi / 180;
  const CrossSection plate{
      .shape = Shape::rectangle, .width = 4e-3, .height = 1e-3, .orientation = turn};
  const CrossSection hollow{.shape = Shape::tube, .inner_diameter = 1.6e-3};
  const std::vector<Vector3> points{{0, 0, -1.55e-3}, {2e-3, -3e-3, -1e-3}, {12e-3, 5e-3, 12e-3}};
  for (const CrossSection& section : {CrossSection{}, plate, hollow}) {
    const Cilium cilium = across_its_axis(section);
    const bool is_plate = section.shape == Shape::rectangle;
    const Deformation shape =
        bent(cilium, ContactLoad{is_plate ? 0.5e-3 : 5e-3, 16e-3, is_plate ? turn + pi / 2 : 0.4});
    EXPECT_GT(shape.centreline.at(20e-3).theta(), 0.2);
    const Field field = VolumeField().field(cilium, shape, points);
    Cilium axial = cilium;
    axial.segments[1].transverse_magnetization = {0, 0};
    const Field without = VolumeField().field(axial, shape, points);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vector3 exact = oracle::by_dipoles(cilium, shape.centreline, points[i]);
      const double error = (field.B[i] - exact).norm() / exact.norm();
      EXPECT_LT(measured("mantle against dipoles", error), 1e-9) << i;
      EXPECT_LT(field.uncertainty[i].norm(), 1e-9 * exact.norm()) << i;
      EXPECT_GT((without.B[i] - exact).norm(), 0.1 * exact.norm()) << i;
    }
  }
}

// Oracle: the closed form's charges. The paper's sums come nearer with the square of their number.
TEST(TransverseRod, QuadratureAndSumsComeToTheSame) {
  const Cilium cilium = across_its_axis({});
  const Deformation shape = bent(cilium, ContactLoad{2e-3, 16e-3, 0.4});
  const std::vector<Vector3> below{{-0.1e-3, 0.2e-3, -1.55e-3}};
  const auto error = [&](const VolumeOptions& options) {
    const Vector3 exact = VolumeField().field(cilium, shape, below).B[0];
    return (VolumeField(options).field(cilium, shape, below).B[0] - exact).norm() / exact.norm();
  };
  EXPECT_LT(measured("quadrature", error({.method = Method::quadrature})), 1e-10);
  const double coarse = error({.method = Method::uniform, .elements = 20});
  EXPECT_LT(coarse, 1e-2);
  EXPECT_NEAR(coarse / error({.method = Method::uniform, .elements = 40}), 4, 0.5);
  const auto line_error = [&](const LineOptions& options) {
    const Vector3 exact = LineField().field(cilium, shape, below).B[0];
    return (LineField(options).field(cilium, shape, below).B[0] - exact).norm() / exact.norm();
  };
  const double sum = line_error({.method = Method::uniform, .elements = 100});
  EXPECT_NEAR(sum / line_error({.method = Method::uniform, .elements = 200}), 4, 0.5);
}

// The quadrupole of a bent magnet about its centroid is smaller by its length over the distance.
TEST(TransverseRod, FarAwayAllModelsAreTheDipole) {
  const Cilium cilium = across_its_axis({});
  const Deformation shape = bent(cilium, ContactLoad{2e-3, 16e-3, 0.4});
  const auto differences = [&](double distance) {
    const Vector3 middle = shape.centreline.at(11.5e-3).position;
    const std::vector<Vector3> far{middle + distance * Vector3(1, 2, -2) / 3};
    const Vector3 dipole = DipoleField().field(cilium, shape, far).B[0];
    return std::array{
        (VolumeField().field(cilium, shape, far).B[0] - dipole).norm() / dipole.norm(),
        (LineField().field(cilium, shape, far).B[0] - dipole).norm() / dipole.norm()};
  };
  const auto near = differences(4);
  const auto far = differences(20);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_LT(near.at(i), 2e-3);
    EXPECT_NEAR(near.at(i) / far.at(i), 5, 0.5);
  }
}

// By the law R M turns with the sections: the same as F of an unshearable, inextensible rod.
TEST(TransverseRod, BothPushForwardsOfTheElasticaAreOne) {
  const Cilium cilium = across_its_axis({});
  const Deformation shape = bent(cilium, ContactLoad{2e-3, 16e-3, 0.4});
  const std::vector<Vector3> below{{-0.1e-3, 0.2e-3, -1.55e-3}};
  const auto difference = [&](const FieldModel& F, const FieldModel& R) {
    const Vector3 B = F.field(cilium, shape, below).B[0];
    return (R.field(cilium, shape, below).B[0] - B).norm() / B.norm();
  };
  const auto R = sources::PushForward::R;
  EXPECT_LT(difference(LineField(), LineField({.push_forward = R})), 1e-9);
  EXPECT_LT(difference(DipoleField(), DipoleField({.push_forward = R})), 1e-9);
}

TEST(TransverseRod, TurnsWithTheCilium) {
  const double angle = 1.1;
  const Quaternion q(Eigen::AngleAxisd(angle, Vector3::UnitZ()));
  const Cilium cilium = across_its_axis({});
  const Deformation shape = bent(cilium, ContactLoad{2e-3, 16e-3, 0.4});
  const Vector3 x(2e-3, -3e-3, -1e-3);
  const auto check = [&](const FieldModel& model) {
    const Vector3 B = model.field(cilium, shape, std::vector<Vector3>{x}).B[0];
    const Vector3 turned_B =
        model.field(turned(cilium, angle), turned(shape, angle), std::vector<Vector3>{q * x}).B[0];
    EXPECT_LT((turned_B - q * B).norm(), 1e-9 * B.norm());
  };
  check(VolumeField());
  check(LineField());
  check(DipoleField());
}

// Oracle: a dipole's force ∇(m·B) and torque m × B in the field of a ball far away; action and
// reaction.
TEST(TransverseRod, IsPulledAsADipoleAndPullsBack) {
  const Cilium cilium = across_its_axis({});
  const Deformation shape = bent(cilium, ContactLoad{2e-3, 16e-3, 0.4});
  const surroundings::magnets::Magnet ball{"ball",
                                           surroundings::magnets::Shape::ball,
                                           {0.5, 0.8, -1},
                                           Quaternion::Identity(),
                                           0.2,
                                           0,
                                           Vector3::Zero(),
                                           {4e5, -2e5, 6e5}};
  const auto on_cilium = forces::wrench_on_cilium(cilium, shape, {ball});
  Vector3 moment = Vector3::Zero();
  const QuadratureRule rule = gauss_legendre(40, 3e-3, 20e-3);
  for (std::size_t i = 0; i < rule.nodes.size(); ++i)
    moment += rule.weights[i] * cilium.area() *
              (shape.centreline.at(rule.nodes[i]).rotation * magnetization(cilium.segments[1]));
  const Vector3 middle = shape.centreline.at(11.5e-3).position;
  const auto jet = surroundings::magnets::jet(ball, middle);
  const Vector3 force = jet.gradient.transpose() * moment;
  const Vector3 torque = moment.cross(jet.B) + middle.cross(force);
  EXPECT_LT((on_cilium.force - force).norm(), 1e-3 * force.norm());
  EXPECT_LT((on_cilium.torque - torque).norm(), 1e-3 * torque.norm());
  const surroundings::magnets::Magnet near{"near",
                                           surroundings::magnets::Shape::ball,
                                           {9e-3, 4e-3, 12e-3},
                                           Quaternion::Identity(),
                                           3e-3,
                                           0,
                                           Vector3::Zero(),
                                           {4e5, -2e5, 6e5}};
  const auto action = forces::wrench_on_cilium(cilium, shape, {near});
  const auto reaction = forces::wrench_on_magnet(cilium, shape, near);
  EXPECT_LT(
      measured("action and reaction", (action.force + reaction.force).norm() / action.force.norm()),
      1e-8);
}

TEST(TransverseRod, RefusesWhatHasNoClosedForm) {
  const Cilium cilium = across_its_axis({});
  const std::vector<Vector3> below{{0, 0, -2e-3}};
  EXPECT_THROW(VolumeField({.slices = VolumeOptions::Slices::stacked})
                   .field(cilium, straight(cilium), below),
               InputError);
  EXPECT_THROW(VolumeField().gradient(cilium, straight(cilium), below), InputError);
}

}  // namespace
}  // namespace ciliaval::analytic::rod
