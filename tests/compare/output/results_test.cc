// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/output/results.h"
#include "compare/output/output_file.h"
#include "compare/output/table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

#include "analytic/forces/wrench.h"
#include "problem/error.h"
#include "tests/support/synthetic.h"

namespace ciliaval::compare {
namespace {

using nlohmann::json;
using test::arc;
using test::converged;
using test::field_entry;
using test::mechanics_entry;
using test::paper_case;
using test::read_text;
using test::TemporaryFolder;

using test::L;
const output::Provenance origin{
    "1.2.3", "abc", {{"VTK", "9.1.0"}}, "ciliaval run x.toml", "2025-01-02T03:04:05Z"};

/// Two models; the second slips off at the second step, and its field fails at the first.
models::CaseResult two_models() {
  input::Case c = paper_case({1e-3, 2e-3});
  c.mechanics = {"one", "two"};
  c.fields = {"tip"};
  const std::vector<models::MechanicsEntry> mechanics{
      mechanics_entry("one",
                      [](const Load& load) {
                        return converged(load,
                                         arc(L, 3e-3, Vector3::UnitX(), 1e4 * magnitude(load)),
                                         1.0 / 3 * 1e-6);
                      }),
      mechanics_entry("two", [](const Load& load) {
        if (magnitude(load) < 1.5e-3)
          return converged(load, arc(L, 3e-3, Vector3::UnitX(), 1.1e4 * magnitude(load)));
        MechanicsStep step;
        step.load = load;
        step.status = Status::slipped_off;
        step.message = "slipped, \"off\"";
        step.slip_off_force = 1.4e-3;
        return step;
      })};
  const std::vector<models::FieldEntry> fields{
      field_entry("tip", [](const Deformation& d, const Vector3&) -> Vector3 {
        return d.centreline.at(d.centreline.length()).position / 3;
      })};
  return models::run(c, mechanics, fields);
}

std::vector<std::string> keys(const json& object) {
  std::vector<std::string> result;
  for (const auto& [key, value] : object.items()) result.push_back(key);
  return result;
}

// Oracle: the contract of the summary, key by key.
TEST(Summary, HasTheKeysOfTheContract) {
  const models::CaseResult result = two_models();
  const json summary =
      json::parse(output::summary_json(result, models::compare_models(result), origin));
  EXPECT_EQ(summary["schema"], 1);
  EXPECT_EQ(summary["case"], "paper");
  EXPECT_THAT(keys(summary["provenance"]),
              testing::UnorderedElementsAre("version", "git", "libraries", "command", "date"));
  ASSERT_EQ(summary["steps"].size(), 2u);
  const json& step = summary["steps"][0];
  EXPECT_THAT(keys(step), testing::IsSupersetOf({"load", "mechanics", "fields"}));
  EXPECT_EQ(step["load"],
            json({{"type", "contact"}, {"force", 1e-3}, {"height", 16e-3}, {"azimuth", 0.0}}));
  EXPECT_THAT(keys(step["mechanics"]["one"]),
              testing::IsSupersetOf({"status", "message", "tip", "tip_angle", "tip_uncertainty",
                                     "applied_force", "slip_off_force", "contact_arclength",
                                     "unknowns", "centreline", "seconds", "iterations"}));
  EXPECT_THAT(keys(step["fields"]["one/tip"]),
              testing::IsSupersetOf({"B", "dB", "uncertainty", "seconds"}));
  ASSERT_FALSE(summary["comparisons"].empty());
  for (const json& comparison : summary["comparisons"])
    EXPECT_THAT(
        keys(comparison),
        testing::IsSupersetOf({"step", "sensor", "quantity", "component", "model", "reference",
                               "difference", "relative", "unit", "uncertainty", "verdict"}));
}

// Oracle: the contract; the environment stands beside the load only where there is one.
TEST(Summary, StatesTheEnvironmentBesideTheLoad) {
  models::CaseResult result = two_models();
  surroundings::Environment around;
  around.gravity = {0, 0, -9.81};
  around.fluid_density = 1.2;
  around.uniform_field = {1e-3, 0, 2e-3};
  around.magnetic_energy = surroundings::MagneticEnergy::R;
  result.problem.load_path[1].set_environment(around);
  const json summary = json::parse(output::summary_json(result, {}, origin));
  EXPECT_FALSE(summary["steps"][0].contains("environment"));
  EXPECT_EQ(summary["steps"][1]["environment"], json({{"gravity", {0.0, 0.0, -9.81}},
                                                      {"fluid_density", 1.2},
                                                      {"uniform_field", {1e-3, 0.0, 2e-3}},
                                                      {"magnetic_energy", "R"}}));
}

// Oracle: the field of a dipole of the magnet's moment, far away, and the uniform field.
TEST(Summary, StatesWhatTheChipReadsWhereTheEnvironmentChanges) {
  models::CaseResult result = two_models();
  EXPECT_FALSE(
      json::parse(output::summary_json(result, {}, origin))["steps"][0].contains("B_external"));
  surroundings::Environment around;
  around.uniform_field = {0, 40e-6, 0};
  surroundings::magnets::Magnet ball;
  ball.name = "ball";
  ball.shape = surroundings::magnets::Shape::ball;
  ball.diameter = 5e-3;
  ball.magnetization = {0, 0, 1e6};
  for (std::size_t i = 0; i < 2; ++i) {
    ball.position = {0, 0, (i == 0 ? -60e-3 : -30e-3)};
    around.magnets = {ball};
    result.problem.load_path[i].set_environment(around);
  }
  const json summary = json::parse(output::summary_json(result, {}, origin));
  for (std::size_t i = 0; i < 2; ++i) {
    const json& B = summary["steps"][i]["B_external"][0];
    const Vector3 sensor = result.problem.sensors[0];
    const Vector3 r = sensor - result.problem.load_path[i].environment().magnets[0].position;
    const Vector3 m(0, 0, 1e6 * std::numbers::pi / 6 * 125e-9);
    const Vector3 dipole =
        1e-7 * (3 * r * r.dot(m) / std::pow(r.norm(), 5) - m / std::pow(r.norm(), 3));
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(B[c].get<double>(), dipole[c] + around.uniform_field[c], 1e-12);
    const json& field = summary["steps"][i]["fields"]["one/tip"];
    if (field["dB"][0].is_null()) continue;
    EXPECT_NEAR(field["reading"][0][2].get<double>(),
                field["dB"][0][2].get<double>() + B[2].get<double>(), 1e-15);
  }
}

TEST(Summary, StatesTheStabilityWhereAModelKnowsIt) {
  models::CaseResult result = two_models();
  result.mechanics[0].result.steps[1].unstable_modes = 2;
  result.mechanics[0].result.steps[1].smallest_eigenvalue = -0.25;
  const json summary = json::parse(output::summary_json(result, {}, origin));
  const json& known = summary["steps"][1]["mechanics"]["one"];
  EXPECT_EQ(known["unstable_modes"], 2);
  EXPECT_EQ(known["smallest_eigenvalue"], -0.25);
  const json& unknown = summary["steps"][0]["mechanics"]["one"];
  EXPECT_FALSE(unknown.contains("unstable_modes"));
  EXPECT_FALSE(unknown.contains("smallest_eigenvalue"));
}

// Oracle: the field of the cilium's end sections on the charges of the magnet; the program states
// the reaction to the force on the cilium.
TEST(Summary, StatesForceAndTorqueOnEachMagnet) {
  input::Case c = paper_case({});
  surroundings::Environment around;
  around.magnets.push_back({"ball",
                            surroundings::magnets::Shape::ball,
                            {0.01, 0, 0.025},
                            Quaternion::Identity(),
                            4e-3,
                            0,
                            Vector3::Zero(),
                            {1e5, 0, 5e5}});
  around.magnets.push_back({"brick",
                            surroundings::magnets::Shape::cuboid,
                            {0, 0.01, 0.01},
                            Quaternion(0.8, 0, 0.6, 0),
                            0,
                            0,
                            {3e-3, 4e-3, 5e-3},
                            {0, 0, 5e5}});
  c.load_path = {with_environment(ContactLoad{1e-3, 16e-3, 0}, around)};
  c.mechanics = {"rod"};
  const Centreline line = arc(L, 3e-3, Vector3::UnitX(), 20);
  const std::vector<models::MechanicsEntry> mechanics{
      mechanics_entry("rod", [&](const Load& load) { return converged(load, line); })};
  const models::CaseResult result = models::run(c, mechanics, {});
  const json step = json::parse(output::summary_json(result, {}, origin))["steps"][0];
  const json& brick = step["environment"]["magnets"][1];
  EXPECT_EQ(brick, json({{"name", "brick"},
                         {"shape", "cuboid"},
                         {"position", {0.0, 0.01, 0.01}},
                         {"rotation", {0.8, 0.0, 0.6, 0.0}},
                         {"edges", {3e-3, 4e-3, 5e-3}},
                         {"magnetization", {0.0, 0.0, 5e5}}}));
  EXPECT_EQ(step["environment"]["magnets"][0]["diameter"], 4e-3);
  for (std::size_t i = 0; i < 2; ++i) {
    const json& stated = step["forces_on_magnets"]["rod"][i];
    EXPECT_EQ(stated["name"], around.magnets[i].name);
    const auto exact =
        analytic::forces::wrench_on_magnet(c.cilium, Deformation{line, nullptr}, around.magnets[i]);
    for (Eigen::Index k = 0; k < 3; ++k) {
      const auto component = static_cast<std::size_t>(k);
      EXPECT_NEAR(stated["force"][component], exact.force[k], 1e-9 * exact.force.norm());
      EXPECT_NEAR(stated["torque"][component], exact.torque[k], 1e-9 * exact.torque.norm());
    }
  }
  const std::string table = output::table(result, {}, output::Footnotes::text);
  EXPECT_THAT(table, testing::HasSubstr("Force of the cilium on each magnet"));
  EXPECT_THAT(table, testing::HasSubstr("brick"));
}

TEST(Summary, StatesAProbesDisplacementForceAndSlipOff) {
  input::Case c = paper_case({});
  c.load_path = {ProbeLoad{1e-3, 16e-3, 0.5}, ProbeLoad{20e-3, 16e-3, 0.5}};
  c.mechanics = {"rod"};
  const std::vector<models::MechanicsEntry> mechanics{mechanics_entry("rod", [](const Load& load) {
    MechanicsStep step = converged(load, arc(L, 3e-3, Vector3::UnitX(), 20));
    step.applied_force = 7e-4;
    if (magnitude(load) < 11e-3) return step;
    step.deformation.reset();
    step.status = Status::slipped_off;
    step.slip_off_force = 5.9e-3;
    step.slip_off_displacement = 11.7e-3;
    return step;
  })};
  const models::CaseResult result = models::run(c, mechanics, {});
  const json steps = json::parse(output::summary_json(result, {}, origin))["steps"];
  EXPECT_EQ(steps[0]["load"],
            json({{"type", "probe"}, {"displacement", 1e-3}, {"height", 16e-3}, {"azimuth", 0.5}}));
  EXPECT_EQ(steps[0]["mechanics"]["rod"]["applied_force"], 7e-4);
  EXPECT_TRUE(steps[0]["mechanics"]["rod"]["slip_off_displacement"].is_null());
  EXPECT_EQ(steps[1]["mechanics"]["rod"]["slip_off_displacement"], 11.7e-3);
  EXPECT_EQ(steps[1]["mechanics"]["rod"]["slip_off_force"], 5.9e-3);
}

TEST(Summary, GivesEveryDoubleBackToTheLastBit) {
  const models::CaseResult result = two_models();
  const json summary =
      json::parse(output::summary_json(result, models::compare_models(result), origin));
  const json& step = summary["steps"][1];
  const Centreline& c = result.mechanics[0].result.steps[1].deformation->centreline;
  const CentrelinePoint tip = c.at(L);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    EXPECT_EQ(step["mechanics"]["one"]["tip"][i].get<double>(), tip.position[k]);
    EXPECT_EQ(step["fields"]["one/tip"]["B"][0][i].get<double>(), tip.position[k] / 3);
    EXPECT_EQ(step["fields"]["one/tip"]["dB"][0][i].get<double>(),
              result.fields[0].steps[1]->dB[0].value()[k]);
  }
  EXPECT_EQ(step["mechanics"]["one"]["tip_angle"].get<double>(), tip.theta());
  EXPECT_EQ(step["mechanics"]["one"]["tip_uncertainty"].get<double>(), 1.0 / 3 * 1e-6);
}

TEST(Summary, WritesWhatIsUndefinedAsNull) {
  models::CaseResult result = two_models();
  const json summary =
      json::parse(output::summary_json(result, models::compare_models(result), origin));
  const json& slipped = summary["steps"][1]["mechanics"]["two"];
  EXPECT_EQ(slipped["status"], "slipped_off");
  EXPECT_EQ(slipped["message"], "slipped, \"off\"");
  EXPECT_EQ(slipped["slip_off_force"], 1.4e-3);
  EXPECT_TRUE(slipped["tip"].is_null());
  EXPECT_TRUE(slipped["centreline"].is_null());
  EXPECT_FALSE(summary["steps"][1]["fields"].contains("two/tip"));
  EXPECT_TRUE(summary["steps"][0]["fields"]["one/tip"]["uncertainty"].is_null());
  std::size_t undefined = 0;
  for (const json& c : summary["comparisons"])
    if (c["component"] == "y" && c["statistic"] == "rrmse") {
      EXPECT_TRUE(c["relative"].is_null());
      EXPECT_THAT(c["note"].get<std::string>(), testing::HasSubstr("vanishes"));
      ++undefined;
    }
  EXPECT_EQ(undefined, 2u);  // B and dB of one pair
  models::Comparison c;
  c.difference = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(json::parse(output::summary_json(result, {c}, origin))["comparisons"][0]["difference"]
                  .is_null());
}

TEST(Summary, HasANullRowForASensorWithoutAField) {
  input::Case c = paper_case({1e-3});
  c.sensors = {Vector3(3, 0, 0), Vector3(1, 0, 0)};
  c.mechanics = {"one"};
  c.fields = {"tip"};
  const std::vector<models::MechanicsEntry> mechanics{mechanics_entry(
      "one", [](const Load& load) { return converged(load, arc(L, 3e-3, Vector3::UnitX(), 20)); })};
  const std::vector<models::FieldEntry> fields{
      field_entry("tip", [](const Deformation&, const Vector3& x) -> Vector3 {
        if (x.x() == 3) throw InputError("B diverges");
        return {1, -0.0, 2};
      })};
  const models::CaseResult result = models::run(c, mechanics, fields);
  const std::string text = output::summary_json(result, {}, origin);
  const json field = json::parse(text)["steps"][0]["fields"]["one/tip"];
  EXPECT_EQ(field["B"], json::parse("[null, [1.0, 0.0, 2.0]]"));
  EXPECT_EQ(field["dB"], json::parse("[null, [0.0, 0.0, 0.0]]"));
  EXPECT_EQ(field["status"], "failed");
  EXPECT_EQ(field["message"], "sensor 0: B diverges");
  EXPECT_THAT(text, testing::Not(testing::HasSubstr("-0.0")));
}

TEST(Summary, HasAnEmptyListWithoutSensors) {
  models::CaseResult result = two_models();
  result.problem.sensors.clear();
  result.fields.clear();
  const json summary = json::parse(output::summary_json(result, {}, origin));
  EXPECT_EQ(summary["sensors"], json::array());
}

std::vector<std::vector<std::string>> parse_csv(const std::string& text) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    rows.emplace_back();
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(cell);
    if (line.ends_with(',')) rows.back().emplace_back();
  }
  return rows;
}

