// SPDX-License-Identifier: LGPL-2.1-or-later
#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <tuple>
#include <utility>

#include "problem/load.h"
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

/// A case that the rods solve in a moment.
fs::path write_case(const fs::path& folder, const std::string& name, const std::string& models) {
  fs::path file = folder / (name + ".toml");
  std::ofstream(file) << test::case_text({.name = name, .force = R"(["1 mN", "9 mN"])"}, models);
  return file;
}

constexpr const char* rods =
    "mechanics = [\"elastica\", \"beam\"]\nfields = [\"line\", \"volume\"]\n";

TEST(CommandLine, WrongUsageIsExitCode2) {
  const TemporaryFolder folder;
  for (const char* arguments :
       {"", "cross", "run", "run none.toml", "run --colour", "validate", "validate none.toml",
        "list everything", "mesh", "mesh none.toml -o x.msh"}) {
    const Outcome outcome = ciliaval(folder.path(), arguments);
    EXPECT_EQ(outcome.code, 2) << arguments;
    EXPECT_EQ(outcome.out, "") << arguments;
    EXPECT_NE(outcome.err, "") << arguments;
  }
}

TEST(CommandLine, HelpTeachesByExample) {
  const TemporaryFolder folder;
  const Outcome help = ciliaval(folder.path(), "--help");
  EXPECT_EQ(help.code, 0);
  EXPECT_THAT(help.out, HasSubstr("ciliaval run my.toml"));
  EXPECT_THAT(help.out, HasSubstr("Exit codes"));
  EXPECT_EQ(ciliaval(folder.path(), "help").out, help.out);
  const Outcome of_run = ciliaval(folder.path(), "run --help");
  EXPECT_EQ(of_run.code, 0);
  EXPECT_THAT(of_run.out, Not(HasSubstr("ciliaval budget")));  // its own alone
  EXPECT_EQ(ciliaval(folder.path(), "help run").out, of_run.out);
  EXPECT_THAT(ciliaval(folder.path(), "help rnu").err, HasSubstr("there is no command `rnu`"));
  const Outcome version = ciliaval(folder.path(), "--version");
  EXPECT_EQ(version.code, 0);
  EXPECT_THAT(version.out, HasSubstr("ciliaval "));
}

TEST(CommandLine, ListsModelsLoadsAndShippedCases) {
  const TemporaryFolder folder;
  const Outcome list = ciliaval(folder.path(), "list");
  EXPECT_EQ(list.code, 0);
  for (const char* word : {"elastica", "beam", "solid", "dipole", "line", "volume", "mesh",
                           "contact", "flow", "probe", "paper/fig3b.toml"})
    EXPECT_THAT(list.out, HasSubstr(word));
  EXPECT_EQ(ciliaval(folder.path(), "validate paper/fig3b.toml").code, 0);  // as it is listed
}

TEST(CommandLine, ValidatesWithoutRunning) {
  const TemporaryFolder folder;
  write_case(folder.path(), "good", rods);
  write_case(folder.path(), "bad", "mechanics = [\"elastika\"]\n");
  const Outcome good = ciliaval(folder.path(), "validate good.toml");
  EXPECT_EQ(good.code, 0);
  EXPECT_THAT(good.out, HasSubstr("\"good\" is valid"));
  EXPECT_FALSE(fs::exists(folder.path() / "results"));
  const Outcome bad = ciliaval(folder.path(), "validate good.toml bad.toml");
  EXPECT_EQ(bad.code, 2);
  EXPECT_THAT(bad.err, HasSubstr("bad.toml:"));
}

TEST(CommandLine, KnowsShippedCasesByNameAndSuggestsWhatIsNearAWord) {
  const TemporaryFolder folder;
  EXPECT_THAT(ciliaval(folder.path(), "validate mattiasson").out, HasSubstr("is valid"));
  EXPECT_THAT(ciliaval(folder.path(), "validate fig4c").out, HasSubstr("study"));
  for (const auto& [words, said] : {std::pair{"run fig3bb", "did you mean 'fig3b'?"},
                                    {"run --fersh fig3b", "did you mean '--fresh'?"},
                                    {"rnu fig3b", "did you mean 'run'?"},
                                    {"budget fig3b --jsn=x", "did you mean '--json'?"}}) {
    const Outcome wrong = ciliaval(folder.path(), words);
    EXPECT_EQ(wrong.code, 2) << words;
    EXPECT_THAT(wrong.err, HasSubstr(said)) << words;
  }
}

