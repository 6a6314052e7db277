// SPDX-License-Identifier: LGPL-2.1-or-later
// `ciliaval converge` as a user calls it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "tests/support/program.h"

namespace ciliaval {
namespace {

namespace fs = std::filesystem;
using test::read_text;
using test::TemporaryFolder;
using testing::HasSubstr;

int ciliaval(const fs::path& folder, const std::string& arguments,
             const std::string& environment = "") {
  return test::run_program(folder, arguments, environment).code;
}

void write_case(const fs::path& folder, const std::string& models) {
  std::ofstream(folder / "one.toml") << test::case_text({.name = "one"}, models);
}

const nlohmann::json& quantity(const nlohmann::json& study, const std::string& id) {
  for (const auto& entry : study["quantities"])
    if (entry["id"] == id) return entry;
  throw std::out_of_range(id);
}

// Degree 2: the tip of the beam superconverges with order 4 (docs/theory/beam.md: 2p). Oracle: that
// order, and the same beam at the default degree 6.
TEST(Converge, ABeamOfDegreeTwoConvergesWithOrderFourToTheBeamOfDegreeSix) {
  const TemporaryFolder folder;
  write_case(folder.path(),
             "mechanics = [\"beam\"]\nfields = [\"volume\"]\n[models.beam]\ndegree = 2\n");
  ASSERT_EQ(ciliaval(folder.path(), "converge one.toml --levels 5 --json two.json --csv two.csv"),
            0)
      << read_text(folder.path() / "err.txt");
  write_case(folder.path(), "mechanics = [\"beam\"]\nfields = [\"volume\"]\n");
  ASSERT_EQ(ciliaval(folder.path(), "converge one.toml --json six.json"), 0);
  const auto two = nlohmann::json::parse(read_text(folder.path() / "two.json"))["studies"][0];
  const auto six = nlohmann::json::parse(read_text(folder.path() / "six.json"))["studies"][0];
  for (const std::string id : {"steps/0/mechanics/beam/tip/x", "steps/0/mechanics/beam/tip/z",
                               "steps/0/fields/beam/volume/dB/0/x"}) {
    const auto& q = quantity(two, id);
    ASSERT_TRUE(q["conclusive"]) << id;
    EXPECT_NEAR(q["order"].get<double>(), 4, 0.3) << id;
    const double reference = quantity(six, id)["levels"][0]["value"];
    const double finest = q["levels"][0]["value"];
    EXPECT_LT(std::abs(finest - reference), q["uncertainty"].get<double>()) << id;
    EXPECT_LT(std::abs(q["limit"].get<double>() - reference), std::abs(finest - reference)) << id;
  }
  // The verdict counts what the JSON has; the list is there on request.
  const std::string brief = read_text(folder.path() / "out.txt");
  EXPECT_THAT(brief, HasSubstr("numbers have an interval, the widest +-"));
  EXPECT_THAT(brief,
              testing::ContainsRegex("tip known to [0-9e.-]+ %, dB known to [0-9e.-]+ % on"));
  EXPECT_THAT(brief, HasSubstr(" from the limit; nothing to refine for 1 %"));
  EXPECT_THAT(brief, testing::ContainsRegex("Verdict: converged( in part)?: "));
  EXPECT_THAT(brief, testing::Not(HasSubstr("extrapolated")));
  ASSERT_EQ(ciliaval(folder.path(), "converge one.toml --all --json six.json"), 0);
  const std::string list = read_text(folder.path() / "out.txt");
  EXPECT_THAT(list, HasSubstr("extrapolated"));
  std::size_t numbers = 0;
  std::size_t conclusive = 0;
  const auto studies = nlohmann::json::parse(read_text(folder.path() / "six.json"))["studies"];
  for (const auto& study : studies)
    for (const auto& q : study["quantities"]) {
      ++numbers;
      conclusive += q["conclusive"].get<bool>() ? 1 : 0;
    }
  EXPECT_THAT(list,
              testing::ContainsRegex("Verdict: [a-z ]+: " + std::to_string(conclusive) + " of " +
                                     std::to_string(numbers) + " numbers have an interval"));
  // Every column of the CSV is under its own name; oracle: the JSON.
  std::istringstream csv(read_text(folder.path() / "two.csv"));
  std::map<std::string, std::vector<std::string>> columns;
  std::vector<std::string> names;
  for (std::string text; std::getline(csv, text);) {
    std::vector<std::string> cells(1);
    bool quoted = false;  // no quote stands within a cell of this study
    for (const char c : text) {
      if (c == '"')
        quoted = !quoted;
      else if (c == ',' && !quoted)
        cells.emplace_back();
      else
        cells.back() += c;
    }
    if (names.empty()) names = cells;
    ASSERT_EQ(cells.size(), names.size()) << text;
    for (std::size_t i = 0; i < cells.size(); ++i) columns[names[i]].push_back(cells[i]);
  }
  const auto& ids = columns.at("quantity");
  // The header, then the quantities of the two options, refinement and degree.
  ASSERT_EQ(ids.size(), 2 * two["quantities"].size() + 1);
  for (std::size_t i = 1; i <= two["quantities"].size(); ++i) {
    const auto& q = two["quantities"][i - 1];
    EXPECT_EQ(columns.at("model")[i], "beam");
    EXPECT_EQ(columns.at("option")[i], "refinement");
    EXPECT_EQ(ids[i], q["id"].get<std::string>());
    EXPECT_EQ(columns.at("unit")[i], q["unit"].get<std::string>());
    EXPECT_EQ(columns.at("conclusive")[i], q["conclusive"].get<bool>() ? "1" : "0");
    if (q["conclusive"].get<bool>()) {
      EXPECT_EQ(std::stod(columns.at("limit")[i]), q["limit"].get<double>());
    }
    EXPECT_EQ(std::stod(columns.at("value_5")[i]), q["levels"][4]["value"].get<double>());
  }
}

// The plot comes last: without Python everything else is there.
TEST(Converge, PlotsTheOrders) {
  const TemporaryFolder folder;
  write_case(folder.path(),
             "mechanics = [\"beam\"]\nfields = [\"volume\"]\n[models.beam]\ndegree = 2\n");
  EXPECT_EQ(ciliaval(folder.path(), "converge one.toml --plot one.svg"), 0)
      << read_text(folder.path() / "err.txt");
  const std::string svg = read_text(folder.path() / "one.svg");
  EXPECT_THAT(svg, testing::StartsWith("<?xml"));
  EXPECT_THAT(svg, testing::ContainsRegex("tip: order (3.9|4.0)"));
  EXPECT_THAT(svg, testing::ContainsRegex("B. beam/volume: order (3.9|4.0)"));
  EXPECT_THAT(svg, HasSubstr("beam, refinement"));
  EXPECT_EQ(ciliaval(folder.path(), "converge one.toml --json two.json --plot two.svg",
                     "CILIAVAL_PYTHON=none "),
            4);
  EXPECT_THAT(read_text(folder.path() / "err.txt"), HasSubstr("there is no Python `none`"));
  EXPECT_THAT(read_text(folder.path() / "out.txt"), HasSubstr("Verdict: "));
  EXPECT_TRUE(fs::exists(folder.path() / "two.json"));
  EXPECT_FALSE(fs::exists(folder.path() / "two.svg"));
  EXPECT_EQ(ciliaval(folder.path(), "converge one.toml --plot none/two.svg"), 4);
  EXPECT_THAT(read_text(folder.path() / "err.txt"), HasSubstr("none/two.svg"));
}

// The paper's sums are midpoint rules: order 2. Oracle: the closed forms of the same integrals.
TEST(Converge, ThePapersSumsConvergeWithOrderTwoToTheClosedForms) {
  const TemporaryFolder folder;
  const std::string models =
      "mechanics = [\"elastica\", \"beam\"]\nfields = [\"line\", \"volume\"]\n";
  const std::string uniform = "method = \"uniform\"\n";
  write_case(folder.path(), models + "[models.line]\n" + uniform + "[models.volume]\n" + uniform);
  ASSERT_EQ(ciliaval(folder.path(), "converge one.toml --levels 4 --json sums.json"), 0)
      << read_text(folder.path() / "err.txt");
  write_case(folder.path(), models);
  ASSERT_EQ(ciliaval(folder.path(), "run one.toml"), 0);
  const auto studies = nlohmann::json::parse(read_text(folder.path() / "sums.json"))["studies"];
  const auto exact =
      nlohmann::json::parse(read_text(folder.path() / "results/one/summary.json"))["steps"][0];
  ASSERT_EQ(studies.size(), 5u);  // elastica, beam twice, line, volume
  for (const std::size_t i : {3u, 4u}) {
    EXPECT_EQ(studies[i]["settings"], nlohmann::json({128.0, 64.0, 32.0, 16.0}));
    const std::string pair = "elastica/" + studies[i]["model"].get<std::string>();
    for (const std::size_t axis : {0u, 1u, 2u}) {
      const std::string id = "steps/0/fields/" + pair + "/B/0/" + "xyz"[axis];
      const auto& q = quantity(studies[i], id);
      ASSERT_TRUE(q["conclusive"]) << id;
      EXPECT_NEAR(q["order"].get<double>(), 2, 0.1) << id;
      const double closed_form = exact["fields"][pair]["B"][0][axis];
      EXPECT_LT(std::abs(q["limit"].get<double>() - closed_form), q["uncertainty"].get<double>())
          << id;
    }
    for (const auto& q : studies[i]["quantities"])
      EXPECT_EQ(q["id"].get<std::string>().find("/mechanics/"), std::string::npos);
  }
}

const nlohmann::json& study_of(const nlohmann::json& studies, const std::string& model,
                               const std::string& option) {
  for (const auto& study : studies)
    if (study["model"] == model && study["option"] == option) return study;
  throw std::out_of_range(model + " " + option);
}

// Degrees converge exponentially, tolerances are kept. Oracles: the beam on 32 elements a segment
// (`refinement`), and the closed form for the quadratures of the same integrals.
TEST(Converge, DegreesAndTolerancesAreRefinedToo) {
  const TemporaryFolder folder;
  const std::string models =
      "mechanics = [\"elastica\", \"beam\"]\nfields = [\"line\", \"volume\"]\n";
  const std::string quadrature = "method = \"quadrature\"\n";
  write_case(folder.path(),
             models + "[models.line]\n" + quadrature + "[models.volume]\n" + quadrature);
  ASSERT_EQ(ciliaval(folder.path(), "converge one.toml --levels 6 --json all.json"), 0)
      << read_text(folder.path() / "err.txt");
  const auto studies = nlohmann::json::parse(read_text(folder.path() / "all.json"))["studies"];
  const auto value = [](const auto& q, std::size_t level) {
    return q["levels"][level]["value"].template get<double>();
  };
  const auto& degrees = study_of(studies, "beam", "degree");
  EXPECT_EQ(degrees["settings"], nlohmann::json({6.0, 5.0, 4.0, 3.0, 2.0}));
  const std::string tip = "steps/0/mechanics/beam/tip/x";
  const double finest_mesh = value(quantity(study_of(studies, "beam", "refinement"), tip), 0);
  EXPECT_NEAR(value(quantity(degrees, tip), 0), finest_mesh, 1e-12);
  EXPECT_GT(std::abs(value(quantity(degrees, tip), 4) - finest_mesh), 1e-10);
  const auto& elastica = study_of(studies, "elastica", "tolerance");
  EXPECT_EQ(elastica["settings"], nlohmann::json({1e-12, 1e-10, 1e-8, 1e-6, 1e-4}));
  for (const auto& q : elastica["quantities"]) {
    EXPECT_TRUE(q["conclusive"]) << q;
    EXPECT_EQ(q["id"].get<std::string>().find("/fields/"), std::string::npos);
  }
  write_case(folder.path(), models);
  ASSERT_EQ(ciliaval(folder.path(), "run one.toml"), 0);
  const auto exact =
      nlohmann::json::parse(read_text(folder.path() / "results/one/summary.json"))["steps"][0];
  for (const std::string model : {"line", "volume"}) {
    const auto& study = study_of(studies, model, "tolerance");
    const std::string pair = "elastica/" + model;
    for (const auto& q : study["quantities"]) EXPECT_TRUE(q["conclusive"]) << q;
    for (const std::size_t axis : {0u, 1u, 2u}) {
      const auto& q = quantity(study, "steps/0/fields/" + pair + "/B/0/" + "xyz"[axis]);
      const double closed_form = exact["fields"][pair]["B"][0][axis];
      EXPECT_LT(std::abs(q["limit"].get<double>() - closed_form), q["uncertainty"].get<double>());
      EXPECT_GT(std::abs(value(q, 4) - closed_form), 0) << "the option does nothing";
    }
  }
}

TEST(Converge, WhatCannotBeRefinedIsSaid) {
  const TemporaryFolder folder;
  write_case(folder.path(), "mechanics = [\"beam\"]\n");
  EXPECT_EQ(ciliaval(folder.path(), "converge one.toml --levels 2"), 2);
  EXPECT_THAT(read_text(folder.path() / "err.txt"),
              HasSubstr("3 levels of refinement or more, not 2"));
  write_case(folder.path(), "mechanics = [\"beam\"]\n[models.beam]\nmax_iterations = 1\n");
  EXPECT_EQ(ciliaval(folder.path(), "converge one.toml"), 3);
  EXPECT_THAT(read_text(folder.path() / "out.txt"), HasSubstr("inconclusive: refinement 0:"));
  EXPECT_THAT(read_text(folder.path() / "out.txt"), HasSubstr("Verdict: inconclusive: "));
  // A field that fails on a level: the sensor is on the end face's rim.
  std::ofstream(folder.path() / "rim.toml")
      << test::case_text({.name = "rim", .sensor = "[\"1.5 mm\", \"0 mm\", \"3 mm\"]"},
                         "mechanics = [\"elastica\"]\nfields = [\"volume\"]\n"
                         "[models.volume]\nmethod = \"quadrature\"\n");
  EXPECT_EQ(ciliaval(folder.path(), "converge rim.toml"), 3);
  EXPECT_THAT(read_text(folder.path() / "out.txt"), HasSubstr("inconclusive: tolerance 0.01:"));
}

// Levels that all keep their tolerances by an estimate that is not tested: their agreement says
// nothing. Half a minute of the potential.
TEST(ConvergeSlow, NoNumberHasAnIntervalWhereTheErrorIsNotKnown) {
  const TemporaryFolder folder;
  write_case(folder.path(),
             "mechanics = [\"elastica\"]\nfields = [\"potential\"]\n"
             "[models.potential]\nrelative_permeability = 3.0\n");
  EXPECT_EQ(ciliaval(folder.path(), "converge one.toml --json one.json"), 0);
  EXPECT_THAT(read_text(folder.path() / "out.txt"), AllOf(HasSubstr("the error of B is not known"),
                                                          HasSubstr("Verdict: converged in part")));
  const auto json = nlohmann::json::parse(read_text(folder.path() / "one.json"));
  const auto& quantities = json["studies"].back()["quantities"];
  EXPECT_FALSE(quantities.empty());
  for (const auto& quantity : quantities) {
    EXPECT_FALSE(quantity["conclusive"]);
    EXPECT_TRUE(quantity["uncertainty"].is_null());
    EXPECT_THAT(quantity["reason"].get<std::string>(), HasSubstr("not known"));
  }
}

}  // namespace
}  // namespace ciliaval
