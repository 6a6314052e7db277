// SPDX-License-Identifier: LGPL-2.1-or-later
// Remarks of `ciliaval validate` on a case beyond its syntax.
#include "compare/models/preview.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "compare/models/registry.h"
#include "tests/support/synthetic.h"

namespace ciliaval::compare::models {
namespace {

using test::paper_case;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

std::vector<std::string> warnings(const input::Case& problem) {
  return preview(problem).warnings;
}

TEST(Preview, HasNothingToWarnOfInThePapersCase) {
  const Preview seen = preview(paper_case({0.5e-3}));
  EXPECT_THAT(seen.warnings, IsEmpty());
  EXPECT_THAT(seen.signal, Contains(HasSubstr("elastica: the tip goes")));
  EXPECT_THAT(seen.signal, Contains(HasSubstr("sensor 0: |B|")));
}

TEST(Preview, WarnsOfASensorInTheCilium) {
  input::Case problem = paper_case({0.5e-3});
  problem.sensors = {{0, 1e-3, 2e-3}};  // in the base
  EXPECT_THAT(warnings(problem), Contains(HasSubstr("sensor 0 lies inside the straight cilium")));
  problem.sensors = {{0, 1e-3, 5e-3}};
  EXPECT_THAT(warnings(problem), Contains(HasSubstr("sensor 0 lies inside the straight magnet")));
  EXPECT_THAT(warnings(problem), Not(Contains(HasSubstr("inside the straight cilium"))));
}

TEST(Preview, WarnsOfTwoCriteriaNearTheEndOfTheRange) {
  input::Case problem = paper_case({5.7e-3});
  const auto warns = Contains(HasSubstr("slip_off = \"rim\" in [load] has both judge by the rim"));
  EXPECT_THAT(warnings(problem), Not(warns));
  problem.mechanics = {"elastica", "solid"};
  EXPECT_THAT(warnings(problem), warns);
  problem.load_path.front().set_slip_off_point(SlipOffPoint::rim);
  EXPECT_THAT(warnings(problem), Not(warns));
  problem.load_path = {ContactLoad{1e-3, 16e-3, 0}};
  EXPECT_THAT(warnings(problem), Not(warns));
}

// Oracle (apart from this project): by the change of B 3 mN without friction are read as 3.54 mN of
// a horizontal force, with a friction of 0.6 as 2.80 mN; the displacement says 3.55 mN.
TEST(Preview, SaysWhatFrictionWouldDo) {
  const auto says = Contains(HasSubstr("the force is horizontal; of a probe that slides"));
  EXPECT_THAT(preview(paper_case({3e-3})).signal,
              Contains(HasSubstr("-16 % without friction and +7 % with a friction of 0.6")));
  EXPECT_THAT(preview(paper_case({4e-3})).signal,
              Contains(HasSubstr("more than it bears without friction")));
  EXPECT_THAT(preview(paper_case({0.05e-3})).signal, Not(says));
  input::Case stated = paper_case({3e-3});
  stated.load_path.front().set_touch({TouchLaw::Law::coulomb, 0.3});
  EXPECT_THAT(preview(stated).signal, Not(says));
}

TEST(Preview, TakesTheBeamBesideMagnets) {
  input::Case problem = paper_case({0.5e-3});
  surroundings::Environment around;
  around.magnets.push_back({"ball",
                            surroundings::magnets::Shape::ball,
                            {0.05, 0, 0.02},
                            Quaternion::Identity(),
                            4e-3,
                            0,
                            Vector3::Zero(),
                            {0, 0, 5e5}});
  problem.load_path.front().set_environment(around);
  const Preview seen = preview(problem);
  EXPECT_THAT(seen.warnings, IsEmpty());
  EXPECT_THAT(seen.signal, Contains(HasSubstr("beam: the tip goes")));
}

// Oracle: Greenhill, w L³/EI = 7.837347438943486, and π²/4 of M A B L²/EI.
TEST(Preview, TellsHowFarItIsToBuckling) {
  input::Case problem = paper_case({1e-5});
  Cilium& cilium = problem.cilium;
  cilium.segments = {{"rod", 20e-3, 1e6, 0.49, 75e3, 1500}};
  const double EI = 1e6 * cilium.second_moment();
  const double L = cilium.length();
  const auto surrounded = [&](const surroundings::Environment& around) {
    problem.load_path.front().set_environment(around);
    return preview(problem);
  };
  const double g = 7.837347438943486 * EI / (1500 * cilium.area() * std::pow(L, 3));
  EXPECT_THAT(surrounded({.gravity = {0, 0, -g / 4}}).signal,
              Contains(HasSubstr("buckle the straight cilium at 4 times")));
  const double B = std::pow(std::numbers::pi, 2) / 4 * EI / (75e3 * cilium.area() * L * L);
  EXPECT_THAT(surrounded({.uniform_field = {0, 0, -B / 2.5}}).signal,
              Contains(HasSubstr("buckle the straight cilium at 2.5 times")));
  EXPECT_THAT(surrounded({.uniform_field = {0, 0, -1.25 * B}}).warnings,
              Contains(HasSubstr("at 0.8 times what they are: state an imperfection")));
  EXPECT_THAT(surrounded({.uniform_field = {1e-6, 0, -1.25 * B}}).warnings,
              Contains(HasSubstr("their part across the axis chooses the side")));
  // A stub is one by what bends, a tube not by its wall.
  cilium.section = {.shape = CrossSection::Shape::tube, .inner_diameter = 2.9e-3};
  cilium.segments[0].length = 8e-3;
  EXPECT_THAT(surrounded({}).warnings, Contains(HasSubstr("only 2.7 diameters long")));
  EXPECT_THAT(surrounded({.gravity = {0, 0, g}}).signal,
              testing::Not(Contains(HasSubstr("buckle"))));
}

TEST(Preview, WarnsOfSlipsInUnits) {
  input::Case problem = paper_case({0.5e-3});
  problem.cilium.segments[1].young_modulus = 0.2e9;
  EXPECT_THAT(warnings(problem), Contains(HasSubstr("Young's modulus of 2e+08 Pa")));
  problem = paper_case({0.5e-3});
  problem.cilium.segments[1].magnetization = 75;
  EXPECT_THAT(warnings(problem), Contains(HasSubstr("magnetization of 75 A/m")));
  problem = paper_case({0.5e-3});
  problem.cilium.segments[1].length = 2;
  EXPECT_THAT(warnings(problem), Contains(HasSubstr("length of 2 m")));
}

TEST(Preview, WarnsOfAStubOfSensorsInTheMagnetAndOfUnseenSignals) {
  input::Case problem = paper_case({0.5e-3});
  problem.cilium.diameter = 8e-3;
  EXPECT_THAT(warnings(problem), Contains(HasSubstr("diameters long")));
  problem = paper_case({0.5e-3});
  problem.sensors = {{0, 0, 10e-3}, {1.6e-3, 0, 10e-3}, {0, 0, -0.5}};
  const auto all = warnings(problem);
  EXPECT_THAT(all, Contains(HasSubstr("sensor 0 lies inside")));
  EXPECT_THAT(all, Contains(HasSubstr("sensor 1 is 0.1 mm from the magnet")));
  EXPECT_THAT(all, Contains(HasSubstr("sensor 2 sees a change")));
}

TEST(Preview, WarnsOfPlainRodsWhereBondedEndsAreMuchStiffer) {
  input::Case problem = paper_case({0.5e-3});
  problem.mechanics = {"elastica", "beam"};
  EXPECT_THAT(warnings(problem), Contains(HasSubstr("joints = \"corrected\" in [models.elastica], "
                                                    "[models.beam]")));
  for (const MechanicsEntry& entry : mechanics_models())
    if (entry.correct) entry.correct(problem.options);
  EXPECT_THAT(warnings(problem), IsEmpty());
  // A base of eight diameters is bent as a rod.
  problem.options = {};
  problem.cilium.segments.front().length = 24e-3;
  problem.load_path = {ContactLoad{0.02e-3, 30e-3, 0}};
  EXPECT_THAT(warnings(problem), Not(Contains(HasSubstr("corrected"))));
}

TEST(Preview, WarnsOfALoadThatNoEquilibriumBearsAndOfLargeStrains) {
  const auto all = warnings(paper_case({5.5e-3, 1}));
  EXPECT_THAT(all, Contains(HasSubstr("slips off")));
  EXPECT_THAT(all, Contains(HasSubstr("strained by")));
}

}  // namespace
}  // namespace ciliaval::compare::models
