// SPDX-License-Identifier: LGPL-2.1-or-later
// The elastica under weight and a uniform field. Oracles: boundary-value solutions of
// θ″ = −λ sin(φ − θ) and of the heavy elastica (SciPy, 1e-12, two routes), Greenhill's number.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "analytic/elastica/elastica.h"
#include "analytic/elastica/environment/equilibrium.h"
#include "analytic/elastica/environment/step.h"
#include "problem/error.h"

namespace ciliaval::analytic::elastica {
namespace {

using std::numbers::pi;

/// EI/L² = 1 N and A M L²/EI = 1 per T.
Cilium unit_cilium() {
  const double d = 1e-2;
  Segment segment{"rod", 1, 64 / (pi * std::pow(d, 4)), 0.3, 4 / (pi * d * d)};
  segment.density = 4 / (pi * d * d);  // ρ A = 1 kg/m
  return {d, {segment}};
}

/// The tip under a field or a weight alone.
CentrelinePoint tip(const surroundings::Environment& environment, const Cilium& cilium) {
  Load load = EnvironmentLoad{};
  load.set_environment(environment);
  const MechanicsStep step = Elastica().solve(cilium, {load}).steps.at(0);
  EXPECT_EQ(step.status, Status::converged) << step.message;
  return step.deformation.value().centreline.at(cilium.length());
}

Vector3 in_plane(double length, double angle_from_axis) {
  return length * Vector3(std::sin(angle_from_axis), 0, std::cos(angle_from_axis));
}

TEST(ElasticaEnvironment, BendsInATransverseFieldLikeTheHardMagneticElastica) {
  const std::vector<std::array<double, 2>> table{
      {0.1, 0.0332953193}, {0.5, 0.1621435757}, {1, 0.3017207738},
      {2, 0.4934574804},   {3, 0.6032534411},   {5, 0.7137915236},
      {10, 0.8106090249},  {20, 0.8686958983},  {50, 0.9171554473}};
  for (const auto& [field, deflection] : table)
    EXPECT_NEAR(tip({.uniform_field = in_plane(field, pi / 2)}, unit_cilium()).position.x(),
                deflection, 1e-9)
        << field;
}

// A transverse field is a dead force on the tip (docs/theory/environment.md). Oracle: the elastica
// without an environment under that force, another method. One step from the straight cilium, at
// fields so strong that a step may go astray.
TEST(ElasticaEnvironment, IsThatOfAForceOnTheTipInFieldsOfAnyStrength) {
  for (const double field : {0.3, 7.0, 30.0, 52.9, 75.0, 100.0, 200.0, 350.0, 1000.0, 5000.0}) {
    const MechanicsStep pulled =
        Elastica().solve(unit_cilium(), {SectionLoad{field, 1, 0}}).steps.at(0);
    ASSERT_EQ(pulled.status, Status::converged) << pulled.message;
    const CentrelinePoint end = tip({.uniform_field = in_plane(field, pi / 2)}, unit_cilium());
    const CentrelinePoint exact = pulled.deformation->centreline.at(1);
    EXPECT_LT((end.position - exact.position).norm(), 1e-9) << field;
    EXPECT_NEAR(end.theta(), exact.theta(), 1e-8) << field;
  }
}

// Fields of any direction and strength, λ = 1 … 5000 (at which errors grow by e^70 along the rod).
// Oracle: the first integral, θ′²/2 + λ cos(φ − θ) is the same along the rod, and nothing but
// λ cos(φ − θ) at the tip, which lies between the axis and the field. Measured 4e-15 of λ.
TEST(ElasticaEnvironment, KeepsTheFirstIntegralInStrongFieldsOfAnyDirection) {
  std::mt19937 engine(20261127);
  std::uniform_real_distribution<double> part(0, 1);
  for (int k = 0; k < 40; ++k) {
    const double field = std::pow(5000, part(engine));
    const double angle = pi * (2 * part(engine) - 1);
    Load load = EnvironmentLoad{};
    load.set_environment({.uniform_field = in_plane(field, angle)});
    const MechanicsStep step = Elastica().solve(unit_cilium(), {load}).steps.at(0);
    ASSERT_EQ(step.status, Status::converged) << field << ' ' << angle << ' ' << step.message;
    EXPECT_EQ(step.unstable_modes, 0);
    const Centreline& c = step.deformation->centreline;
    const auto theta = [&](double S) { return std::copysign(c.at(S).theta(), angle); };
    EXPECT_LT(std::abs(theta(1)), std::abs(angle) * (1 + 1e-12));
    const double end = std::cos(angle - theta(1));
    for (const double S : {0.0, 0.003, 0.02, 0.1, 0.4, 0.9}) {
      const double kappa = c.at(S).curvature.norm();
      EXPECT_NEAR(kappa * kappa / 2 / field, end - std::cos(angle - theta(S)), 1e-12)
          << field << ' ' << angle << ' ' << S;
    }
  }
}

/// 0.1 mm thick and 17 mm long, of 0.1 MPa: λ = 350 in a field of 0.5 mT.
TEST(ElasticaEnvironment, BendsAFineSoftCiliumIntoAWeakField) {
  const Cilium cilium{1e-4, {{"rod", 17e-3, 1e5, 0.49, 150e3}}};
  for (const double field : {0.05e-3, 0.5e-3, 5e-3}) {
    const CentrelinePoint end = tip({.uniform_field = {field, 0, 0}}, cilium);
    EXPECT_NEAR(end.theta(), pi / 2, field < 1e-4 ? 0.02 : 1e-7);
  }
}

TEST(ElasticaEnvironment, SaysThatABendIsTooShortToBeResolved) {
  Load load = EnvironmentLoad{};
  load.set_environment({.uniform_field = in_plane(1e7, pi / 2)});
  const MechanicsStep step = Elastica().solve(unit_cilium(), {load}).steps.at(0);
  EXPECT_EQ(step.status, Status::failed);
  EXPECT_NE(step.message.find("check the units"), std::string::npos) << step.message;
}

TEST(ElasticaEnvironment, BendsInAnObliqueField) {
  struct Row {
    double angle, field, z, x;
  };
  for (const Row& row : {Row{30, 1, 0.99106941, 0.12217196}, Row{30, 5, 0.95058749, 0.28777799},
                         Row{30, 10, 0.92854372, 0.34778045}, Row{60, 1, 0.96828632, 0.22836367},
                         Row{60, 5, 0.81222998, 0.53582917}, Row{60, 10, 0.72950150, 0.63368353},
                         Row{150, 1, 0.96497823, 0.23808830}, Row{150, 5, 0.18979559, 0.82526208},
                         Row{150, 10, -0.14490789, 0.78255965}}) {
    const CentrelinePoint end =
        tip({.uniform_field = in_plane(row.field, row.angle * pi / 180)}, unit_cilium());
    EXPECT_NEAR(end.position.x(), row.x, 1e-8) << row.angle << ' ' << row.field;
    EXPECT_NEAR(end.position.z(), row.z, 1e-8) << row.angle << ' ' << row.field;
  }
}

TEST(ElasticaEnvironment, SagsUnderItsWeightLikeTheHeavyElastica) {
  struct Row {
    double weight, degrees, drop, reach;
  };
  for (const Row& row : {Row{1, 9.46042475, 0.1234714020, 0.9912463953},
                         Row{5, 39.93543205, 0.4959050446, 0.8466571800},
                         Row{10, 60.31200795, 0.7001997155, 0.6563537612},
                         Row{50, 87.45932314, 0.9079171235, 0.2450147563}}) {
    const CentrelinePoint end = tip({.gravity = {row.weight, 0, 0}}, unit_cilium());
    EXPECT_NEAR(end.theta() * 180 / pi, row.degrees, 1e-8);
    EXPECT_NEAR(end.position.x(), row.drop, 1e-9);
    EXPECT_NEAR(end.position.z(), row.reach, 1e-9);
  }
}

environment::Rod unit_rod(const surroundings::Environment& environment) {
  Load load = EnvironmentLoad{};
  load.set_environment(environment);
  return environment::rod_of(unit_cilium(), load);
}

TEST(ElasticaEnvironment, BucklesUnderGreenhillsWeightAndInAnOpposingField) {
  const auto weight = environment::critical_scale(unit_rod({.gravity = {0, 0, -1}}), 20);
  EXPECT_NEAR(weight.value(), 7.837347438943486, 1e-8);
  const auto field = environment::critical_scale(unit_rod({.uniform_field = {0, 0, -1}}), 5);
  EXPECT_NEAR(field.value(), pi * pi / 4, 1e-8);
  EXPECT_FALSE(environment::critical_scale(unit_rod({.gravity = {0, 0, 1}}), 20));
}

TEST(ElasticaEnvironment, SaysThatAnUprightCiliumBeyondGreenhillsWeightIsNotStable) {
  for (const double weight : {7.8, 7.9, 60.0}) {
    Load load = EnvironmentLoad{};
    load.set_environment({.gravity = {0, 0, -weight}});
    const MechanicsStep step = Elastica().solve(unit_cilium(), {load}).steps.at(0);
    ASSERT_EQ(step.status, Status::converged);
    EXPECT_EQ(step.message.empty(), weight < 7.837) << step.message;
    // The second critical weight is 55.98: its Bessel function's second zero.
    EXPECT_EQ(step.message.find("2 mode") != std::string::npos, weight > 56) << step.message;
    EXPECT_EQ(step.unstable_modes, weight > 56 ? 2 : weight > 7.837 ? 1 : 0);
  }
}

TEST(ElasticaEnvironment, LeansBeyondGreenhillsWeight) {
  struct Row {
    double weight, degrees, height, offset;
  };
  for (const Row& row : {Row{8, 24.29260999, 0.9460579480, 0.2982197877},
                         Row{10, 81.44000532, 0.4560232933, 0.7929679730},
                         Row{20, 144.85649812, -0.3341330135, 0.7049695634}}) {
    // To the side of a tilt that then goes away.
    const auto path = [&](double t) {
      const double tilt = 0.5 * (1 - t) * (1 - t);
      return std::pair(
          unit_rod({.gravity = row.weight * Vector3(std::sin(tilt), 0, -std::cos(tilt))}),
          environment::Conditions{.at = 1, .force = 0});
    };
    const auto tilted = environment::follow(
        [&](double t) { return std::pair(environment::scaled(path(0).first, t), path(0).second); },
        {}, 1e-12);
    const auto found = environment::follow(path, tilted.unknowns, 1e-12);
    EXPECT_EQ(found.unstable_modes, 0);
    EXPECT_NEAR(found.unknowns.tip_angle * 180 / pi, row.degrees, 1e-7);
    EXPECT_NEAR(found.height, row.height, 1e-9);
    EXPECT_NEAR(found.deflection, row.offset, 1e-9);
  }
}

/// Two materials, as the paper's cilium.
Cilium two_materials() {
  Segment base{"base", 3e-3, 0.1e6, 0.49, 0};
  base.density = 1000;
  Segment magnet{"magnet", 17e-3, 3e6, 0.49, 75e3};
  magnet.density = 1700;
  return {3e-3, {base, magnet}};
}

/// An environment that vanishes changes nothing: another solver, the same equations.
TEST(ElasticaEnvironment, IsThePlainElasticaWhereTheEnvironmentVanishes) {
  const Cilium cilium = two_materials();
  const surroundings::Environment tiny{.gravity = {0, 0, -1e-13}};
  for (const Load& load :
       std::vector<Load>{ContactLoad{1e-3, 16e-3, 0.3}, ContactLoad{5.8e-3, 16e-3, 0},
                         FlowLoad{0.3, 1}, SectionLoad{2e-3, 10e-3, 0}, SectionLoad{2e-3, 20e-3, 0},
                         DeadLoad{0.2, -2}, ProbeLoad{5e-3, 16e-3, 0.1}}) {
    const MechanicsStep plain = Elastica().solve(cilium, {load}).steps.at(0);
    const MechanicsStep with = Elastica().solve(cilium, {with_environment(load, tiny)}).steps.at(0);
    ASSERT_EQ(with.status, Status::converged) << with.message;
    const auto a = plain.deformation->centreline.at(20e-3);
    const auto b = with.deformation->centreline.at(20e-3);
    EXPECT_LT((a.position - b.position).norm(), 1e-9 * 20e-3) << type(load);
    EXPECT_NEAR(a.theta(), b.theta(), 1e-9);
    EXPECT_NEAR(plain.applied_force, with.applied_force, 1e-9 * plain.applied_force);
    if (plain.slip_off_force) {
      EXPECT_NEAR(*plain.slip_off_force, *with.slip_off_force, 1e-8 * *plain.slip_off_force);
    }
    if (plain.contact_arclength) {
      EXPECT_NEAR(*plain.contact_arclength, *with.contact_arclength, 1e-9 * 20e-3);
    }
    for (const double S : {1e-3, 3e-3, 9e-3, 19e-3}) {
      const auto p = plain.deformation->centreline.at(S).forces;
      const auto q = with.deformation->centreline.at(S).forces;
      EXPECT_LT((p.moment - q.moment).norm(), 1e-9 * 1e-4);
      EXPECT_LT((p.force - q.force).norm(), 1e-8 * 1e-2);
    }
  }
}

/// The forces and moments of all sections are in balance with weight, field and load.
TEST(ElasticaEnvironment, IsInBalance) {
  const Cilium cilium = two_materials();
  const surroundings::Environment all{
      .gravity = {3, 0, -9.81}, .fluid_density = 998, .uniform_field = {2e-3, 0, -1e-3}};
  for (const Load& load :
       std::vector<Load>{ContactLoad{1e-3, 16e-3, 0}, FlowLoad{0.3, 0}, SectionLoad{2e-3, 10e-3, 0},
                         DeadLoad{0.2, 0}, ProbeLoad{5e-3, 16e-3, 0}}) {
    const MechanicsStep step = Elastica().solve(cilium, {with_environment(load, all)}).steps.at(0);
    ASSERT_EQ(step.status, Status::converged) << step.message;
    const Centreline& c = step.deformation->centreline;
    Vector3 force = step.applied_force * Vector3::UnitX();
    for (const Segment& s : cilium.segments)
      force += s.length * cilium.area() * surroundings::weight_per_volume(all, s);
    EXPECT_LT((c.at(0, 0).forces.force - force).norm(), 1e-10) << type(load);
    // M′ = −r′ × n within a segment, by central differences.
    for (const double S : {2e-3, 5e-3, 18e-3}) {
      const double h = 1e-5;
      const Vector3 slope = (c.at(S + h).forces.moment - c.at(S - h).forces.moment) / (2 * h);
      const CentrelinePoint at = c.at(S);
      EXPECT_LT((slope + at.derivative.cross(at.forces.force)).norm(), 1e-8);
    }
    // The field's couple, as a jump of the force by M A B₀ at the magnet's lower end.
    const Vector3 jump =
        c.at(3e-3, c.piece_at(3e-3)).forces.force - c.at(3e-3, c.piece_at(3e-3) - 1).forces.force;
    EXPECT_LT((jump - 75e3 * cilium.area() * all.uniform_field).norm(), 1e-10);
  }
}

TEST(ElasticaEnvironment, RefusesWhatItCannotDo) {
  const Cilium cilium = two_materials();
  const auto solve = [&](const Load& load, const surroundings::Environment& environment) {
    return Elastica().solve(cilium, {with_environment(load, environment)});
  };
  EXPECT_THROW(solve(ContactLoad{1e-3, 16e-3, 0}, {.uniform_field = {0, 0.01, 0}}), InputError);
  EXPECT_NO_THROW(solve(ContactLoad{1e-3, 16e-3, pi / 2}, {.uniform_field = {0, 0.01, 0}}));
  EXPECT_THROW(Elastica({.form = ElasticaOptions::Form::height})
                   .solve(cilium, {with_environment(FlowLoad{0.1, 0}, {.gravity = {0, 0, -9.81}})}),
               InputError);
  Cilium unknown = cilium;
  unknown.segments[0].density = 0;
  EXPECT_THROW(
      Elastica().solve(unknown, {with_environment(FlowLoad{0.1, 0}, {.gravity = {0, 0, -9.81}})}),
      InputError);
  // A cilium that hangs down by its own weight has no contact at 16 mm.
  const MechanicsStep step =
      solve(ContactLoad{1e-3, 16e-3, 0}, {.gravity = {400, 0, 0}}).steps.at(0);
  EXPECT_EQ(step.status, Status::failed);
  EXPECT_NE(step.message.find("environment alone"), std::string::npos) << step.message;
}

}  // namespace
}  // namespace ciliaval::analytic::elastica