// 9 mN is more than the paper's cilium bears (5.862 mN by the paper's model): a result, exit code
// 0.
TEST(CommandLine, RunsACaseAndWritesItsResults) {
  const TemporaryFolder folder;
  write_case(folder.path(), "quick", rods);
  const Outcome run = ciliaval(folder.path(), "run quick.toml -o out --quiet");
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(run.err, "");
  EXPECT_THAT(run.out, HasSubstr("elastica - beam"));
  EXPECT_THAT(run.out, testing::Not(HasSubstr("divided by")));
  EXPECT_THAT(ciliaval(folder.path(), "run quick.toml -o explained --explain").out,
              HasSubstr("divided by"));
  const fs::path results = folder.path() / "out" / "quick";
  const auto summary = nlohmann::json::parse(read_text(results / "summary.json"));
  const auto& steps = summary["steps"];
  EXPECT_EQ(steps[0]["mechanics"]["elastica"]["status"], "converged");
  EXPECT_EQ(steps[1]["mechanics"]["elastica"]["status"], "slipped_off");
  EXPECT_NEAR(steps[1]["mechanics"]["elastica"]["slip_off_force"].get<double>(), 5.862e-3, 0.5e-6);
  EXPECT_TRUE(steps[0]["fields"].contains("beam/volume"));
  EXPECT_THAT(summary["provenance"]["command"].get<std::string>(),
              testing::StrEq("ciliaval run quick.toml -o out --quiet"));
  EXPECT_TRUE(fs::exists(results / "elastica_0000.csv"));
  EXPECT_TRUE(fs::exists(results / "vtk" / "field_beam_volume.pvd"));
  // The case that was run is written back and can be run again.
  EXPECT_EQ(ciliaval(folder.path(), "validate out/quick/case.toml").code, 0);
}

// A brick of 1.2 T at 12 mm leaves no equilibrium: a result, exit code 0, and the path goes on.
TEST(CommandLine, ACiliumThatAMagnetPullsInIsAResult) {
  const TemporaryFolder folder;
  std::string text = test::case_text({.name = "magnet", .sensor = R"(["0 mm", "0 mm", "-2.1 mm"])"},
                                     "mechanics = [\"beam\"]\nfields = [\"line\"]\n");
  const std::size_t load = text.find("[load]");
  text.replace(load, text.find("[sensor]") - load, R"([environment]
[[environment.magnet]]
name = "brick"
shape = "cuboid"
position = ["12 mm", "0 mm", "20 mm"]
axis = [1, 0, 0]
edges = ["6 mm", "4 mm", "5 mm"]
remanence = "1.2 T"
[load]
type = "environment"
scale = [1, 0.02]
)");
  std::ofstream(folder.path() / "magnet.toml") << text;
  const Outcome run = ciliaval(folder.path(), "run magnet.toml --quiet");
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("pulled_in"));
  EXPECT_THAT(run.out, HasSubstr("the magnet 'brick' pulls the cilium in"));
  const auto summary =
      nlohmann::json::parse(read_text(folder.path() / "results" / "magnet" / "summary.json"));
  const auto& beam = summary["steps"][0]["mechanics"]["beam"];
  EXPECT_EQ(beam["status"], "pulled_in");
  EXPECT_TRUE(beam["tip"].is_null());
  const auto& pull_in = beam["pull_in"];
  EXPECT_EQ(pull_in["magnet"], "brick");
  EXPECT_GT(pull_in["fraction"].get<double>(), 0);
  EXPECT_LT(pull_in["fraction"].get<double>(), 1);
  EXPECT_EQ(pull_in["load"], pull_in["fraction"]);
  EXPECT_EQ(pull_in["tip"].size(), 3U);
  EXPECT_LT(std::abs(pull_in["approach"].back()["smallest_eigenvalue"].get<double>()), 1e-2);
  EXPECT_EQ(summary["steps"][1]["mechanics"]["beam"]["status"], "converged");
  EXPECT_TRUE(summary["steps"][1]["fields"].contains("beam/line"));

  std::ofstream(folder.path() / "strength.study.toml") << R"([study]
