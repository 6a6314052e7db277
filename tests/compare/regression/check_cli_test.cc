// SPDX-License-Identifier: LGPL-2.1-or-later
// `ciliaval check` as a user calls it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>

#include "tests/support/program.h"

namespace ciliaval {
namespace {

namespace fs = std::filesystem;
using test::Outcome;
using test::read_text;
using test::TemporaryFolder;
using testing::HasSubstr;

Outcome ciliaval(const fs::path& folder, const std::string& arguments) {
  return test::run_program(folder, arguments);
}

void write_case(const fs::path& folder, const std::string& force = R"("1 mN")",
                const std::string& options = "") {
  std::ofstream(folder / "one.toml") << test::case_text(
      {.name = "one", .force = force},
      "mechanics = [\"elastica\", \"beam\"]\nfields = [\"line\", \"volume\"]\n" + options);
}

void replace(const fs::path& file, const std::string& pattern, const std::string& by) {
  const std::string text = std::regex_replace(read_text(file), std::regex(pattern), by,
                                              std::regex_constants::format_first_only);
  ASSERT_NE(text, read_text(file));
  std::ofstream(file) << text;
}

/// A case with its accepted baseline.
void accept(const fs::path& folder) {
  write_case(folder);
  ASSERT_EQ(ciliaval(folder, "check --accept one.toml").code, 0);
  fs::rename(folder / "one.baseline.candidate.json", folder / "one.baseline.json");
}

TEST(CheckCommand, PassesOnWhatWasAcceptedAndWritesBothReports) {
  const TemporaryFolder folder;
  accept(folder.path());
  const Outcome outcome =
      ciliaval(folder.path(), "check one.toml --junit report.xml --json report.json --quiet");
  EXPECT_EQ(outcome.code, 0) << outcome.out << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("Passed: 1 cases"));
  EXPECT_TRUE(nlohmann::json::parse(read_text(folder.path() / "report.json"))["passed"]);
  EXPECT_THAT(read_text(folder.path() / "report.xml"), HasSubstr("<testsuite name=\"one\""));
  EXPECT_EQ(outcome.err, "");
}

TEST(CheckCommand, AChangedResultIsExitCode1AndNamed) {
  const TemporaryFolder folder;
  accept(folder.path());
  replace(folder.path() / "one.baseline.json", R"(/beam/tip/x","unit":"m","value":0\.00)",
          "/beam/tip/x\",\"unit\":\"m\",\"value\":0.01");
  const Outcome outcome = ciliaval(folder.path(), "check one.toml --json report.json");
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.out, HasSubstr("steps/0/mechanics/beam/tip/x (baseline): is 0.00"));
  EXPECT_THAT(outcome.out, HasSubstr("FAILED: 1 cases"));
  EXPECT_FALSE(nlohmann::json::parse(read_text(folder.path() / "report.json"))["passed"]);
}

TEST(CheckCommand, AModelThatDoesNotConvergeIsExitCode3) {
  const TemporaryFolder folder;
  write_case(folder.path(), R"("1 mN")", "[models.beam]\nmax_iterations = 50\n");
  ASSERT_EQ(ciliaval(folder.path(), "check --accept one.toml").code, 0);
  fs::rename(folder.path() / "one.baseline.candidate.json", folder.path() / "one.baseline.json");
  // Good old results in the way must not be taken for the new ones.
  ASSERT_EQ(ciliaval(folder.path(), "run one.toml").code, 0);
  write_case(folder.path(), R"("1 mN")", "[models.beam]\nmax_iterations = 1\n");
  const Outcome outcome = ciliaval(folder.path(), "check one.toml");
  EXPECT_EQ(outcome.code, 3) << outcome.out << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("is \"failed\", not \"converged\""));
  EXPECT_THAT(outcome.out, HasSubstr("another version of the case"));
  EXPECT_EQ(ciliaval(folder.path(), "check --accept one.toml").code, 3);
  EXPECT_FALSE(fs::exists(folder.path() / "one.baseline.candidate.json"));
}

TEST(CheckCommand, WhatCannotBeCheckedIsRefusedBeforeAnythingRuns) {
  const TemporaryFolder folder;
  write_case(folder.path());
  const Outcome missing = ciliaval(folder.path(), "check one.toml");
  EXPECT_EQ(missing.code, 2);
  EXPECT_THAT(missing.err, HasSubstr("has no baseline `one.baseline.json`"));
  EXPECT_THAT(missing.err, HasSubstr("--accept"));
  EXPECT_EQ(ciliaval(folder.path(), "check none.toml").code, 2);
  accept(folder.path());
  replace(folder.path() / "one.baseline.json", "\"relative\"", "\"relativ\"");
  const Outcome misspelt = ciliaval(folder.path(), "check one.toml");
  EXPECT_EQ(misspelt.code, 2);
  EXPECT_THAT(misspelt.err, HasSubstr("`relative` is missing"));
  EXPECT_EQ(ciliaval(folder.path(), "check --quick --accept one.toml").code, 2);
}

