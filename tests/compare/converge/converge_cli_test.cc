// SPDX-License-Identifier: LGPL-2.1-or-later
// `ciliaval converge` as a user calls it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "../run/synthetic.h"

namespace ciliaval {
namespace {

namespace fs = std::filesystem;
using test::read_text;
using test::TemporaryFolder;
using testing::HasSubstr;

int ciliaval(const fs::path& folder, const std::string& arguments,
             const std::string& environment = "") {
  const std::string command = "cd '" + folder.string() + "' && " + environment +
                              "'" CILIAVAL_PROGRAM "' " + arguments + " >out.txt 2>err.txt";
  const int status = std::system(command.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
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