name = "strength"
case = "magnet.toml"
pairs = ["beam/line"]
[[parameter]]
path = "load.scale"
values = [0.02, 1]
)";
  std::string one_step = read_text(folder.path() / "magnet.toml");
  const std::string path = "[1, 0.02]";
  one_step.replace(one_step.find(path), path.size(), "1");
  std::ofstream(folder.path() / "magnet.toml") << one_step;
  const Outcome study = ciliaval(folder.path(), "study strength.study.toml --quiet");
  EXPECT_EQ(study.code, 0) << study.err;
  EXPECT_THAT(study.out, HasSubstr("beam/line: pulled_in at 1 of 2 points"));
}

// One Newton iteration and no cutback are too few for the beam; the elastica's results are written.
TEST(CommandLine, AModelThatDoesNotConvergeIsExitCode3) {
  const TemporaryFolder folder;
  write_case(folder.path(), "hard",
             std::string(rods) + "[models.beam]\nmax_iterations = 1\nmax_cutbacks = 0\n");
  const Outcome run = ciliaval(folder.path(), "run hard.toml");
  EXPECT_EQ(run.code, 3);
  const auto summary =
      nlohmann::json::parse(read_text(folder.path() / "results" / "hard" / "summary.json"));
  const auto& mechanics = summary["steps"][0]["mechanics"];
  EXPECT_EQ(mechanics["beam"]["status"], "failed");
  EXPECT_THAT(mechanics["beam"]["message"].get<std::string>(), HasSubstr("residual"));
  EXPECT_EQ(mechanics["elastica"]["status"], "converged");
}

/// The case under a section load, which CalculiX takes.
fs::path write_section_case(const fs::path& folder, const std::string& models) {
  std::string text = test::case_text({.name = "referee"}, models);
  for (const auto& [old, with] : {std::pair<std::string, std::string>{"\"contact\"", "\"section\""},
                                  std::pair<std::string, std::string>{"height", "arclength"}})
    text.replace(text.find(old), old.size(), with);
  std::ofstream(folder / "referee.toml") << text;
  return folder / "referee.toml";
}

// Oracle: the contract of a model that cannot run.
TEST(CommandLine, AMissingCalculixFailsAloneWithExitCode3) {
  const TemporaryFolder folder;
  write_section_case(folder.path(),
                     "mechanics = [\"elastica\", \"calculix\"]\nfields = [\"line\"]\n"
                     "[models.calculix]\nprogram = \"./no_ccx\"\n");
  const Outcome run = ciliaval(folder.path(), "run referee.toml -o results");
  EXPECT_EQ(run.code, 3);
  EXPECT_THAT(run.out, HasSubstr("apt-get install calculix-ccx"));
  const auto summary =
      nlohmann::json::parse(read_text(folder.path() / "results" / "referee" / "summary.json"));
  const auto& step = summary.at("steps").at(0);
  EXPECT_EQ(step.at("mechanics").at("calculix").at("status"), "failed");
  EXPECT_EQ(step.at("mechanics").at("elastica").at("status"), "converged");
  EXPECT_TRUE(step.at("fields").contains("elastica/line"));
}