// Reading a FIFO would wait for a writer for ever; values nested too deep end in a stack overflow.
TEST(CheckCommand, ABaselineThatIsNoPlainFileIsRefused) {
  const TemporaryFolder folder;
  write_case(folder.path());
  const fs::path baseline = folder.path() / "one.baseline.json";
  ASSERT_EQ(mkfifo(baseline.c_str(), 0600), 0);
  const Outcome fifo = ciliaval(folder.path(), "check one.toml");
  EXPECT_EQ(fifo.code, 2);
  EXPECT_THAT(fifo.err, HasSubstr("one.baseline.json: is not a regular file"));
  fs::remove(baseline);
  std::ofstream(baseline) << std::string(100000, '[') << std::string(100000, ']');
  const Outcome deep = ciliaval(folder.path(), "check one.toml");
  EXPECT_EQ(deep.code, 2);
  EXPECT_THAT(deep.err, HasSubstr("one.baseline.json: nested more than 100 deep"));
}

// Without a solid nothing is left out; with nothing but a solid there is nothing left to compare.
TEST(CheckCommand, QuickLeavesOutTheSolidAndSaysSo) {
  const TemporaryFolder folder;
  accept(folder.path());
  EXPECT_THAT(ciliaval(folder.path(), "check --quick one.toml").out, HasSubstr("Passed"));
  std::ofstream(folder.path() / "solid.toml")
      << test::case_text({.name = "solid", .magnet_length = "3 mm", .height = "4.5 mm"},
                         "mechanics = [\"elastica\", \"solid\"]\n[models.solid]\nrefinement = 0\n");
  ASSERT_EQ(ciliaval(folder.path(), "check --accept solid.toml").code, 0);
  fs::rename(folder.path() / "solid.baseline.candidate.json",
             folder.path() / "solid.baseline.json");
  const Outcome quick = ciliaval(folder.path(), "check --quick solid.toml");
  EXPECT_EQ(quick.code, 0) << quick.out;
  EXPECT_THAT(quick.out, testing::ContainsRegex("[0-9]+ entries of models that were left out"));
  replace(folder.path() / "solid.toml", R"("elastica", "solid")", "\"solid\"");
  std::string baseline = read_text(folder.path() / "solid.baseline.json");
  baseline = std::regex_replace(baseline, std::regex(R"(\n[^\n]*/elastica/[^\n]*)"), "");
  baseline = std::regex_replace(baseline, std::regex(R"(\\"elastica\\", )"), "");
  std::ofstream(folder.path() / "solid.baseline.json") << baseline;
  const Outcome nothing = ciliaval(folder.path(), "check --quick solid.toml");
  EXPECT_EQ(nothing.code, 5) << nothing.out << nothing.err;
  EXPECT_THAT(nothing.out, HasSubstr("no number was compared"));
}

TEST(CheckCommand, AcceptTouchesNoBaselineAndListsOldAndNew) {
  const TemporaryFolder folder;
  accept(folder.path());
  const std::string before = read_text(folder.path() / "one.baseline.json");
  EXPECT_THAT(ciliaval(folder.path(), "check --accept one.toml").out,
              HasSubstr("nothing to accept"));
  EXPECT_FALSE(fs::exists(folder.path() / "one.baseline.candidate.json"));
  write_case(folder.path(), R"("1.1 mN")");
  const Outcome outcome = ciliaval(folder.path(), "check --accept one.toml");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.out,
              testing::ContainsRegex("steps/0/mechanics/beam/tip/x: 0.00[0-9]+ -> 0.00[0-9]+"));
  EXPECT_THAT(outcome.out, HasSubstr("mv 'one.baseline.candidate.json' 'one.baseline.json'"));
  EXPECT_EQ(read_text(folder.path() / "one.baseline.json"), before);
  const auto candidate =
      nlohmann::json::parse(read_text(folder.path() / "one.baseline.candidate.json"));
  EXPECT_GT(candidate["changes"].size(), 20u);
}

// A report that cannot be written is exit code 4, and leaves what was there.
TEST(CheckCommand, AReportThatCannotBeWrittenIsExitCode4) {
  const TemporaryFolder folder;
  accept(folder.path());
  const Outcome outcome = ciliaval(folder.path(), "check one.toml --json none/report.json");
  EXPECT_EQ(outcome.code, 4);
  EXPECT_THAT(outcome.err, HasSubstr("none/report.json"));
  const Outcome full = ciliaval(folder.path(), "check one.toml --json /dev/full");
  EXPECT_EQ(full.code, 4);
  EXPECT_THAT(full.out, HasSubstr("Passed: 1 cases"));  // the table stays
}

// The shipped cases without the solid.
TEST(CheckCommand, TheShippedCasesAreAsAcceptedQuick) {
  const TemporaryFolder folder;
  const Outcome outcome = ciliaval(folder.path(), "check --quick");
  EXPECT_EQ(outcome.code, 0) << outcome.out << outcome.err;
}

// All of them: README says how to call it.
TEST(CheckCommandSlow, TheShippedCasesAreAsAccepted) {
  const TemporaryFolder folder;
  const Outcome outcome = ciliaval(folder.path(), "check");
  EXPECT_EQ(outcome.code, 0) << outcome.out << outcome.err;
}

}  // namespace
}  // namespace ciliaval
