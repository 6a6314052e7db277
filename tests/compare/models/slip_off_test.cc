// SPDX-License-Identifier: LGPL-2.1-or-later
// Rods that let go by the rim of their end face: against a closed form, and against each other.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "compare/models/evaluator.h"
#include "compare/models/registry.h"
#include "problem/continuation/slip_off.h"
#include "problem/error.h"
#include "tests/support/synthetic.h"

namespace ciliaval::test {
namespace {

using namespace compare;
using testing::HasSubstr;

constexpr double height = 16e-3;
constexpr double half_width = 0.5e-3;
constexpr double force_of_a_radian = 10e-3;  // N

Load by_rim(Load load) {
  load.set_slip_off_point(SlipOffPoint::rim);
  return load;
}

Cilium cilium_of_the_paper() {
  return {3e-3, {{"base", 3e-3, 0.1e6, 0.49, 0}, {"magnet", 17e-3, 3e6, 0.49, 75e3}}};
}

/// A stiff rod on a hinge: it leans by F/F₁. It knows where the tip of its axis comes down to the
/// height, if it is told to say so.
class Hinge : public MechanicsModel {
 public:
  explicit Hinge(bool says_the_limit) : says_the_limit_(says_the_limit) {}
  MechanicsResult solve(const Cilium& /*cilium*/, const LoadPath& path,
                        const Progress& /*progress*/) const override {
    MechanicsResult result;
    result.undeformed.centreline = tilted(L, 3e-3, Vector3::UnitX(), 0);
    for (const Load& load : path) {
      const double angle = magnitude(load) / force_of_a_radian;
      const double limit = std::acos(height / L);
      MechanicsStep step = converged(load, tilted(L, 3e-3, direction(load), angle));
      step.applied_force = magnitude(load);
      step.tip_uncertainty = 1e-6 * L;
      step.tip_angle_uncertainty = 1e-6;
      if (angle > limit) {
        step.status = Status::slipped_off;
        step.deformation.reset();
      }
      if (says_the_limit_ || angle > limit) step.slip_off_force = limit * force_of_a_radian;
      result.steps.push_back(step);
    }
    return result;
  }