// The files of a run are taken back as an external model, through the files alone.
TEST(CommandLine, TakesItsOwnCentrelineForAnExternalModel) {
  const TemporaryFolder folder;
  const std::string models = "mechanics = [\"elastica\"]\nfields = [\"line\"]\n";
  write_section_case(folder.path(), models);
  ASSERT_EQ(ciliaval(folder.path(), "run referee.toml -o own").code, 0);
  write_section_case(folder.path(), models +
                                        "[[models.external]]\nname = \"bench\"\ncentrelines = "
                                        "[\"own/referee/elastica_0000.csv\"]\n");
  const Outcome run = ciliaval(folder.path(), "run referee.toml -o again");
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("elastica - bench"));
  EXPECT_THAT(run.out, HasSubstr("bench/line"));
  EXPECT_TRUE(fs::exists(folder.path() / "again" / "referee" / "bench_0000.csv"));
  // The external model's files belong to the results and are replaced; its inputs are not.
  EXPECT_EQ(ciliaval(folder.path(), "run referee.toml -o again").code, 0);
  const std::string centreline = read_text(folder.path() / "own/referee/elastica_0000.csv");
  const Outcome onto_input = ciliaval(folder.path(), "run referee.toml -o own");
  EXPECT_EQ(onto_input.code, 2);
  EXPECT_THAT(onto_input.err, HasSubstr("own/referee/elastica_0000.csv"));
  EXPECT_EQ(read_text(folder.path() / "own/referee/elastica_0000.csv"), centreline);
  std::ofstream(folder.path() / "own" / "referee" / "elastica_0000.csv", std::ios::app) << "1,2\n";
  const Outcome damaged = ciliaval(folder.path(), "run referee.toml -o third");
  EXPECT_EQ(damaged.code, 2);
  EXPECT_THAT(damaged.err, HasSubstr("the row has 2 cells and the header 6"));
  EXPECT_FALSE(fs::exists(folder.path() / "third"));
}

// `script` gives the program a terminal. The solid's coarse mesh takes longer than the 2 s after
// which progress shows.
TEST(CommandLineSlow, ShowsProgressOnATerminal) {
  const TemporaryFolder folder;
  write_case(folder.path(), "long", "mechanics = [\"solid\"]\n[models.solid]\nrefinement = 0\n");
  const std::string command = "cd '" + folder.path().string() + "' && script -qec \"'" +
                              CILIAVAL_PROGRAM +
                              "' run long.toml >stdout.txt\" terminal.txt >/dev/null";
  EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 0);
  EXPECT_THAT(read_text(folder.path() / "terminal.txt"), HasSubstr("solid: "));
  EXPECT_THAT(read_text(folder.path() / "stdout.txt"), testing::Not(HasSubstr("\r")));
  // Where the table goes to the terminal too, the progress line is taken off before it.
  const std::string both = "cd '" + folder.path().string() + "' && script -qec \"'" +
                           CILIAVAL_PROGRAM + "' run long.toml\" both.txt >/dev/null";
  EXPECT_EQ(WEXITSTATUS(std::system(both.c_str())), 0);
  const std::string shown = read_text(folder.path() / "both.txt");
  ASSERT_THAT(shown, HasSubstr("solid: "));
  EXPECT_THAT(shown, testing::ContainsRegex("(\n|\r\033\\[K)long: A test\r\n"));
}

// Each step takes some seconds. Oracle: the tip of the summary.
TEST(CommandLineSlow, TellsEachStepWhereThereIsNoTerminalUnlessItIsToBeQuiet) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "long.toml")
      << test::case_text({.name = "long", .force = R"(["1 mN", "2 mN"])"},
                         "mechanics = [\"solid\"]\n[models.solid]\nrefinement = 2\n");
  const Outcome run = ciliaval(folder.path(), "run long.toml");
  EXPECT_EQ(run.code, 0);
  const auto summary =
      nlohmann::json::parse(read_text(folder.path() / "results" / "long" / "summary.json"));
  for (const std::size_t step : {0U, 1U}) {
    const double z = summary["steps"][step]["mechanics"]["solid"]["tip"][2];
    EXPECT_THAT(run.err,
                testing::ContainsRegex(fmt::format(
                    "solid: step {0}/2: contact, force {0} mN at height 16 mm, .*{1:.4f}\\) mm",
                    step + 1, 1e3 * z)));
  }
  EXPECT_THAT(run.err, testing::ContainsRegex("\\(50 %, [0-9]+ s, about [0-9]+ s to go\\)"));
  EXPECT_THAT(run.err, testing::ContainsRegex("\\(100 %, [0-9]+ s\\)"));
  EXPECT_THAT(run.err, testing::Not(HasSubstr("\r")));
  EXPECT_EQ(ciliaval(folder.path(), "--quiet run long.toml").err, "");
}

