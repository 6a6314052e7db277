// SPDX-License-Identifier: LGPL-2.1-or-later
// `ciliaval converge` as a user calls it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "../run/program.h"

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

// Degree 2: the tip of the beam superconverges with order 4 (docs/beam.md: 2p). Oracle: that order,
// and the same beam at the default degree 6.
TEST(Converge, ABeamOfDegreeTwoConvergesWithOrderFourToTheBeamOfDegreeSix) {
  const TemporaryFolder folder;
  write_case(
      folder.path(),
      "mechanics = [\"elastica\", \"beam\"]\nfields = [\"volume\"]\n[models.beam]\ndegree = 2\n");
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
  EXPECT_THAT(read_text(folder.path() / "two.csv"), HasSubstr("beam,steps/0/mechanics/beam/tip/x"));
}

// The plot comes last: without gnuplot everything else is there.
TEST(Converge, PlotsTheOrders) {
  const TemporaryFolder folder;
  write_case(folder.path(),
             "mechanics = [\"beam\"]\nfields = [\"volume\"]\n[models.beam]\ndegree = 2\n");
  EXPECT_EQ(ciliaval(folder.path(), "converge one.toml --plot one.svg"), 0)
      << read_text(folder.path() / "err.txt");
  const std::string svg = read_text(folder.path() / "one.svg");
  EXPECT_THAT(svg, testing::StartsWith("<?xml"));
  EXPECT_THAT(svg, testing::ContainsRegex("tip: order (3.9|4.0)"));
  EXPECT_THAT(svg, testing::ContainsRegex("dB. beam/volume: order (3.9|4.0)"));
  EXPECT_THAT(svg, HasSubstr("beam, load step 1 of 1"));
  EXPECT_EQ(
      ciliaval(folder.path(), "converge one.toml --json two.json --plot two.svg", "PATH=/nowhere "),
      4);
  EXPECT_THAT(read_text(folder.path() / "err.txt"), HasSubstr("apt-get install gnuplot-nox"));
  EXPECT_THAT(read_text(folder.path() / "out.txt"), HasSubstr("extrapolated"));
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
  ASSERT_EQ(studies.size(), 3u);  // beam, line, volume
  for (const std::size_t i : {1u, 2u}) {
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

TEST(Converge, WhatCannotBeRefinedIsSaid) {
  const TemporaryFolder folder;
  write_case(folder.path(), "mechanics = [\"elastica\"]\n");
  EXPECT_EQ(ciliaval(folder.path(), "converge one.toml"), 5);
  EXPECT_THAT(read_text(folder.path() / "out.txt"), HasSubstr("no discretised model"));
  write_case(folder.path(), "mechanics = [\"beam\"]\n");
  EXPECT_EQ(ciliaval(folder.path(), "converge one.toml --levels 2"), 2);
  EXPECT_THAT(read_text(folder.path() / "err.txt"), HasSubstr("beam has 3 to 6 levels"));
  write_case(folder.path(), "mechanics = [\"beam\"]\n[models.beam]\nmax_iterations = 1\n");
  EXPECT_EQ(ciliaval(folder.path(), "converge one.toml"), 3);
  EXPECT_THAT(read_text(folder.path() / "out.txt"), HasSubstr("inconclusive: refinement 0:"));
}

}  // namespace
}  // namespace ciliaval