// Oracle: the arc in closed form; interpolation on 24 Chebyshev points is exact to rounding.
TEST(CentrelineCsv, IsTheCurveAtEquidistantPointsAndBreaks) {
  const double k = 40;
  const auto rows = parse_csv(output::centreline_csv(arc(L, 3.01e-3, Vector3::UnitX(), k)));
  EXPECT_EQ(rows[0], (std::vector<std::string>{"S", "x", "y", "z", "theta", "kappa"}));
  EXPECT_EQ(rows[1][0], "# units: S m");
  ASSERT_EQ(rows.size(), 2 + 201 + 1u);  // the joint is not one of the 201
  bool at_joint = false;
  for (std::size_t i = 2; i < rows.size(); ++i) {
    const double S = std::stod(rows[i][0]);
    at_joint = at_joint || S == 3.01e-3;
    EXPECT_NEAR(std::stod(rows[i][1]), (1 - std::cos(k * S)) / k, 1e-15);
    EXPECT_NEAR(std::stod(rows[i][2]), 0, 1e-15);
    EXPECT_NEAR(std::stod(rows[i][3]), std::sin(k * S) / k, 1e-15);
    EXPECT_NEAR(std::stod(rows[i][4]), k * S, 1e-12);
    EXPECT_NEAR(std::stod(rows[i][5]), k, 1e-11);
  }
  EXPECT_TRUE(at_joint);
  EXPECT_EQ(std::stod(rows.back()[0]), L);
}

