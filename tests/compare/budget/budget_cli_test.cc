// SPDX-License-Identifier: LGPL-2.1-or-later
// `ciliaval budget` as a user calls it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
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

void write_case(const fs::path& folder, const std::string& force, const std::string& options = "") {
  std::ofstream(folder / "one.toml")
      << test::case_text({.name = "one", .force = force}, "mechanics = [\"elastica\"]\n" + options);
}

constexpr const char* rods = " --without solid --without potential ";

// Oracle: `ciliaval run` of the same pairs. The case lists none of the budget's models.
TEST(BudgetCommand, PrintsAndWritesWhatRunComputes) {
  const TemporaryFolder folder;
  write_case(folder.path(), "[\"2 mN\", \"9 mN\"]");
  ASSERT_EQ(ciliaval(folder.path(), std::string("budget one.toml --json one.json --csv one.csv "
                                                "--plot one.svg --quiet") +
                                        rods),
            0)
      << read_text(folder.path() / "err.txt");
  EXPECT_EQ(read_text(folder.path() / "err.txt"), "");
  const std::string out = read_text(folder.path() / "out.txt");
  EXPECT_THAT(out, HasSubstr("step 2: no budget: elastica slipped off"));
  EXPECT_THAT(out, HasSubstr("solid/line: without solid"));
  EXPECT_THAT(read_text(folder.path() / "one.svg"), HasSubstr("beam/volume wedge"));
  std::ofstream(folder.path() / "one.toml")
      << test::case_text({.name = "one", .force = "\"2 mN\""},
                         "mechanics = [\"elastica\", \"beam\"]\nfields = [\"line\", \"volume\"]\n");
  ASSERT_EQ(ciliaval(folder.path(), "run one.toml"), 0);
  const auto fields = nlohmann::json::parse(
      read_text(folder.path() / "results/one/summary.json"))["steps"][0]["fields"];
  const auto rows = nlohmann::json::parse(read_text(folder.path() / "one.json"))["rows"];
  int compared = 0;
  for (const auto& row : rows) {
    if (row["quantity"] != "dB") continue;
    const std::size_t axis = row["component"].get<std::string>()[0] - std::size_t('x');
    const double paper = fields["elastica/line"]["dB"][0][axis];
    const double best = fields["beam/volume"]["dB"][0][axis];
    EXPECT_NEAR(row["paper"].get<double>(), paper, 1e-15);
    EXPECT_NEAR(row["best"].get<double>(), best, 1e-15);
    EXPECT_EQ(row["best_model"], "beam/volume wedge");
    ++compared;
  }
  EXPECT_EQ(compared, 3);
}

TEST(BudgetCommand, WhatCannotBeDoneHasItsExitCodeAndMessage) {
  const TemporaryFolder folder;
  write_case(folder.path(), "\"2 mN\"");
  const auto fails = [&](const std::string& arguments, int code, const std::string& words,
                         const std::string& environment = "") {
    EXPECT_EQ(ciliaval(folder.path(), "budget " + arguments, environment), code) << arguments;
    EXPECT_THAT(read_text(folder.path() / "err.txt"), HasSubstr(words)) << arguments;
  };
  fails("", 2, "CASE");
  fails("none.toml", 2, "none.toml");
  fails("one.toml --without sollid", 2, "did you mean 'solid'?");
  fails("one.toml --without line", 2, "the paper's model");
  fails(std::string("one.toml --json none/one.json") + rods, 4, "none/one.json");
  fails(std::string("one.toml --csv none/one.csv") + rods, 4, "none/one.csv");
  fails(std::string("one.toml --plot none/one.svg") + rods, 4, "none/one.svg");
  fails(std::string("one.toml --json two.json --plot two.svg") + rods, 4,
        "there is no Python `none`", "CILIAVAL_PYTHON=none ");
  EXPECT_THAT(read_text(folder.path() / "out.txt"), HasSubstr("total"));
  EXPECT_TRUE(fs::exists(folder.path() / "two.json"));
  EXPECT_FALSE(fs::exists(folder.path() / "two.svg"));
}

TEST(BudgetCommand, NothingToJudgeIsExitCode5) {
  const TemporaryFolder folder;
  write_case(folder.path(), "\"9 mN\"");
  EXPECT_EQ(ciliaval(folder.path(), std::string("budget one.toml --plot one.svg") + rods), 5);
  EXPECT_THAT(read_text(folder.path() / "out.txt"), HasSubstr("no difference to split"));
  EXPECT_THAT(read_text(folder.path() / "err.txt"), HasSubstr("no difference to draw"));
  EXPECT_FALSE(fs::exists(folder.path() / "one.svg"));
  write_case(folder.path(), "\"2 mN\"");
  EXPECT_EQ(ciliaval(folder.path(),
                     std::string("budget one.toml --without beam --without volume") + rods),
            5);
}

// One Newton iteration is too few for the beam at 2 mN, not at 1 nN.
TEST(BudgetCommand, AModelThatFailsIsExitCode3AndTheOtherStepsArePrinted) {
  const TemporaryFolder folder;
  write_case(folder.path(), "[\"1e-9 mN\", \"2 mN\"]",
             "[models.beam]\nmax_iterations = 2\nmax_cutbacks = 0\n");
  EXPECT_EQ(ciliaval(folder.path(), std::string("budget one.toml") + rods), 3);
  const std::string out = read_text(folder.path() / "out.txt");
  EXPECT_THAT(out, HasSubstr("Step 1 of 2"));
  EXPECT_THAT(out, HasSubstr("step 2: no budget: beam failed"));
}

}  // namespace
}  // namespace ciliaval
