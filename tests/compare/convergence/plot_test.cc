// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/convergence/plot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "compare/plot/gnuplot.h"
#include "problem/error.h"
#include "tests/support/synthetic.h"

namespace ciliaval::compare {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(Gnuplot, TextsAreShownLetterByLetter) {
  const std::string svg = plot::draw_svg(
      "set title " + plot::quoted("it's a_b^2 {c} \\n 'd'\n@e ~f") + "\nplot 1\n", {});
  EXPECT_THAT(svg, HasSubstr("it's a_b^2 {c} \\n 'd' @e ~f"));
}

TEST(Gnuplot, AScriptThatIsWrongIsAFileErrorWithGnuplotsMessage) {
  try {
    plot::draw_svg("plot 1\nplot nonsense(x)\n", {});
    FAIL();
  } catch (const FileError& error) {
    EXPECT_THAT(error.what(), HasSubstr("undefined function: nonsense"));
  }
  EXPECT_THROW(plot::draw_svg("set title 'nothing drawn'\n", {}), FileError);
}

// A gnuplot that never ends, first in PATH: it is killed at the limit, and the message says so.
TEST(Gnuplot, OneThatHangsIsEndedWithAnErrorThatSaysSo) {
  const test::TemporaryFolder folder;
  const std::filesystem::path fake = folder.path() / "gnuplot";
  std::ofstream(fake) << "#!/bin/sh\nsleep 300\n";
  std::filesystem::permissions(fake, std::filesystem::perms::owner_all);
  const std::string path = std::getenv("PATH");
  setenv("PATH", (folder.path().string() + ":" + path).c_str(), 1);
  const std::vector<plot::Script> scripts{{"plot 1\n", {}}};
  const auto start = std::chrono::steady_clock::now();
  try {
    plot::draw_svgs(scripts, 0.3);
    ADD_FAILURE() << "a drawing came";
  } catch (const FileError& error) {
    EXPECT_THAT(error.what(), HasSubstr("gnuplot did not end by itself and was killed after 0.3"));
  }
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(60));
  setenv("PATH", path.c_str(), 1);
}

convergence::ConvergedQuantity quantity(const std::string& id,
                                        const std::vector<convergence::RefinementLevel>& levels) {
  return {id, "m", levels, convergence::extrapolate(levels)};
}

/// Two steps; of the second one field is missing on a level, the other is not monotone.
convergence::RefinementStudy study() {
  convergence::RefinementStudy study{"solid", "refinement", "size", {2, 1, 0}, {}, {}, {}};
  const std::vector<convergence::RefinementLevel> second_order{{1, 5 + 1}, {2, 5 + 4}, {4, 5 + 16}};
  study.quantities.push_back(
      quantity("steps/1/fields/solid/mesh/dB/0/norm", {{1, 1.0}, {2, 1.1}, {4, 1.05}}));
  study.quantities.push_back(quantity("steps/1/mechanics/solid/tip/deflection", second_order));
  study.quantities.push_back(quantity("steps/1/mechanics/solid/tip/x", second_order));
  study.quantities.push_back(quantity("steps/1/fields/solid/mesh/dB/1/norm", second_order));
  study.quantities.push_back(quantity("steps/0/mechanics/solid/tip/deflection", second_order));
  study.quantities.push_back({"steps/1/fields/solid/line/dB/0/norm", "T", {{1, 1.0}}, {}});
  return study;
}

// Oracle: f = 5 + h², so that |f − f₀|/|f(1)| = h²/6.
TEST(ConvergencePlot, ShowsTheLastStepsTipAndFieldsWithOrdersOrWhyThereAreNone) {
  const input::Case problem = test::paper_case({1e-3, 2e-3});
  const convergence::ConvergencePlot drawing = convergence::convergence_plot(problem, {study()});
  EXPECT_THAT(drawing.script, HasSubstr("solid, refinement, load step 2 of 2"));
  EXPECT_THAT(drawing.script, HasSubstr("tip: order 2.00"));
  EXPECT_THAT(drawing.script, HasSubstr("\"|dB| solid/mesh: inconclusive: the convergence is not"));
  EXPECT_THAT(drawing.script, Not(HasSubstr("solid/line")));
  const std::size_t tip = drawing.script.find("$points0_1 << EOD\n1 ");
  ASSERT_NE(tip, std::string::npos);
  EXPECT_NEAR(std::stod(drawing.script.substr(tip + 20)), 1.0 / 6, 1e-9);
  const std::string svg = plot::draw_svg(drawing.script, drawing.size);
  EXPECT_THAT(svg, HasSubstr("tip: order 2.00"));
  EXPECT_THAT(svg, HasSubstr("solid/mesh: inconclusive"));
}

TEST(ConvergencePlot, IsEmptyWhereNothingDiffers) {
  const input::Case problem = test::paper_case({1e-3});
  convergence::RefinementStudy still{"beam", "refinement", "size", {2, 1, 0}, {}, {}, {}};
  still.quantities.push_back(
      quantity("steps/0/mechanics/beam/tip/deflection", {{1, 1.0}, {2, 1.0}, {4, 1.0}}));
  EXPECT_EQ(convergence::convergence_plot(problem, {still}).script, "");
  EXPECT_EQ(convergence::convergence_plot(problem, {}).script, "");
}

// The file gives back all that is drawn and listed: written again, it is the same text.
TEST(RefinementStudy, IsReadBackFromItsJsonAndDrawnAlone) {
  convergence::RefinementStudy failed{"beam",    "degree", "2^-degree", {4, 2, 1},
                                      {1, 2, 3}, {},       "it failed"};
  const std::string text = convergence::study_json("case", {study(), failed}, {});
  const std::vector<convergence::RefinementStudy> again =
      convergence::read_studies(nlohmann::ordered_json::parse(text));
  EXPECT_EQ(convergence::study_json("case", again, {}), text);
  const convergence::ConvergencePlot panel = convergence::convergence_panel(again.front());
  EXPECT_THAT(panel.script, HasSubstr("solid, refinement, load step 2 of 2"));
  EXPECT_THAT(panel.script, HasSubstr("tip: order 2.00"));
  EXPECT_THAT(panel.script, Not(HasSubstr("multiplot")));
  EXPECT_THAT(plot::draw_svg(panel.script, panel.size), HasSubstr("tip: order 2.00"));
  EXPECT_EQ(convergence::convergence_panel(failed).script, "");
}

}  // namespace
}  // namespace ciliaval::compare
