// SPDX-License-Identifier: LGPL-2.1-or-later
// A model's values of a measurand, on shapes that are known.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "compare/validation/computed.h"
#include "tests/support/synthetic.h"

namespace ciliaval::compare::validation {
namespace {

using input::measurement::Measurand;
using Kind = Measurand::Kind;
using testing::HasSubstr;

using test::L;
constexpr double angle = 0.7;
constexpr double u_tip = 1e-6;
const Load load = ContactLoad{1e-3, 16e-3, 0};
const Vector3 e = Vector3::UnitX();

/// A straight rod that leans towards +x.
models::MechanicsRun leaning(std::optional<double> tip_angle_uncertainty = 1e-4) {
  models::MechanicsRun run;
  run.model = "leaning";
  run.result.undeformed.centreline = straight_centreline({0, L});
  run.result.steps = {test::converged(load, test::tilted(L, 3e-3, e, angle), u_tip)};
  run.result.steps[0].tip_angle_uncertainty = tip_angle_uncertainty;
  return run;
}

Measurand of(Kind kind, std::size_t axis = 0, std::array<double, 2> point = {}) {
  return {.name = "tip", .kind = kind, .axis = axis, .point = point};
}

TEST(ComputedTip, IsTheCentreOfTheEnd) {
  const models::MechanicsRun run = leaning();
  EXPECT_NEAR(computed(of(Kind::position, 0), run, 0, e).value.value(), L * std::sin(angle), 1e-15);
  EXPECT_NEAR(computed(of(Kind::position, 2), run, 0, e).value.value(), L * std::cos(angle), 1e-15);
  EXPECT_NEAR(computed(of(Kind::angle), run, 0, e).value.value(), angle, 1e-12);
  EXPECT_EQ(computed(of(Kind::position, 0), run, 0, e).numerical, u_tip);
  EXPECT_EQ(computed(of(Kind::angle), run, 0, e).numerical, 1e-4);
  // Along the azimuth of the load, whatever the axes.
  const Vector3 across(std::cos(0.3), std::sin(0.3), 0);
  EXPECT_NEAR(computed(of(Kind::deflection), run, 0, across).value.value(),
              L * std::sin(angle) * std::cos(0.3), 1e-15);
}

// By hand: d₁ = (cos θ, 0, −sin θ), d₂ = ŷ. The displacement of a point at X goes back by
// X (1 − cos θ): at 90° by all of X.
TEST(ComputedTip, MovesAPointOfTheEndWithTheSection) {
  const models::MechanicsRun run = leaning();
  constexpr double X = 1e-3;
  constexpr double Y = -0.5e-3;
  const auto value = [&](Kind kind, std::size_t axis = 0) {
    return computed(of(kind, axis, {X, Y}), run, 0, e).value.value();
  };
  EXPECT_NEAR(value(Kind::position, 0), L * std::sin(angle) + X * std::cos(angle), 1e-15);
  EXPECT_NEAR(value(Kind::position, 1), Y, 1e-15);
  EXPECT_NEAR(value(Kind::position, 2), L * std::cos(angle) - X * std::sin(angle), 1e-15);
  EXPECT_NEAR(value(Kind::deflection), L * std::sin(angle) - X * (1 - std::cos(angle)), 1e-15);
  EXPECT_NEAR(computed(of(Kind::deflection, 0, {X, Y}), run, 0, e).numerical.value(),
              u_tip + 1e-4 * std::hypot(X, Y), 1e-18);
}

TEST(ComputedTip, HasNoValueWhereTheModelHasNone) {
  models::MechanicsRun run = leaning();
  run.result.steps[0].status = Status::slipped_off;
  const Computed none = computed(of(Kind::position), run, 0, e);
  EXPECT_FALSE(none.value);
  EXPECT_EQ(none.note, "slipped_off");
  run = leaning();
  run.result.steps[0].tip_uncertainty.reset();
  EXPECT_TRUE(computed(of(Kind::position), run, 0, e).value);
  EXPECT_FALSE(computed(of(Kind::position), run, 0, e).numerical);
}

// Oracle: the formula of the deformation, x = X + (a Z², 0, −b X Z).
TEST(MaterialPoint, IsCarriedAlongByTheBody) {
  const SolidBody body = test::BentBricks::body();
  for (const Vector3& X : {Vector3(1e-3, -1e-3, 20e-3), Vector3(0.3e-3, 0.7e-3, 20e-3),
                           Vector3(-0.2e-3, 0, 7e-3), Vector3(1e-3, 1e-3, 10e-3)}) {
    const auto found = material_point(body, X);
    ASSERT_TRUE(found) << X.transpose();
    EXPECT_LT((*found - test::BentBricks::current(X)).norm(), 1e-15) << X.transpose();
  }
  EXPECT_FALSE(material_point(body, Vector3(1.1e-3, 0, 20e-3)));
  EXPECT_FALSE(material_point(body, Vector3(0, 0, 21e-3)));
  // A mesh's rounding of the surface.
  EXPECT_TRUE(material_point(body, Vector3(1.00001e-3, 0, 20e-3)));
}

TEST(ComputedTip, OfASolidIsTheMaterialPoint) {
  models::MechanicsRun run = leaning();
  run.result.steps[0].deformation->body = std::make_shared<SolidBody>(test::BentBricks::body());
  const Vector3 X(1e-3, 0.5e-3, L);
  const Vector3 x = test::BentBricks::current(X);
  for (std::size_t axis = 0; axis < 3; ++axis)
    EXPECT_NEAR(computed(of(Kind::position, axis, {X.x(), X.y()}), run, 0, e).value.value(),
                x[static_cast<Eigen::Index>(axis)], 1e-15);
  EXPECT_NEAR(computed(of(Kind::deflection, 0, {X.x(), X.y()}), run, 0, e).value.value(),
              x.x() - X.x(), 1e-15);
  const Computed outside = computed(of(Kind::position, 0, {1.4e-3, 0}), run, 0, e);
  EXPECT_FALSE(outside.value);
  EXPECT_THAT(outside.note, HasSubstr("in no cell"));
}

TEST(ComputedField, HasTheUncertaintiesOfFieldAndShape) {
  models::FieldRun field;
  field.mechanics = "leaning";
  field.field = "known";
  models::FieldStep step;
  step.B = {Vector3(1e-3, 2e-3, 3e-3)};
  step.dB = {Vector3(1e-5, 2e-5, 3e-5)};
  step.uncertainty = {Vector3(1e-9, 2e-9, 3e-9)};
  step.dB_uncertainty = {Vector3(2e-9, 4e-9, 6e-9)};
  step.from_mechanics = {std::nullopt};
  step.dB_from_mechanics = {std::nullopt};
  field.steps = {step};
  const models::MechanicsRun run = leaning();
  const Computed found = computed(of(Kind::dB, 1), field, run, 0);
  EXPECT_EQ(found.value, 2e-5);
  // Error of ΔB by the tip's, |ΔB| u/|tip displacement| (docs/guide/results.md).
  const double carried = step.dB[0]->norm() * u_tip / (2 * L * std::sin(angle / 2));
  EXPECT_NEAR(found.numerical.value(), 4e-9 + carried, 1e-6 * carried);
  field.steps = {std::nullopt};
  EXPECT_EQ(computed(of(Kind::B), field, run, 0).note, "there is no field");
}

}  // namespace
}  // namespace ciliaval::compare::validation
