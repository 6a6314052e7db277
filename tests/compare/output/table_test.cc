// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/output/table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "compare/output/text_table.h"
#include "problem/error.h"
#include "tests/support/synthetic.h"

namespace ciliaval::compare {
namespace {

using output::Footnotes;
using test::converged;
using test::field_entry;
using test::mechanics_entry;
using test::paper_case;
using test::tilted;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

using test::L;

models::MechanicsEntry tilt(const std::string& id, double factor) {
  return mechanics_entry(id, [=](const Load& load) {
    return converged(load, tilted(L, 3e-3, Vector3::UnitX(), factor * 100 * magnitude(load)), 1e-9);
  });
}

// Oracle: tilts of 0.1 and 0.2 rad by hand: tip x = 20 sin 0.1 = 1.9967 mm, angle 5.730 deg;
// distance over deflection 2 sin(0.05)/sin(0.2) = 50.31 %; dBx = 0.1 T/m · tip x = 199.67 uT, error
// against the reference sin 0.1/sin 0.2 − 1 = −49.7 %.
TEST(Table, ShowsValuesWithUnitsAndErrorsAgainstTheReference) {
  input::Case c = paper_case({1e-3});
  c.mechanics = {"rough", "fine"};
  c.fields = {"sure", "tip"};
  const std::vector<models::MechanicsEntry> mechanics{tilt("rough", 1), tilt("fine", 2)};
  const auto formula = [](const Deformation& d, const Vector3&) -> Vector3 {
    return {0.1 * d.centreline.at(L).position.x(), 0, 5e-3};
  };
  const std::vector<models::FieldEntry> fields{
      field_entry("sure", formula, Vector3(1e-6, 2e-6, 3e-6)), field_entry("tip", formula)};
  const models::CaseResult result = models::run(c, mechanics, fields);
  const std::string text = output::table(result, models::compare_models(result), Footnotes::text);
  EXPECT_THAT(text, HasSubstr("contact, force 1 mN at height 16 mm, azimuth 0 deg"));
  EXPECT_THAT(text, ContainsRegex("rough +converged +1.9967 +0.0000 +19.9001 +>0.001 +5.730 +1 "));
  EXPECT_THAT(text, ContainsRegex("rough - fine +50.31 +29.05 +50.31 +-50.00 .*resolved"));
  EXPECT_THAT(text, ContainsRegex("rough/tip +0.1997 +0.0000 +5.0000 +199.67 +0.00 +0.00 "
                                  "+\\? +-49.75\n"));
  EXPECT_THAT(text, ContainsRegex("fine/tip .*ref."));
  // The bent and the straight cilium add 3 uT each; the tip's 1e-9 m add but 1e-4 uT.
  EXPECT_THAT(text, ContainsRegex("rough/sure +0.1997 +0.0000 +5.0000 +199.7 +0.0 +0.0 +>6 "));
  EXPECT_THAT(text, HasSubstr("divided by the largest |dB|"));
  EXPECT_THAT(text, Not(HasSubstr("nan")));
}

// The same tilts: sin 0.1/sin 0.2 = 0.5025.
TEST(Table, BeginsWithWhatTheNumbersMean) {
  input::Case c = paper_case({1e-3});
  c.mechanics = {"rough", "fine"};
  c.fields = {"tip"};
  const std::vector<models::MechanicsEntry> mechanics{tilt("rough", 1), tilt("fine", 2)};
  const std::vector<models::FieldEntry> fields{
      field_entry("tip", [](const Deformation& d, const Vector3&) -> Vector3 {
        return {0.1 * d.centreline.at(L).position.x(), 0, 5e-3};
      })};
  const models::CaseResult result = models::run(c, mechanics, fields);
  const std::string text = output::table(result, models::compare_models(result), Footnotes::text);
  EXPECT_THAT(text, HasSubstr("At step 1 of 1:\n  rough bends 50 % less far than fine: resolved\n"
                              "  |dB| at sensor 0 by fine/tip: 397.3 uT\n"
                              "  rough/tip sees 50 % less: "));
}

TEST(Table, FoldsColumnsThatDoNotFitTheLine) {
  const output::TextRows rows{{"model", "first", "second", "third"}, {"a", "1", "2", "3"}};
  EXPECT_EQ(output::text_table(rows, "<>"),
            "  model  first  second  third\n  a          1       2      3\n");
  output::set_line_width(22);
  EXPECT_EQ(output::text_table(rows, "<>"),
            "  model  first  second\n  a          1       2\n  model  third\n  a          3\n");
  output::set_line_width(1);  // no column fits beside the first: one by one
  EXPECT_EQ(output::text_table(rows, "<>"),
            "  model  first\n  a          1\n  model  second\n  a           2\n"
            "  model  third\n  a          3\n");
  output::set_line_width(0);
}

TEST(Table, SaysWhyAModelHasNoResult) {
  input::Case c = paper_case({1e-3});
  c.mechanics = {"slips"};
  const std::vector<models::MechanicsEntry> mechanics{
      mechanics_entry("slips", [](const Load& load) {
        MechanicsStep step;
        step.load = load;
        step.status = Status::slipped_off;
        step.slip_off_force = 5.862e-3;
        return step;
      })};
  const models::CaseResult result = models::run(c, mechanics, {});
  const std::string text = output::table(result, models::compare_models(result), Footnotes::text);
  EXPECT_THAT(text, HasSubstr("slips off above 5.862 mN"));
}

TEST(Table, ShowsTheForceThatAProbesDisplacementTakes) {
  input::Case c = paper_case({});
  c.load_path = {ProbeLoad{2e-3, 16e-3, 0}, ProbeLoad{12e-3, 16e-3, 0}};
  c.mechanics = {"rod"};
  const std::vector<models::MechanicsEntry> mechanics{mechanics_entry("rod", [](const Load& load) {
    MechanicsStep step = test::converged(load, test::tilted(L, 3e-3, Vector3::UnitX(), 0.1));
    step.applied_force = 1.2345e-3;
    if (magnitude(load) < 10e-3) return step;
    step.deformation.reset();
    step.status = Status::slipped_off;
    step.slip_off_force = 5.862e-3;
    step.slip_off_displacement = 11.66e-3;
    return step;
  })};
  const models::CaseResult result = models::run(c, mechanics, {});
  const auto comparisons = models::compare_models(result);
  const std::string text = output::table(result, comparisons, Footnotes::text, output::Steps::all);
  EXPECT_THAT(text, HasSubstr("probe, displacement 2 mm at height 16 mm, azimuth 0 deg"));
  EXPECT_THAT(text, ContainsRegex("rod +converged .* 1.2345 "));
  EXPECT_THAT(text, HasSubstr("slips off beyond 11.66 mm"));
  const std::string last = output::table(result, comparisons, Footnotes::text);
  EXPECT_THAT(last, HasSubstr("displacement 2 mm"));
  EXPECT_THAT(last, HasSubstr("Step 2 of 2:\n  rod slipped_off\n"));
  EXPECT_THAT(last, HasSubstr("The other steps: --all"));
  EXPECT_THAT(text, HasSubstr("slips off above 5.862 mN"));
}

// The last pair gives nothing at any step: the others are set against the last that does, at each
// step and over the path. Oracle: 1 − 1/2 of each component.
TEST(Table, TakesTheLastPairWithAFieldForTheReferenceOfThePathToo) {
  input::Case c = paper_case({1e-3});
  c.sensors = {Vector3(0, 0, 0), Vector3(0, 0, 1)};
  c.mechanics = {"rough"};
  c.fields = {"half", "full", "broken"};
  const std::vector<models::MechanicsEntry> mechanics{tilt("rough", 1)};
  const auto times = [](double factor) {
    return [=](const Deformation& d, const Vector3&) -> Vector3 {
      return factor * d.centreline.at(L).position;
    };
  };
  const std::vector<models::FieldEntry> fields{
      field_entry("half", times(0.5)), field_entry("full", times(1)),
      field_entry("broken", [](const Deformation&, const Vector3&) -> Vector3 {
        throw SolverError("no convergence");
      })};
  const models::CaseResult result = models::run(c, mechanics, fields);
  const std::string text = output::table(result, models::compare_models(result), Footnotes::text);
  EXPECT_THAT(text, HasSubstr("RRMSE (3) against rough/full"));
  EXPECT_THAT(text, ContainsRegex("rough/half +50.00 +- +50.00 +50.00 +- +50.00"));
  EXPECT_THAT(text, HasSubstr("rough/broken: no convergence"));
  EXPECT_THAT(text, HasSubstr("sensor 0 "));
  models::CaseResult named = result;
  named.problem.sensor_names = {"left", "right"};
  const std::string by_name = output::table(named, models::compare_models(named), Footnotes::text);
  for (const std::string name : {"left", "right"}) {
    EXPECT_THAT(by_name, HasSubstr("sensor " + name + " "));
    EXPECT_THAT(by_name, HasSubstr("|dB| at sensor " + name + " by rough/full"));
    EXPECT_THAT(by_name, HasSubstr("at sensor " + name + ": RRMSE (3)"));
  }
  EXPECT_THAT(by_name, Not(HasSubstr("sensor 0")));
}

// Oracle: B at the sensors (0, 0, 0) and (3, 0, 0) differs by 3 T in x, ΔB does not.
TEST(Table, ShowsEachSensorAndOfVeryManyTheFirst) {
  input::Case c = paper_case({1e-3});
  c.sensors = {Vector3(0, 0, 0), Vector3(3, 0, 0)};
  c.mechanics = {"rough"};
  c.fields = {"tip"};
  const std::vector<models::MechanicsEntry> mechanics{tilt("rough", 1)};
  const std::vector<models::FieldEntry> fields{
      field_entry("tip", [](const Deformation& d, const Vector3& x) -> Vector3 {
        return {1e-2 * d.centreline.at(L).position.x() + 1e-3 * x.x(), 0, 0};
      })};
  const auto text = [&] {
    const models::CaseResult result = models::run(c, mechanics, fields);
    return output::table(result, models::compare_models(result), Footnotes::reference);
  };
  EXPECT_THAT(text(), ContainsRegex("sensor 0 .*\n +rough/tip +0.0200 .* +19.97 "));
  EXPECT_THAT(text(), ContainsRegex("sensor 1 .*\n +rough/tip +3.0200 .* +19.97 "));
  EXPECT_THAT(text(), Not(HasSubstr("other")));
  EXPECT_THAT(text(), HasSubstr("--explain"));
  EXPECT_THAT(text(), Not(HasSubstr("divided by")));
  c.sensors.resize(20, Vector3(0, 0, 0));
  EXPECT_THAT(text(), HasSubstr("sensor 15 "));
  EXPECT_THAT(text(), Not(HasSubstr("sensor 16 ")));
  EXPECT_THAT(text(), HasSubstr("The other 4 sensors are in fields.csv"));
}

// Oracle: tilts of 0.1 rad, as above.
TEST(Table, TellsAStepInALine) {
  MechanicsStep step =
      converged(ContactLoad{1e-3, 16e-3, 0}, tilted(L, 3e-3, Vector3::UnitX(), 0.1), 1e-9);
  step.seconds = 12.3;
  EXPECT_EQ(output::describe(step),
            "contact, force 1 mN at height 16 mm, azimuth 0 deg: tip at (1.9967, 0.0000, 19.9001) "
            "mm, 5.730 deg, 12.3 s");
  step.deformation.reset();
  step.status = Status::slipped_off;
  EXPECT_THAT(output::describe(step), testing::EndsWith(": slipped_off, 12.3 s"));
}

TEST(Table, TellsTheFieldAroundALoad) {
  Load load = ContactLoad{1e-3, 16e-3, 0};
  surroundings::Environment around;
  around.gravity = {0, 0, -9.81};
  load.set_environment(around);
  EXPECT_THAT(output::describe(load), testing::EndsWith("azimuth 0 deg"));
  around.uniform_field = {5e-3, 0, -1e-4};
  load.set_environment(around);
  EXPECT_THAT(output::describe(load), testing::EndsWith("azimuth 0 deg, field (5, 0, -0.1) mT"));
  around.magnets.emplace_back();
  around.magnets.back().name = "ball";
  around.magnets.back().position = {0.02, 0, -5e-3};
  load.set_environment(around);
  EXPECT_THAT(output::describe(load),
              testing::EndsWith("field (5, 0, -0.1) mT, ball at (20, 0, -5) mm"));
}

// At sensor 0 the field of the straight cilium diverges: B stands, ΔB is a dash.
TEST(Table, ShowsBWhereOnlyItsChangeIsUndefined) {
  input::Case c = paper_case({1e-3});
  c.mechanics = {"rough"};
  c.fields = {"tip"};
  const std::vector<models::MechanicsEntry> mechanics{tilt("rough", 1)};
  const std::vector<models::FieldEntry> fields{
      field_entry("tip", [](const Deformation& d, const Vector3&) -> Vector3 {
        const double x = d.centreline.at(L).position.x();
        if (x == 0) throw InputError("B diverges");
        return {0.1 * x, -1e-12, 0};
      })};
  const models::CaseResult result = models::run(c, mechanics, fields);
  const std::string text = output::table(result, models::compare_models(result), Footnotes::text);
  EXPECT_THAT(text, ContainsRegex("rough/tip +0.1997 +0.0000 +0.0000 +- +- +- "));
  EXPECT_THAT(text, Not(HasSubstr("-0.0000")));
  EXPECT_THAT(text, HasSubstr("rough/tip: undeformed cilium: B diverges"));
}

}  // namespace
}  // namespace ciliaval::compare
