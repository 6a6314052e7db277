// SPDX-License-Identifier: LGPL-2.1-or-later
// `ciliaval study` as a user calls it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/program.h"
#include "tests/support/study_texts.h"

namespace ciliaval {
namespace {

namespace fs = std::filesystem;
using test::modulus_range;
using test::Outcome;
using test::read_text;
using test::run_program;
using test::study_text;
using test::TemporaryFolder;
using testing::HasSubstr;
using testing::StartsWith;

const std::string line = "pairs = [\"elastica/line\"]\n";

// Oracle: `ciliaval run` of the case with the same modulus.
TEST(StudyCommand, ItsNumbersAreThoseOfRun) {
  const TemporaryFolder folder;
  test::write_study_case(folder.path());
  test::write_study(folder.path(),
                    study_text("pairs = [\"elastica/line\", \"beam/volume\"]\n", modulus_range));
  const Outcome study =
      run_program(folder.path(), "study varied.study.toml -o out --json again.json --quiet");
  ASSERT_EQ(study.code, 0) << study.err;
  EXPECT_EQ(study.err, "");
  EXPECT_THAT(study.out, HasSubstr("E1(MPa)"));
  const fs::path out = folder.path() / "out/varied";
  for (const char* name : {"study.csv", "dB_x.svg", "dB_y.svg", "dB_z.svg", "dB_norm.svg"})
    EXPECT_TRUE(fs::exists(out / name)) << name;
  EXPECT_EQ(read_text(out / "study.json"), read_text(folder.path() / "again.json"));
  const auto points = nlohmann::json::parse(read_text(out / "study.json"))["points"];
  ASSERT_EQ(points.size(), 5u);
  // The first point is the case itself, E1 = 0.1 MPa.
  test::write_study_case(folder.path(), "\"1 mN\"",
                         "mechanics = [\"elastica\", \"beam\"]\nfields = [\"line\", \"volume\"]\n");
  ASSERT_EQ(run_program(folder.path(), "run one.toml").code, 0);
  const auto fields = nlohmann::json::parse(
      read_text(folder.path() / "results/one/summary.json"))["steps"][0]["fields"];
  for (const std::string pair : {"elastica/line", "beam/volume"}) {
    const auto& dB = fields[pair]["dB"][0];
    const auto& of_study = points[0]["pairs"][pair];
    EXPECT_EQ(of_study["status"], "converged");
    EXPECT_EQ(of_study["dB_x"].get<double>(), dB[0].get<double>());
    EXPECT_EQ(of_study["dB_y"].get<double>(), dB[1].get<double>());
    EXPECT_EQ(of_study["dB_z"].get<double>(), dB[2].get<double>());
    EXPECT_DOUBLE_EQ(of_study["dB_norm"].get<double>(),
                     std::hypot(dB[0].get<double>(), dB[1].get<double>(), dB[2].get<double>()));
  }
}

// The first file that a program opens gets the number of a closed standard stream.
TEST(StudyCommand, AClosedStdoutDoesNotBecomeTheStore) {
  const TemporaryFolder folder;
  test::write_study_case(folder.path());
  test::write_study(folder.path(), study_text(line, modulus_range));
  const std::string closed = "cd '" + folder.path().string() +
                             "' && '" CILIAVAL_PROGRAM "' study varied.study.toml >&- 2>err.txt";
  ASSERT_EQ(std::system(closed.c_str()), 0) << read_text(folder.path() / "err.txt");
  for (const auto& entry : fs::directory_iterator(folder.path() / "results/varied"))
    EXPECT_THAT(read_text(entry.path()), testing::Not(HasSubstr("Study \"varied\"")))
        << entry.path();
  const Outcome second = run_program(folder.path(), "study varied.study.toml");
  EXPECT_EQ(second.code, 0) << second.err;
  EXPECT_THAT(second.err, HasSubstr("5 of 5 solutions are there already"));
}

TEST(StudyCommand, AnotherStudyInTheFolderIsRefusedAndLeftAsItIs) {
  const TemporaryFolder folder;
  test::write_study_case(folder.path());
  test::write_study(folder.path(), study_text(line, modulus_range));
  ASSERT_EQ(run_program(folder.path(), "study varied.study.toml").code, 0);
  const fs::path store = folder.path() / "results/varied/points.sqlite";
  const std::string before = read_text(store);
  std::string longer = modulus_range;
  longer.replace(longer.find("= 5"), 3, "= 6");
  test::write_study(folder.path(), study_text(line, longer));
  const Outcome other = run_program(folder.path(), "study varied.study.toml");
  EXPECT_EQ(other.code, 4);
  EXPECT_THAT(other.err, HasSubstr("it holds results of something else: parameter 1 was "));
  EXPECT_THAT(other.err, HasSubstr("--fresh"));
  EXPECT_EQ(read_text(store), before);
  EXPECT_EQ(run_program(folder.path(), "study varied.study.toml --fresh").code, 0);
  // The case belongs to the study.
  test::write_study_case(folder.path(), "\"1.1 mN\"");
  const Outcome changed = run_program(folder.path(), "study varied.study.toml");
  EXPECT_EQ(changed.code, 4);
  EXPECT_THAT(changed.err, HasSubstr("0.001"));
  // So does what is no study at all.
  fs::create_directories(folder.path() / "taken/varied");
  std::ofstream(folder.path() / "taken/varied/thesis.txt") << "all of it";
  const Outcome taken = run_program(folder.path(), "study varied.study.toml -o taken --fresh");
  EXPECT_EQ(taken.code, 4);
  EXPECT_THAT(taken.err, HasSubstr("is not the folder of a study"));
}

// The folder behind a link may be anybody's, even if it holds a store; nothing in it is changed.
TEST(StudyCommand, ALinkInPlaceOfTheFolderIsRefusedAndLeftAsItIs) {
  const TemporaryFolder folder;
  test::write_study_case(folder.path());
  test::write_study(folder.path(), study_text(line, modulus_range));
  ASSERT_EQ(run_program(folder.path(), "study varied.study.toml -o other").code, 0);
  fs::create_directories(folder.path() / "results");
  fs::create_symlink(folder.path() / "other/varied", folder.path() / "results/varied");
  const fs::path store = folder.path() / "other/varied/points.sqlite";
  const std::string before = read_text(store);
  for (const char* fresh : {"", " --fresh"}) {
    const Outcome linked =
        run_program(folder.path(), std::string("study varied.study.toml") + fresh);
    EXPECT_EQ(linked.code, 4);
    EXPECT_THAT(linked.err, HasSubstr("results/varied` is a link to"));
    EXPECT_EQ(read_text(store), before);
  }
}

TEST(StudyCommand, APointThatSlipsOffIsAResultAndOneThatFailsIsRecorded) {
  const TemporaryFolder folder;
  test::write_study_case(folder.path());
  const std::string forces =
      "[[parameter]]\npath = \"load.force\"\nvalues = [\"1e-9 mN\", \"2 mN\", \"9 mN\"]\n";
  test::write_study(folder.path(),
                    study_text("pairs = [\"elastica/line\", \"beam/line\"]\n", forces));
  // One Newton iteration is too few for the beam at 2 mN, not at 1 nN.
  test::write_study_case(folder.path(), "\"1 mN\"",
                         "mechanics = [\"beam\"]\n[models.beam]\nmax_iterations = "
                         "2\nmax_cutbacks = 0\n");
  const Outcome study = run_program(folder.path(), "study varied.study.toml");
  EXPECT_EQ(study.code, 0) << study.err;
  const auto points =
      nlohmann::json::parse(read_text(folder.path() / "results/varied/study.json"))["points"];
  EXPECT_EQ(points[0]["pairs"]["beam/line"]["status"], "converged");
  EXPECT_EQ(points[1]["pairs"]["beam/line"]["status"], "failed");
  EXPECT_TRUE(points[1]["pairs"]["beam/line"]["dB_x"].is_null());
  EXPECT_NE(points[1]["pairs"]["beam/line"]["message"], "");
  EXPECT_EQ(points[1]["pairs"]["elastica/line"]["status"], "converged");
  EXPECT_EQ(points[2]["pairs"]["elastica/line"]["status"], "slipped_off");
  EXPECT_THAT(study.out, HasSubstr("beam/line: failed at"));
  EXPECT_THAT(study.out, HasSubstr("elastica/line: slipped_off at 1 of 3 points"));
}

TEST(StudyCommand, WhatCannotBeDoneHasItsExitCodeAndMessage) {
  const TemporaryFolder folder;
  test::write_study_case(folder.path());
  test::write_study(folder.path(), study_text(line, modulus_range));
  const auto fails = [&](const std::string& arguments, int code, const std::string& words,
                         const std::string& environment = "") {
    const Outcome outcome = run_program(folder.path(), arguments, environment);
    EXPECT_EQ(outcome.code, code) << arguments;
    EXPECT_THAT(outcome.err, HasSubstr(words)) << arguments;
  };
  fails("study", 2, "STUDY");
  fails("study none.toml", 2, "none.toml");
  fails("study one.toml", 2, "is a case, not a study: `ciliaval run");
  fails("run varied.study.toml", 2, "`ciliaval study` runs it");
  fails("study varied.study.toml -o one.toml", 4, "one.toml");
  fails("study varied.study.toml --json none/x.json", 4, "none/x.json");
  fails("study varied.study.toml", 4, "cannot start Python `none`", "CILIAVAL_PYTHON=none ");
  fails("study varied.study.toml --json /dev/full", 4, "/dev/full");
  EXPECT_THAT(read_text(folder.path() / "out.txt"), HasSubstr("Results: results/varied"));
  const std::string full = "cd '" + folder.path().string() +
                           "' && '" CILIAVAL_PROGRAM
                           "' study varied.study.toml >/dev/full 2>err.txt";
  EXPECT_EQ(WEXITSTATUS(std::system(full.c_str())), 4);
  std::ofstream(folder.path() / "bad.study.toml") << study_text(line + "x = 1\n", modulus_range);
  fails("study bad.study.toml", 2, "bad.study.toml:5:1: unknown key 'x'");
  EXPECT_FALSE(fs::exists(folder.path() / "results/bad"));
  const Outcome valid = run_program(folder.path(), "validate varied.study.toml one.toml");
  EXPECT_EQ(valid.code, 0) << valid.err;
  EXPECT_THAT(valid.out, HasSubstr("study \"varied\" is valid: 5 points"));
  EXPECT_THAT(valid.out, HasSubstr("case \"one\" is valid"));
  fails("validate bad.study.toml", 2, "bad.study.toml:5:1");
}

TEST(StudyCommand, HelpTeachesAndListShowsTheShippedOnes) {
  const TemporaryFolder folder;
  const Outcome help = run_program(folder.path(), "study --help");
  EXPECT_EQ(help.code, 0);
  EXPECT_THAT(help.out, HasSubstr("[[parameter]]"));
  EXPECT_THAT(help.out, HasSubstr("--fresh"));
  const Outcome list = run_program(folder.path(), "list");
  for (const char* word :
       {"paper/fig4a-e1.study.toml", "paper/fig4a-e2.study.toml", "paper/fig4b.study.toml",
        "paper/fig4c.study.toml", "paper/optimum.study.toml", "(Fig. 4c)"})
    EXPECT_THAT(list.out, HasSubstr(word));
}

}  // namespace
}  // namespace ciliaval