// https://no-color.org
TEST(CommandLine, ColoursMessagesOnATerminalOnly) {
  const TemporaryFolder folder;
  const auto on_a_terminal = [&](const std::string& environment) {
    const std::string command = "cd '" + folder.path().string() + "' && " + environment +
                                " script -qec \"'" CILIAVAL_PROGRAM
                                "' rum\" terminal.txt >/dev/null";
    EXPECT_NE(std::system(command.c_str()), 0);
    return read_text(folder.path() / "terminal.txt");
  };
  EXPECT_THAT(on_a_terminal("NO_COLOR="), HasSubstr("\033[31mciliaval:"));
  EXPECT_THAT(on_a_terminal("NO_COLOR=1"), testing::Not(HasSubstr("\033")));
  EXPECT_THAT(ciliaval(folder.path(), "rum").err, testing::Not(HasSubstr("\033")));
}

// A terminal obeys escape sequences; a file's name may hold one.
TEST(CommandLine, ShowsControlCharactersInPlaceOfSendingThem) {
  const TemporaryFolder folder;
  write_case(folder.path(), "bad", "mechanics = [\"elastika\"]\n");
  fs::rename(folder.path() / "bad.toml", folder.path() / "bad\x1b[2J.toml");
  for (const char* arguments : {R"x(validate "$(printf 'bad\033[2J.toml')")x",
                                R"x(validate "$(printf 'none\033[2J.toml')")x"}) {
    const Outcome outcome = ciliaval(folder.path(), arguments);
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err, HasSubstr("\\x1B[2J.toml"));
    EXPECT_THAT(outcome.err, testing::Not(HasSubstr("\x1b")));
  }
}

// Longer messages than a recursive matcher of the place at their start could bear.
TEST(CommandLine, AMessageMayBeLong) {
  const TemporaryFolder folder;
  write_case(folder.path(), "quick", "mechanics = [\"elastica\"]\n");
  const Outcome outcome =
      ciliaval(folder.path(), "sense quick.toml quick.toml --models " + std::string(60'000, 'x'));
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("xxx"));
}

TEST(CommandLine, NoOutputReplacesAnInput) {
  const TemporaryFolder folder;
  write_case(folder.path(), "quick", "mechanics = [\"elastica\"]\n");
  ASSERT_EQ(ciliaval(folder.path(), "mesh quick.toml -o own.msh --refinement 0").code, 0);
  write_case(folder.path(), "meshed",
             "mechanics = [\"solid\"]\n[models.solid]\nmesh = \"own.msh\"\nmesh_unit = \"1 m\"\n");
  ASSERT_EQ(ciliaval(folder.path(), "check quick.toml --accept").code, 0);
  fs::rename(folder.path() / "quick.baseline.candidate.json",
             folder.path() / "quick.baseline.json");
  for (const auto& [arguments, file] : {
           std::pair("mesh meshed.toml -o own.msh", "own.msh"),
           std::pair("check quick.toml --json quick.baseline.json", "quick.baseline.json"),
           std::pair("budget quick.toml --csv ./quick.toml", "quick.toml"),
           std::pair("converge quick.toml --json quick.toml", "quick.toml"),
       }) {
    const std::string before = read_text(folder.path() / file);
    const Outcome outcome = ciliaval(folder.path(), arguments);
    EXPECT_EQ(outcome.code, 2) << arguments << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(file));
    EXPECT_EQ(outcome.out, "") << arguments;
    EXPECT_EQ(read_text(folder.path() / file), before) << arguments;
  }
}

TEST(CommandLine, FollowsASweepTwiceIntoTheSameFolder) {
  const TemporaryFolder folder;
  std::string text = read_text(fs::path(CILIAVAL_SOURCE_DIR) / "cases/paper/fig6-surface.toml");
  const auto replace = [&](const std::string& part, const std::string& by) {
    ASSERT_NE(text.find(part), std::string::npos) << part;
    text.replace(text.find(part), part.size(), by);
  };
  replace("samples = 521", "samples = 14");
  replace("sampling_rate = \"20 Hz\"", "sampling_rate = \"2 Hz\"");
  std::ofstream(folder.path() / "sweep.toml") << text;
  for (int i = 0; i < 2; ++i) {
    const Outcome outcome = ciliaval(folder.path(), "run sweep.toml");
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("Sweep, 14 samples"));
  }
  for (const char* file : {"sweep.csv", "signal.csv", "vtk/surface.pvd"})
    EXPECT_TRUE(fs::exists(folder.path() / "results/fig6-surface" / file)) << file;
  const Outcome refused = ciliaval(folder.path(), "budget sweep.toml");
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.err, HasSubstr("the case is a sweep"));
}

