// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/regression/baseline.h"
#include "compare/models/registry.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/property_tree/ptree.hpp>
#include <boost/property_tree/xml_parser.hpp>
#include <cmath>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "compare/output/json_file.h"
#include "compare/regression/check.h"
#include "problem/error.h"
#include "tests/support/synthetic.h"

namespace ciliaval::compare {
namespace {

using Json = nlohmann::ordered_json;
using testing::HasSubstr;

const output::Provenance origin{
    "0.1.0", "abc", {{"deal.II", "9.4.1"}}, "ciliaval check", "2026-11-21"};

input::Case any_case() {
  return input::read_case(test::case_text({.name = "any"}, "mechanics = [\"elastica\"]\n"),
                          "any.toml", models::known());
}

regression::Measurements some() {
  regression::Measurements m;
  m.quantities = {{.step = 0,
                   .mechanics = "elastica",
                   .field = {},
                   .sensor = {},
                   .quantity = "tip",
                   .component = "x",
                   .unit = "m",
                   .value = 1.0 / 3,
                   .uncertainty = {},
                   .scale = 20e-3,
                   .group = 20e-3},
                  {.step = 0,
                   .mechanics = "elastica",
                   .field = {},
                   .sensor = {},
                   .quantity = "tip_angle",
                   .component = {},
                   .unit = "rad",
                   .value = -0.0,
                   .uncertainty = {},
                   .scale = 1,
                   .group = 1}};
  m.outcomes = {{"steps/0/mechanics/elastica/status", "converged"}};
  return m;
}

regression::Baseline some_baseline() {
  regression::Baseline baseline = regression::make_baseline(any_case(), some(), origin, nullptr);
  baseline.quantities[0].reference = regression::Reference{"Mattiasson (1981)", 0.3333, {1e-3, 0}};
  return baseline;
}

TEST(Baseline, ReadsBackWhatItWrote) {
  const regression::Baseline written = some_baseline();
  const regression::Baseline read =
      regression::read_baseline(regression::to_json(written), "any.baseline.json");
  EXPECT_EQ(read.case_name, "any");
  EXPECT_EQ(read.case_text, written.case_text);
  EXPECT_EQ(read.origin.date, "2026-11-21");
  ASSERT_EQ(read.quantities.size(), 2u);
  EXPECT_EQ(read.quantities[0].value, 1.0 / 3);
  EXPECT_EQ(read.quantities[0].allowed.relative, written.quantities[0].allowed.relative);
  ASSERT_TRUE(read.quantities[0].reference);
  EXPECT_EQ(read.quantities[0].reference->label, "Mattiasson (1981)");
  ASSERT_EQ(read.outcomes.size(), 1u);
  EXPECT_EQ(read.outcomes[0].value, "converged");
}

TEST(Baseline, ListsWhatChangedAndKeepsTheReferences) {
  const regression::Baseline old = some_baseline();
  regression::Measurements now = some();
  now.quantities[0].value = 0.25;
  now.quantities[1].quantity = "applied_force";
  const regression::Baseline candidate = regression::make_baseline(any_case(), now, origin, &old);
  ASSERT_EQ(candidate.changes.size(), 3u);
  EXPECT_EQ(candidate.changes[0].old_value, 1.0 / 3);
  EXPECT_EQ(candidate.changes[0].new_value, 0.25);
  EXPECT_EQ(candidate.changes[1].old_value, std::nullopt);
  EXPECT_EQ(candidate.changes[2].new_value, std::nullopt);
  EXPECT_TRUE(candidate.quantities[0].reference);
  const regression::Baseline read = regression::read_baseline(regression::to_json(candidate), "f");
  EXPECT_EQ(read.changes[0].old_value, 1.0 / 3);
  EXPECT_EQ(read.changes[1].old_value, std::nullopt);
}

// A new model, or a new option of another model, is no change of a case that does not use it.
TEST(Baseline, KeepsTheOptionsOfTheModelsInUse) {
  using testing::Contains;
  using testing::Not;
  const input::Case problem = input::read_case(
      test::case_text({.name = "any"},
                      "mechanics = [\"beam\"]\nfields = [\"potential\"]\n"
                      "[[models.potential.plate]]\nlower = [\"-1 mm\", \"-1 mm\", \"-5 mm\"]\n"
                      "upper = [\"1 mm\", \"1 mm\", \"-4 mm\"]\nrelative_permeability = 9\n"),
      "any.toml", models::known());
  const std::vector<std::string> text = regression::case_text(problem);
  EXPECT_THAT(text, Contains("[models.beam]"));
  EXPECT_THAT(text, Contains("[models.potential]"));
  EXPECT_THAT(text, Contains("[[models.potential.plate]]"));
  EXPECT_THAT(text, Contains("[[cilium.segment]]"));
  EXPECT_THAT(text, Contains("[load]"));
  for (const char* unused : {"[models.solid]", "[models.elastica]", "[models.line]"})
    EXPECT_THAT(text, Not(Contains(unused)));
}

TEST(Baseline, RoundingIsNoChange) {
  const regression::Baseline old = some_baseline();
  regression::Measurements now = some();
  now.quantities[0].value *= 1 + 1e-14;
  const regression::Baseline candidate = regression::make_baseline(any_case(), now, origin, &old);
  EXPECT_TRUE(candidate.changes.empty());
  EXPECT_EQ(candidate.quantities[0].value, old.quantities[0].value);
}

// The less accurate model of a pair decides; a model's own estimate of its error does not.
TEST(Baseline, AToleranceIsTheModelsAccuracyClassOfTheScale) {
  const auto tolerance = [](const char* mechanics, const char* field) {
    results::Observation row;
    row.mechanics = mechanics;
    row.field = field;
    row.value = 1e-3;
    row.scale = 5e-3;
    row.group = 2e-3;
    return regression::allowed_deviation(row);
  };
  EXPECT_DOUBLE_EQ(tolerance("elastica", "line").absolute, 2e-13);
  EXPECT_DOUBLE_EQ(tolerance("solid", "line").absolute, 2e-11);
  EXPECT_DOUBLE_EQ(tolerance("solid", "mesh").absolute, 2e-11);
  EXPECT_DOUBLE_EQ(tolerance("elastica", "potential").absolute, 2e-9);
  EXPECT_DOUBLE_EQ(tolerance("calculix", "potential").absolute, 2e-8);
  EXPECT_EQ(tolerance("elastica", "potential").relative, 1e-6);
}

TEST(Baseline, IsNotMadeOfWhatFailed) {
  regression::Measurements bad = some();
  bad.quantities[0].value = std::nan("");
  EXPECT_THROW(regression::make_baseline(any_case(), bad, origin, nullptr), SolverError);
  bad = some();
  bad.outcomes[0].value = "failed";
  EXPECT_THROW(regression::make_baseline(any_case(), bad, origin, nullptr), SolverError);
  bad = some();
  bad.quantities.clear();
  EXPECT_THROW(regression::make_baseline(any_case(), bad, origin, nullptr), SolverError);
}

// A sign that flips must be noticed wherever the number is more than its group's rounding.
TEST(Baseline, NoShippedToleranceLetsADifferenceFlipItsSign) {
  std::size_t looked = 0;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(CILIAVAL_SOURCE_DIR "/cases")) {
    if (!entry.path().string().ends_with(".baseline.json")) continue;
    const regression::Baseline baseline = regression::read_baseline(entry.path());
    for (const regression::Expected& e : baseline.quantities) {
      if (e.id.find("/dB/") == std::string::npos) continue;
      ++looked;
      EXPECT_LT(e.allowed.limit(e.value, -e.value), 2 * std::abs(e.value))
          << baseline.case_name << " " << e.id;
    }
  }
  EXPECT_GT(looked, 500u);
}

struct Damage {
  std::string message;
  std::function<void(Json&)> plant;
};

// Oracle: the damage that was done.
TEST(Baseline, ADamagedOneIsRefusedWithItsPlace) {
  const std::string first = "steps/0/mechanics/elastica/tip/x";
  const std::vector<Damage> all{
      {"`schema` must be 1", [](Json& j) { j["schema"] = 2; }},
      {"`quantities` is missing", [](Json& j) { j.erase("quantities"); }},
      {"`outcomes` is missing", [](Json& j) { j.erase("outcomes"); }},
      {"`origin` is missing", [](Json& j) { j.erase("origin"); }},
      {"`case` is empty", [](Json& j) { j["case"] = ""; }},
      {"`note` is no key here", [](Json& j) { j["note"] = "x"; }},
      {first + ": `tolerance` is no key here",
       [](Json& j) { j["quantities"][0]["tolerance"] = 1e-3; }},
      {first + ": `relative` is missing", [](Json& j) { j["quantities"][0].erase("relative"); }},
      {first + ": `value` must be a finite number",
       [](Json& j) { j["quantities"][0]["value"] = nullptr; }},
      {first + ": `value` must be a finite number",
       [](Json& j) { j["quantities"][0]["value"] = "0.3"; }},
      {first + ": `relative` and `absolute` must not be negative",
       [](Json& j) { j["quantities"][0]["relative"] = -1e-3; }},
      {"nor both without effect",
       [](Json& j) {
         j["quantities"][0]["relative"] = 0;
         j["quantities"][0]["absolute"] = 0;
       }},
      {first + ": `relative` and `absolute` must be positive",
       [](Json& j) { j["quantities"][0]["relative"] = 0; }},
      {first + ": `relative` and `absolute` must be positive",
       [](Json& j) { j["quantities"][0]["absolute"] = 0; }},
      {"checks nothing", [](Json& j) { j["quantities"][0]["relative"] = 0.5; }},
      {first + "/reference: `label` is empty",
       [](Json& j) { j["quantities"][0]["reference"]["label"] = ""; }},
      {first + "/reference: `source` is no key here",
       [](Json& j) { j["quantities"][0]["reference"]["source"] = "x"; }},
      {"is there twice", [](Json& j) { j["quantities"].push_back(j["quantities"][0]); }},
      {"is there twice", [](Json& j) { j["outcomes"].push_back(j["outcomes"][0]); }},
      {"must be an object", [](Json& j) { j["quantities"][0] = 3; }},
      {"must be a list", [](Json& j) { j["quantities"] = 3; }},
      {"not a baseline", [](Json& j) { j["case_text"][0] = 3; }},
  };
  const std::string good = regression::to_json(some_baseline());
  for (const Damage& damage : all) {
    Json json = Json::parse(good);
    damage.plant(json);
    try {
      regression::read_baseline(json.dump(), "any.baseline.json");
      ADD_FAILURE() << "accepted: " << damage.message;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr(damage.message));
      EXPECT_THAT(error.what(), testing::StartsWith("any.baseline.json: "));
    }
  }
  for (std::size_t length = 0; length < good.size() - 2; length += 97)
    EXPECT_THROW(regression::read_baseline(good.substr(0, length), "f"), InputError) << length;
  // The last of two values of a key would win in silence.
  std::string twice = good;
  twice.replace(twice.find("\"relative\":"), 0, "\"relative\":0.09,");
  try {
    regression::read_baseline(twice, "f");
    ADD_FAILURE() << "accepted: a key twice";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("the key \"relative\" is there twice"));
  }
}