// Oracle: by hand. At the one sensor the field is the same, bent or straight, and ΔB has twice the
// uncertainty of B; at the other it diverges. The second step slips off.
TEST(FieldsCsv, HasARowForEachStepSensorAndPair) {
  input::Case c = paper_case({1e-3, 2e-3});
  c.sensors = {Vector3(3, 0, 0), Vector3(1, 0, 0)};
  c.sensor_names = {"left", "right"};
  c.mechanics = {"one"};
  c.fields = {"known", "unknown"};
  const std::vector<models::MechanicsEntry> mechanics{mechanics_entry("one", [](const Load& load) {
    MechanicsStep step = converged(load, arc(L, 3e-3, Vector3::UnitX(), 20), 0);
    if (magnitude(load) < 1.5e-3) return step;
    step.deformation.reset();
    step.status = Status::slipped_off;
    return step;
  })};
  const auto formula = [](const Deformation&, const Vector3& x) -> Vector3 {
    if (x.x() == 3) throw InputError("B diverges");
    return {1, -0.0, 2};
  };
  const std::vector<models::FieldEntry> fields{
      field_entry("known", formula, Vector3(1e-6, 2e-6, 3e-6)), field_entry("unknown", formula)};
  EXPECT_EQ(output::fields_csv(models::run(c, mechanics, fields)),
            "step,force,height,azimuth,sensor,pair,B_x,B_y,B_z,dB_x,dB_y,dB_z,uncertainty_x,"
            "uncertainty_y,uncertainty_z,band_x,band_y,band_z\n"
            "# units: force N, height m, azimuth rad, B_x T, B_y T, B_z T, dB_x T, dB_y T, dB_z T, "
            "uncertainty_x T, uncertainty_y T, uncertainty_z T, band_x T, "
            "band_y T, band_z T\n"
            "0,0.001,0.016,0,left,one/known,,,,,,,,,,,,\n"
            "0,0.001,0.016,0,left,one/unknown,,,,,,,,,,,,\n"
            "0,0.001,0.016,0,right,one/known,1,0,2,0,0,0,2e-06,4e-06,6e-06,,,\n"
            "0,0.001,0.016,0,right,one/unknown,1,0,2,0,0,0,,,,,,\n"
            "1,0.002,0.016,0,left,one/known,,,,,,,,,,,,\n"
            "1,0.002,0.016,0,left,one/unknown,,,,,,,,,,,,\n"
            "1,0.002,0.016,0,right,one/known,,,,,,,,,,,,\n"
            "1,0.002,0.016,0,right,one/unknown,,,,,,,,,,,,\n");
}