TEST(CommandLine, RefusesTwoCasesOfOneNameBeforeAnythingRuns) {
  const TemporaryFolder folder;
  write_case(folder.path(), "quick", rods);
  fs::copy_file(folder.path() / "quick.toml", folder.path() / "copy.toml");
  const Outcome run = ciliaval(folder.path(), "run quick.toml copy.toml");
  EXPECT_EQ(run.code, 2);
  EXPECT_THAT(run.err, HasSubstr("both have the name"));
  EXPECT_FALSE(fs::exists(folder.path() / "results"));
}

/// A case is drawn with its two named sensors; what is wrong is said before anything is drawn, and
/// no input is replaced.
TEST(CommandLine, DrawMakesAFigureOfACase) {
  const TemporaryFolder folder;
  const fs::path file = write_case(folder.path(), "rods", rods);
  const Outcome made = ciliaval(folder.path(), "draw rods.toml");
  EXPECT_EQ(made.code, 0) << made.err;
  EXPECT_EQ(made.out, "rods.toml: rods.svg\n");
  EXPECT_THAT(read_text(folder.path() / "rods.svg"), HasSubstr("</svg>"));
  EXPECT_EQ(ciliaval(folder.path(), "draw rods.toml -o rods.png").code, 0);
  EXPECT_THAT(read_text(folder.path() / "rods.png"), testing::StartsWith("\x89PNG"));
  std::ofstream(folder.path() / "wrong.toml") << "[case]\nname = \"wrong\"\n";
  for (const auto& [words, code, said] :
       {std::tuple{"draw wrong.toml", 2, "wrong.toml"},
        {"draw rods.toml -o rods.toml", 2, "ends in .svg, .pdf or .png"},
        {"draw rods.toml -o none/rods.svg", 4, "none"},
        {"draw", 2, "CASE"}}) {
    const Outcome outcome = ciliaval(folder.path(), words);
    EXPECT_EQ(outcome.code, code) << words;
    EXPECT_THAT(outcome.err, HasSubstr(said)) << words;
  }
  EXPECT_FALSE(fs::exists(folder.path() / "wrong.svg"));
  EXPECT_FALSE(fs::exists(folder.path() / "none"));
}

// Oracle: `validate`.
TEST(CommandLine, NewWritesAValidCaseForEachLoad) {
  const TemporaryFolder folder;
  for (const LoadType* load : load_types()) {
    const std::string name(load->name);
    const Outcome made = ciliaval(folder.path(), "new my-" + name + " --load " + name);
    EXPECT_EQ(made.code, 0) << made.err;
    EXPECT_THAT(made.out, HasSubstr("my-" + name + ".toml"));
    EXPECT_THAT(read_text(folder.path() / ("my-" + name + ".toml")),
                HasSubstr("type = \"" + name + "\""));
  }
  const Outcome valid = ciliaval(folder.path(), "validate my-*.toml");
  EXPECT_EQ(valid.code, 0) << valid.err;
  for (const LoadType* load : load_types())
    EXPECT_THAT(valid.out, testing::ContainsRegex("case \"my-" + std::string(load->name) +
                                                  "\" is valid: [^\n]*1 sensor,"));
}

TEST(CommandLine, NewReplacesNothingAndRefusesWhatIsNoCase) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "mine.toml") << "mine";
  for (const auto& [words, said] : {std::pair{"new mine", "mine.toml: there is such a file"},
                                    {"new mine.toml", "there is such a file"},
                                    {"new a --load flwo", "did you mean 'flow'?"},
                                    {"new a.study", "called like a study"},
                                    {"new 'a b'", "plain file name"},
                                    {"new none/a", "none/a.toml"}}) {
    const Outcome outcome = ciliaval(folder.path(), words);
    EXPECT_EQ(outcome.code, std::string(words) == "new none/a" ? 4 : 2) << words;
    EXPECT_THAT(outcome.err, HasSubstr(said)) << words;
  }
  EXPECT_EQ(read_text(folder.path() / "mine.toml"), "mine");
  EXPECT_FALSE(fs::exists(folder.path() / "a.toml"));
}