// Both sides of the bounds of every JSON file that the program reads.
TEST(JsonFile, RefusesAKeyTwiceInOneObjectAndDepthBeyondItsBound) {
  const auto parse = [](const std::string& text) { return output::parse_json(text, "f"); };
  const auto nested = [](std::size_t n) { return std::string(n, '[') + std::string(n, ']'); };
  EXPECT_NO_THROW(parse(nested(100)));
  EXPECT_THROW(parse(nested(101)), InputError);
  EXPECT_THROW(parse(R"({"a": [{"b": 1, "c": {}, "b": 2}]})"), InputError);
  EXPECT_NO_THROW(parse(R"({"a": {"b": 1}, "b": [{"b": 1}, {"b": {"b": 2}}]})"));
}

regression::CheckReport some_report() {
  regression::CheckReport report;
  report.case_name = "a <case>";
  regression::Finding good;
  good.passed = true;
  good.id = "steps/0/mechanics/elastica/tip/x";
  good.against = "baseline";
  good.unit = "m";
  good.measured = 1.5;
  good.expected = 1.5;
  good.limit = 1e-9;
  regression::Finding bad = good;
  bad.passed = false;
  bad.against = "Mattiasson & others";
  bad.message = "is \"wrong\" <by far>";
  bad.uncertainty = std::nan("");
  report.findings = {good, bad};
  return report;
}