 private:
  bool says_the_limit_;
};

MechanicsResult hinge_result(const Cilium& cilium, const LoadPath& path, bool says_the_limit) {
  const Hinge hinge(says_the_limit);
  MechanicsResult result = hinge.solve(cilium, path, {});
  continuation::let_go_at_rim(hinge, cilium, half_width, result);
  return result;
}

/// The part of the contact force that the kernel (1 + cos(πs/w))/(2w) asks for where the lines of a
/// straight rod have ended whose end face has its centre at z and leans by θ; by midpoints.
double shortfall(double z, double theta, double R, bool is_disc) {
  constexpr int points = 200000;
  const double w = half_width;
  double missing = 0;
  double all = 0;
  for (int i = 0; i < points; ++i) {
    const double y = R * (2 * (i + 0.5) / points - 1);
    const double width = is_disc ? std::sqrt(R * R - y * y) : 1;
    const double s = std::max(z + y * std::sin(theta) - height, -w);
    all += width;
    if (s < w)
      missing +=
          width * (0.5 - s / (2 * w) - std::sin(std::numbers::pi * s / w) / (2 * std::numbers::pi));
  }
  return missing / all;
}

/// Limit where the force falls short by 1e-6, by bisection.
double limit_of_the_hinge(double R, bool is_disc = true) {
  double borne = 0;
  double fallen = std::acos(height / L);
  for (int i = 0; i < 50; ++i) {
    const double theta = (borne + fallen) / 2;
    (shortfall(L * std::cos(theta), theta, R, is_disc) > 1e-6 ? fallen : borne) = theta;
  }
  return force_of_a_radian * borne;
}

// The formula has the disc's chords near its rim, and sin θ as it is at the limit.
constexpr double of_the_chords = 2e-5;

TEST(SlipOffAtTheRim, IsWhereTheLowestPointOfTheFaceComesDown) {
  const Cilium cilium = cilium_of_the_paper();
  const double limit = limit_of_the_hinge(1.5e-3);
  const double of_the_axis = force_of_a_radian * std::acos(height / L);
  ASSERT_LT(limit, 0.9 * of_the_axis);
  LoadPath path;
  for (const double F : {0.5 * limit, 0.999 * limit, 1.001 * limit, 1.1 * of_the_axis})
    path.push_back(by_rim(ContactLoad{F, height, 0.3}));
  path.emplace_back(ContactLoad{1.001 * limit, height, 0.3});
  for (const bool says_the_limit : {true, false}) {
    const MechanicsResult result = hinge_result(cilium, path, says_the_limit);
    for (std::size_t i = 0; i < 4; ++i) {
      const MechanicsStep& step = result.steps[i];
      EXPECT_EQ(step.status, i < 2 ? Status::converged : Status::slipped_off) << i;
      EXPECT_EQ(step.slip_off_point, SlipOffPoint::rim);
      EXPECT_EQ(step.deformation.has_value(), i < 2);
      ASSERT_EQ(step.slip_off_force.has_value(), says_the_limit || i >= 2) << i;
      if (!step.slip_off_force) continue;
      EXPECT_NEAR(*step.slip_off_force / limit, 1, of_the_chords);
      // Both errors of the tip over dz/dF = −(L sin θ + R cos θ)/F₁.
      const double theta = limit / force_of_a_radian;
      const double expected = (1e-6 * L + 1.5e-3 * 1e-6) * force_of_a_radian /
                              (L * std::sin(theta) + 1.5e-3 * std::cos(theta));
      EXPECT_NEAR(step.slip_off_uncertainty.value() / expected, 1, 1e-2);
    }
    EXPECT_THAT(result.steps[2].message, HasSubstr("the rim of the end face sinks"));
    EXPECT_EQ(result.steps[4].status, Status::converged);  // by the axis
    EXPECT_EQ(result.steps[4].slip_off_point, SlipOffPoint::axis);
  }
}

// The rim of a rectangle is an edge, by whichever side leans.
TEST(SlipOffAtTheRim, OfARectangleIsTheEdgeThatLeans) {
  Cilium cilium = cilium_of_the_paper();
  cilium.diameter = 0;
  cilium.section = {.shape = CrossSection::Shape::rectangle, .width = 4e-3, .height = 1e-3};
  for (const auto& [azimuth, R] : {std::pair{0.0, 2e-3}, {std::numbers::pi / 2, 0.5e-3}}) {
    const MechanicsResult result =
        hinge_result(cilium, {by_rim(ContactLoad{8e-3, height, azimuth})}, false);
    ASSERT_TRUE(result.steps[0].slip_off_force);
    EXPECT_NEAR(*result.steps[0].slip_off_force / limit_of_the_hinge(R, false), 1, of_the_chords);
  }
}

TEST(SlipOffAtTheRim, NeedsAnEdgeBelowTheTip) {
  EXPECT_THROW(
      hinge_result(cilium_of_the_paper(), {by_rim(ContactLoad{1e-3, L - 0.4e-3, 0})}, true),
      InputError);
}

/// Result of the registry's model of this name.
MechanicsResult rod_result(std::string_view id, const LoadPath& path) {
  const models::MechanicsEntry& entry =
      models::entry_of(models::mechanics_models(), std::string(id));
  const input::Case problem;
  return models::Evaluator(entry, problem, {}).solve(cilium_of_the_paper(), path);
}

// Oracle: two algorithms. At the limit the rim is where it should be, and the probe's
// displacement goes with the contact's force.
TEST(SlipOffAtTheRim, IsOneForElasticaAndBeamForContactAndProbe) {
  const LoadPath contact{by_rim(ContactLoad{6e-3, height, 0.4})};
  const MechanicsStep elastica = rod_result("elastica", contact).steps[0];
  const MechanicsStep beam = rod_result("beam", contact).steps[0];
  ASSERT_EQ(elastica.status, Status::slipped_off) << elastica.message;
  ASSERT_EQ(beam.status, Status::slipped_off) << beam.message;
  EXPECT_NEAR(*beam.slip_off_force / *elastica.slip_off_force, 1, 0.02);  // shear
  const double F = *elastica.slip_off_force;

  const LoadPath at{by_rim(ContactLoad{F * (1 - 1e-9), height, 0.4})};
  const MechanicsStep borne = rod_result("elastica", at).steps[0];
  ASSERT_EQ(borne.status, Status::converged) << borne.message;
  const CentrelinePoint tip = borne.deformation->centreline.at(L);
  EXPECT_NEAR(shortfall(tip.position.z(), tip.theta(), 1.5e-3, true) / 1e-6, 1, 0.02);

  const double displacement =
      borne.deformation->centreline.at(*borne.contact_arclength).position.head<2>().norm();
  for (const char* id : {"elastica", "beam"}) {
    const MechanicsStep probe =
        rod_result(id, {by_rim(ProbeLoad{1.2 * displacement, height, 0.4})}).steps[0];
    ASSERT_EQ(probe.status, Status::slipped_off) << probe.message;
    EXPECT_NEAR(*probe.slip_off_displacement / displacement, 1, id[0] == 'e' ? 1e-7 : 0.02);
    EXPECT_NEAR(*probe.slip_off_force / F, 1, id[0] == 'e' ? 1e-7 : 0.02);
  }
}

}  // namespace
}  // namespace ciliaval::test
