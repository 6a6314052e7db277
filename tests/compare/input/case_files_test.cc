// SPDX-License-Identifier: LGPL-2.1-or-later
// Reports of several faults, and what is wrong with a file as a whole.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "compare/input/case.h"
#include "compare/models/registry.h"
#include "problem/error.h"
#include "tests/support/case_texts.h"
#include "tests/support/temporary_folder.h"

namespace ciliaval::compare {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

/// Every line of the message, without the file's name.
std::vector<std::string> located(std::string_view text) {
  std::vector<std::string> result = lines(faults_of(text));
  for (std::string& line : result) {
    EXPECT_THAT(line, StartsWith("bad.toml:"));
    line.erase(0, std::string_view("bad.toml:").size());
  }
  return result;
}

TEST(BadCaseFiles, AllFaultsAreReportedInTheOrderOfTheFile) {
  std::string text(good_case);
  text = replaced(text, "\"good\"", "\"../good\"");
  text = replaced(text, "[load]", "[laod]");
  text = replaced(text, "diameter = \"3 mm\"", "diameter = 3");
  text = replaced(text, "\"volume\", \"mesh\"", "\"volum\", \"mash\"");
  text = replaced(text, "refinement = 1", "refinement = 1.5");
  EXPECT_THAT(
      located(text),
      testing::ElementsAre(
          StartsWith("1:1: the table [load] is missing"), StartsWith("2:8: the case name"),
          StartsWith("6:12: 'diameter': the number 3 has no unit"),
          StartsWith("21:2: unknown key 'laod' in the case file (valid: case, cilium, load, "
                     "environment, surface, sensor, readings, signal, models, measurement, "
                     "input_uncertainty); did you mean 'load'?"),
          StartsWith("32:29: 'fields' cannot be 'volum'"),
          StartsWith("32:38: 'fields' cannot be 'mash'"),
          StartsWith("35:14: 'refinement' must be a whole number")));
}

TEST(BadCaseFiles, EveryStepOfAPathIsChecked) {
  const std::string text = replaced(good_case, "\"16 mm\"", "[\"21 mm\", \"19 mm\", \"22 mm\"]");
  EXPECT_THAT(located(text), testing::ElementsAre(StartsWith("24:11: the contact height 0.021 m"),
                                                  StartsWith("24:29: the contact height 0.022 m")));
}

TEST(BadCaseFiles, APointAmongCoordinatesIsRefused) {
  const std::string text = replaced(good_case, "\"0.2 mm\"", "[\"0 m\", \"0 m\", \"0 m\"]");
  EXPECT_THAT(located(text), testing::ElementsAre(StartsWith("28:13: 'position' must be a point"),
                                                  StartsWith("28:47: 'position' must be a point")));
}

TEST(BadCaseFiles, AnEmptyFileLacksItsTables) {
  EXPECT_THAT(located(""), testing::ElementsAre("1:1: the table [case] is missing",
                                                "1:1: the table [cilium] is missing",
                                                "1:1: the table [load] is missing",
                                                "1:1: the table [models] is missing"));
  EXPECT_THAT(located("case = 1\ncilium = []\nload = 'x'\nmodels = true\n"),
              testing::ElementsAre("1:8: expected the table [case], found the number 1",
                                   "2:10: expected the table [cilium], found a list",
                                   "3:8: expected the table [load], found the text 'x'",
                                   "4:10: expected the table [models], found true"));
}

TEST(BadCaseFiles, VeryManyFaultsAreCutOff) {
  std::string text(good_case);
  for (int i = 0; i < 1000; ++i) text += "unknown" + std::to_string(i) + " = 1\n";
  const std::vector<std::string> all = lines(faults_of(text));
  EXPECT_EQ(all.size(), 51U);
  EXPECT_EQ(all.back(), "bad.toml: 950 more faults");
}

/// A folder for the files of one test.
class CaseFiles : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, std::string_view text) const {
    return folder_.write(name, text);
  }
  /// Message of read_case() on a file, or "" if it reads it.
  static std::string fault_of(const std::filesystem::path& file) {
    try {
      input::read_case(file, models::known());
    } catch (const InputError& error) {
      return error.what();
    }
    return {};
  }

  test::TemporaryFolder folder_;
};

TEST_F(CaseFiles, AGoodFileIsReadAndAFaultNamesTheFile) {
  EXPECT_EQ(fault_of(write("good.toml", good_case)), "");
  const auto bad = write("bad.toml", replaced(good_case, "diameter =", "diametre ="));
  EXPECT_THAT(fault_of(bad),
              testing::AllOf(StartsWith(bad.string() + ":6:1: unknown key 'diametre'"),
                             testing::EndsWith("did you mean 'diameter'?")));
}

TEST_F(CaseFiles, WhatIsNoReadableFileIsAnInputError) {
  EXPECT_EQ(fault_of(folder_.path() / "none.toml"),
            (folder_.path() / "none.toml").string() + ": the case file does not exist");
  EXPECT_EQ(fault_of(folder_.path()), folder_.path().string() + ": is a folder, not a case file");
  EXPECT_EQ(fault_of("/dev/null"), "/dev/null: is not a regular file");
  EXPECT_THAT(fault_of(""), HasSubstr("the case file does not exist"));
  EXPECT_THAT(fault_of(write("large.toml", std::string(1'000'001, '#'))),
              HasSubstr("1000001 bytes are too large for a case file (at most 1000000)"));
}

TEST_F(CaseFiles, AByteOrderMarkAndDosLineEndsAreRead) {
  EXPECT_EQ(fault_of(write("mark.toml", "\xEF\xBB\xBF" + std::string(good_case))), "");
  std::string dos;
  for (const char c : good_case) dos += c == '\n' ? "\r\n" : std::string(1, c);
  EXPECT_EQ(fault_of(write("dos.toml", dos)), "");
  EXPECT_THAT(fault_of(write("utf16.toml", std::string("\xFF\xFE[\0c\0", 6))),
              HasSubstr("is in UTF-16: save it in UTF-8"));
}

TEST(BadCaseFiles, ADeeplyNestedFileEndsInAMessage) {
  const std::vector<std::pair<std::string, std::string>> shapes{
      {"a.", "a = 1"}, {"\"=\".", "a = 1"}, {"'#'.", "a = 1"}, {"x = [", "1]"}, {"[", "a]"}};
  for (const auto& [part, end] : shapes) {
    std::string text;
    while (text.size() < 900'000) text += part;
    EXPECT_NE(faults_of(text + end), "") << part;
  }
  std::string arrays = "x = ";
  arrays.append(400'000, '[');
  EXPECT_NE(faults_of(arrays), "");
  std::string tables = "x = ";
  while (tables.size() < 900'000) tables += "{a = ";
  EXPECT_NE(faults_of(tables), "");
}

}  // namespace
}  // namespace ciliaval::compare