// Oracle: an XML parser.
TEST(Report, JUnitHasAFailureForEachFindingThatFailed) {
  std::istringstream text(regression::report_junit({some_report()}));
  boost::property_tree::ptree tree;
  boost::property_tree::read_xml(text, tree);
  const auto& suite = tree.get_child("testsuites.testsuite");
  EXPECT_EQ(suite.get<std::string>("<xmlattr>.name"), "a <case>");
  EXPECT_EQ(suite.get<int>("<xmlattr>.tests"), 2);
  EXPECT_EQ(suite.get<int>("<xmlattr>.failures"), 1);
  EXPECT_EQ(suite.count("testcase"), 2u);
  const auto& last = suite.back().second;
  EXPECT_EQ(last.get<std::string>("failure.<xmlattr>.message"), "is \"wrong\" <by far>");
  const auto& measured = last.get_child("properties").front().second;
  EXPECT_EQ(measured.get<std::string>("<xmlattr>.name"), "measured, m");
  EXPECT_EQ(measured.get<double>("<xmlattr>.value"), 1.5);
}

TEST(Report, JsonHasMeasuredValueLimitAndUncertainty) {
  const Json json = Json::parse(regression::report_json({some_report()}));
  EXPECT_EQ(json["passed"], false);
  const Json& bad = json["cases"][0]["findings"][1];
  EXPECT_EQ(bad["measured"], 1.5);
  EXPECT_EQ(bad["limit"], 1e-9);
  EXPECT_TRUE(bad["uncertainty"].is_null());
  EXPECT_EQ(json["cases"][0]["failures"], 1);
}

}  // namespace
}  // namespace ciliaval::compare