TEST(ErrorsCsv, HoldsEveryComparisonWithTheSameFigures) {
  const models::CaseResult result = two_models();
  const auto comparisons = models::compare_models(result);
  const auto rows = parse_csv(output::errors_csv(comparisons));
  ASSERT_EQ(rows.size(), comparisons.size() + 1);
  for (std::size_t i = 0; i < comparisons.size(); ++i) {
    const auto& row = rows[i + 1];
    ASSERT_EQ(row.size(), rows[0].size());
    EXPECT_EQ(row[2], comparisons[i].quantity);
    EXPECT_EQ(std::stod(row[7]), *comparisons[i].difference);
    EXPECT_EQ(row[8].empty(), !comparisons[i].relative);
    if (comparisons[i].relative) {
      EXPECT_EQ(std::stod(row[8]), *comparisons[i].relative);
    }
    EXPECT_EQ(row[0].empty(), !comparisons[i].step);
  }
}

TEST(ErrorsCsv, NamesTheSensors) {
  models::Comparison c;
  c.sensor = 1;
  const std::vector<std::string> names{"left", "right"};
  EXPECT_EQ(parse_csv(output::errors_csv({c}, names)).at(1).at(1), "right");
  EXPECT_EQ(parse_csv(output::errors_csv({c})).at(1).at(1), "1");
}