TEST(CommandLine, AMessageStartsWithItsPlaceOrTheProgramsName) {
  const TemporaryFolder folder;
  write_case(folder.path(), "bad", "mechanics = [\"elastika\"]\n");
  EXPECT_THAT(ciliaval(folder.path(), "validate bad.toml").err,
              testing::ContainsRegex("^bad.toml:[0-9]+:[0-9]+: "));
  const Outcome mistyped = ciliaval(folder.path(), "rum case.toml");
  EXPECT_EQ(mistyped.code, 2);
  EXPECT_THAT(mistyped.err, testing::StartsWith("ciliaval: "));
  EXPECT_THAT(mistyped.err, HasSubstr("`rum`"));
  EXPECT_THAT(mistyped.err, HasSubstr("run, validate, mesh, check, converge, budget, sense, "
                                      "calibrate, study, claims, report, list"));
}

// The shell reads back what the summary says.
TEST(CommandLine, TheRecordedCommandCanBePastedIntoAShell) {
  const TemporaryFolder folder;
  write_case(folder.path(), "quick", "mechanics = [\"elastica\"]\n");
  fs::rename(folder.path() / "quick.toml", folder.path() / "it's a $case.toml");
  const Outcome run = ciliaval(folder.path(), R"("it's a \$case.toml" -o out)");
  EXPECT_EQ(run.code, 2);  // no command
  EXPECT_EQ(ciliaval(folder.path(), R"(run "it's a \$case.toml" -o out)").code, 0);
  const fs::path file = folder.path() / "out" / "quick" / "summary.json";
  const std::string command = nlohmann::json::parse(read_text(file))["provenance"]["command"];
  EXPECT_EQ(command, R"(ciliaval run 'it'\''s a $case.toml' -o out)");
  fs::remove_all(folder.path() / "out");
  EXPECT_EQ(ciliaval(folder.path(), command.substr(std::string("ciliaval ").size())).code, 0);
  EXPECT_TRUE(fs::exists(file));
}

TEST(CommandLine, ReplacesItsOwnResultsButNotWhatTheUserPutBesideThem) {
  const TemporaryFolder folder;
  write_case(folder.path(), "quick", rods);
  EXPECT_EQ(ciliaval(folder.path(), "run quick.toml").code, 0);
  const Outcome again = ciliaval(folder.path(), "run quick.toml");
  EXPECT_EQ(again.code, 0) << again.err;  // every kind of file that it wrote is known to it
  const fs::path notes = folder.path() / "results" / "quick" / "notes.txt";
  std::ofstream(notes) << "mine";
  const Outcome refused = ciliaval(folder.path(), "run quick.toml");
  EXPECT_EQ(refused.code, 4);
  EXPECT_THAT(refused.err, HasSubstr("notes.txt"));
  EXPECT_EQ(refused.out, "");
  EXPECT_EQ(read_text(notes), "mine");
  // The folder that one stands in holds the case file.
  fs::create_directory(folder.path() / "here");
  write_case(folder.path() / "here", "here", rods);
  const Outcome here = ciliaval(folder.path() / "here", "run here.toml -o ..");
  EXPECT_EQ(here.code, 4);
  EXPECT_TRUE(fs::exists(folder.path() / "here" / "here.toml"));
}

TEST(CommandLine, AnOutputThatCannotBeWrittenIsExitCode4) {
  const TemporaryFolder folder;
  write_case(folder.path(), "quick", rods);
  const Outcome run = ciliaval(folder.path(), "run quick.toml -o quick.toml/results");
  EXPECT_EQ(run.code, 4);
  EXPECT_THAT(run.err, HasSubstr("quick.toml/results"));
  for (const std::string arguments : {"list", "--help", "run --help", "--version"}) {
    const std::string full = "cd '" + folder.path().string() + "' && '" CILIAVAL_PROGRAM "' " +
                             arguments + " >/dev/full 2>stderr.txt";
    const int status = std::system(full.c_str());
    EXPECT_EQ(WEXITSTATUS(status), 4) << arguments;
    EXPECT_THAT(read_text(folder.path() / "stderr.txt"), HasSubstr("standard output"));
  }
}

// The mesh that is written is a mesh that a case can name, and comes out of that as it was.
TEST(CommandLine, WritesTheMeshOfACaseAndTakesItBack) {
  const TemporaryFolder folder;
  write_case(folder.path(), "built", "mechanics = [\"solid\"]\n");
  const Outcome written = ciliaval(folder.path(), "mesh built.toml -o cilium.msh --refinement 0");
  EXPECT_EQ(written.code, 0) << written.err;
  EXPECT_THAT(written.out, HasSubstr("Mesh: cilium.msh: "));
  EXPECT_THAT(read_text(folder.path() / "cilium.msh"), HasSubstr("2 1 \"base\""));
  write_case(folder.path(), "own",
             "mechanics = [\"solid\"]\n[models.solid]\nmesh = \"cilium.msh\"\n");
  const Outcome valid = ciliaval(folder.path(), "validate own.toml");
  EXPECT_EQ(valid.code, 0) << valid.err;
  EXPECT_EQ(ciliaval(folder.path(), "mesh own.toml -o again.msh").code, 0);
  const auto lines = [&](const char* name) {
    const std::string text = read_text(folder.path() / name);
    return std::count(text.begin(), text.end(), '\n');
  };
  EXPECT_EQ(lines("again.msh"), lines("cilium.msh"));
  const Outcome vtu = ciliaval(folder.path(), "mesh own.toml -o own.vtu");
  EXPECT_EQ(vtu.code, 0) << vtu.err;
  EXPECT_THAT(read_text(folder.path() / "own.vtu"), HasSubstr("BoundaryIDs"));
  // One that is there is replaced, and nothing else is left.
  EXPECT_EQ(ciliaval(folder.path(), "mesh built.toml -o cilium.msh").code, 0);
  EXPECT_GT(lines("cilium.msh"), lines("again.msh"));
  for (const fs::directory_entry& entry : fs::directory_iterator(folder.path()))
    EXPECT_NE(entry.path().filename().string().front(), '.') << entry.path();
}

TEST(CommandLine, TellsWhyAMeshCannotBeWrittenOrTaken) {
  const TemporaryFolder folder;
  write_case(folder.path(), "built", "mechanics = [\"solid\"]\n");
  const auto fails = [&](const std::string& arguments, int code, const std::string& words) {
    const Outcome outcome = ciliaval(folder.path(), arguments);
    EXPECT_EQ(outcome.code, code) << arguments;
    EXPECT_THAT(outcome.err, HasSubstr(words)) << arguments;
    EXPECT_EQ(outcome.out, "");
  };
  fails("mesh built.toml", 2, "--output");
  fails("mesh built.toml -o cilium.stl", 2, "one of these extensions");
  fails("mesh built.toml -o cilium.msh --refinement 7", 2, "refinements 0 to 3, not 7");
  fails("mesh built.toml -o none/cilium.msh", 4, "No such file");
  fs::create_directory(folder.path() / "taken.vtu");
  fails("mesh built.toml -o taken.vtu", 4, "Is a directory");
  const std::string solid = "mechanics = [\"solid\"]\n[models.solid]\n";
  write_case(folder.path(), "gone", solid + "mesh = \"gone.msh\"\n");
  fails("validate gone.toml", 2, "there is no mesh file '");
  EXPECT_EQ(ciliaval(folder.path(), "mesh built.toml -o metres.msh").code, 0);
  write_case(folder.path(), "unit", solid + "mesh = \"metres.msh\"\nmesh_unit = \"1 mm\"\n");
  fails("run unit.toml", 2, "set mesh_unit = \"1 m\"");
  EXPECT_FALSE(fs::exists(folder.path() / "results" / "unit" / "summary.json"));
  write_case(folder.path(), "own", solid + "mesh = \"metres.msh\"\n");
  fails("mesh own.toml -o x.msh --refinement 1", 2, "leave out --refinement");
}

}  // namespace
}  // namespace ciliaval