TEST(ErrorsCsv, QuotesANoteWithACommaAndAQuote) {
  models::Comparison c;
  c.note = "one, \"two\"";
  EXPECT_THAT(output::errors_csv({c}), testing::HasSubstr(",\"one, \"\"two\"\"\"\n"));
}

TEST(WriteResults, WritesTheFilesThatTheSummaryNames) {
  const TemporaryFolder folder;
  const models::CaseResult result = two_models();
  output::write_results(result, models::compare_models(result), origin, folder.path());
  const json summary = json::parse(read_text(folder.path() / "summary.json"));
  EXPECT_EQ(summary["steps"][1]["mechanics"]["one"]["centreline"], "one_0001.csv");
  std::size_t files = 0;
  for (const json& step : summary["steps"])
    for (const auto& [model, m] : step["mechanics"].items())
      if (!m["centreline"].is_null()) {
        EXPECT_THAT(read_text(folder.path() / m["centreline"].get<std::string>()),
                    testing::HasSubstr("S,x,y,z,theta,kappa"));
        ++files;
      }
  EXPECT_EQ(files, 3u);
  for (const char* file : {"errors.csv", "fields.csv"})
    EXPECT_TRUE(std::filesystem::exists(folder.path() / file)) << file;
}

TEST(WriteText, SaysWhichFileAndWhyOnAFullDisk) {
  try {
    output::write_file("/dev/full", "text");
    FAIL() << "the disk is full";
  } catch (const FileError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("/dev/full"));
    EXPECT_THAT(error.what(), testing::HasSubstr("No space left"));
  }
}

TEST(ThisProvenance, NamesTheLibrariesAndTheTimeInUtc) {
  const output::Provenance p = output::provenance("ciliaval run a.toml");
  EXPECT_THAT(p.date, testing::MatchesRegex("[0-9]{4}-[0-9]{2}-[0-9]{2}T[0-9:]{8}Z"));
  EXPECT_THAT(p.libraries, testing::Contains(testing::Key("deal.II")));
  EXPECT_THAT(p.libraries, testing::Contains(testing::Key("VTK")));
  EXPECT_FALSE(p.git.empty());
  EXPECT_EQ(p.command, "ciliaval run a.toml");
}

}  // namespace
}  // namespace ciliaval::compare
