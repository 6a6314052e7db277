// SPDX-License-Identifier: LGPL-2.1-or-later
// `ciliaval report` and the pages of `ciliaval run`, as files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/core.h>

#include <array>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <span>
#include <string>
#include <vector>

#include "compare/plot/gnuplot.h"
#include "compare/report/figures.h"
#include "compare/report/html.h"
#include "compare/report/sections.h"
#include "problem/error.h"
#include "tests/support/results.h"

namespace ciliaval {
namespace {

namespace fs = std::filesystem;
using test::Outcome;
using test::read_text;
using test::run_program;
using testing::HasSubstr;
using testing::Not;

/// A page is too long to be printed.
bool shows(const std::string& page, const std::string& text) {
  return page.find(text) != std::string::npos;
}

void expect_shown(const std::string& page, const std::string& text) {
  EXPECT_TRUE(shows(page, text)) << text;
}

void write(const fs::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

TEST(Html, NothingInATextIsMarkup) {
  using compare::report::escaped;
  EXPECT_EQ(escaped("<a href=\"x\" b='y'>&amp;"),
            "&lt;a href=&quot;x&quot; b=&#39;y&#39;&gt;&amp;amp;");
  EXPECT_EQ(escaped("a\x01\x7f\tb\n"), "a  \tb\n");
  EXPECT_EQ(escaped("\xc3\xa4 \xff"), "\xc3\xa4 \xef\xbf\xbd");
  EXPECT_EQ(compare::report::identifier("fig 3\"b/x"), "fig-3-b-x");
}

// Oracle: study.json.
TEST(Report, ShowsAnOptimumWithItsDesigns) {
  const test::TemporaryFolder folder;
  test::write_study_case(folder.path());
  test::write_study(
      folder.path(),
      test::study_text("pairs = [\"elastica/volume\", \"beam/line\"]\n",
                       "[optimise]\nmaximise = \"dB_norm\"\nat_least.range = \"2 mN\"\n"
                       "global_evaluations = 0\nstarts = 0\n[[parameter]]\n"
                       "path = \"cilium.diameter\"\nfrom = \"1 mm\"\nto = \"5 mm\"\n"));
  ASSERT_EQ(test::run_program(folder.path(), "study varied.study.toml -o results").code, 0);
  ASSERT_EQ(test::run_program(folder.path(), "report results").code, 0);
  const std::string page = read_text(folder.path() / "results/report.html");
  const auto optimum =
      nlohmann::json::parse(read_text(folder.path() / "results/varied/study.json"))["optimum"];
  expect_shown(page, "range: largest load ≥ 2 mN: reached; 1 % less would give ");
  expect_shown(
      page,
      fmt::format("<td>{:.5g}</td>",
                  optimum["designs"][1]["parameters"]["cilium.diameter"].get<double>() * 1e3));
  for (const auto& design : optimum["designs"])
    for (const auto& [pair, result] : design["pairs"].items())
      expect_shown(page, fmt::format("<td>{:.5g}</td>", result["dB_norm"].get<double>() * 1e6));
}

// The largest magnitude has its sign, and the place all parameters.
TEST(Report, NamesTheLargestMagnitudeOfAStudyWithAllParameters) {
  nlohmann::json study = nlohmann::json::parse(R"({"case": "c", "resolved": [], "pairs": ["a/b"],
    "parameters": [{"path": "p", "name": "P", "unit": "", "values": [1, 2]},
                   {"path": "q", "name": "Q", "unit": "m", "values": [0.003, 0.004]}],
    "outputs": [{"id": "dB_x", "unit": "T"}], "points": []})");
  for (int i = 0; i < 4; ++i)
    study["points"].push_back(
        {{"parameters", {{"p", 1 + i / 2}, {"q", 0.003 + 0.001 * (i % 2)}}},
         {"pairs", {{"a/b", {{"status", "converged"}, {"dB_x", i == 1 ? -9e-6 : 1e-6 * i}}}}}});
  compare::report::Figures figures;
  const std::string page = figures.drawn(compare::report::study_content(study, figures));
  expect_shown(page, "Largest magnitude of the points: a/b -9 µT at P = 1, Q = 4 mm.");
}

// gnuplot's own text, and texts that would load or run something.
TEST(Figures, HaveIdsOfTheirOwnAndNothingThatLoadsOrRuns) {
  using compare::report::inlined;
  const std::string svg =
      compare::plot::draw_svg("set title " + compare::plot::quoted("id='gpPt0' href < on") +
                                  "\nplot sin(x) with points pt 6\n",
                              {});
  const std::string first = inlined(svg, "a", "a <title>", {});
  const std::string second = inlined(svg, "b", "", {});
  EXPECT_THAT(first, HasSubstr("<title id=\"a-title\">a &lt;title&gt;</title>"));
  EXPECT_THAT(first, HasSubstr("id='gpPt0' href &lt; on"));  // a text is none of our ids
  EXPECT_THAT(first, HasSubstr(" id='a-gpPt5'"));
  EXPECT_THAT(first, HasSubstr("xlink:href='#a-gpPt5'"));
  EXPECT_THAT(second, HasSubstr(" id='b-gpPt5'"));
  for (const char* planted : {"<script>1</script>", "<image href='x.png'/>", "<g onclick='1'/>",
                              "<use href='http://x/#a'/>", "<style>a{}</style>"}) {
    std::string bad = svg;
    bad.insert(bad.find("</svg>"), planted);
    EXPECT_THROW(inlined(bad, "a", "", {}), FileError) << planted;
  }
  EXPECT_THROW(inlined("<svg></svg>", "a", "", {}), FileError);
}

using compare::plot::Script;

/// Without the colour of pens: a drawing begins with the one that the drawing before ended with.
std::string without_pens(const std::string& svg) {
  return std::regex_replace(svg, std::regex("stroke=\"(currentColor|black)\""), "");
}

// What a script sets or defines is gone for the next one.
TEST(Figures, AreDrawnAtOnceAsEachByItself) {
  const std::array<Script, 3> scripts{{{"set xrange [3:4]\nset logscale y\nset multiplot layout "
                                        "1,2\na = 5\nplot a*x\nplot x**2\nunset multiplot\n",
                                        {400, 300}},
                                       {"plot exists('a') ? 1 : sin(x)\n", {}},
                                       {"$data << EOD\n1 2\n3 4\nEOD\nplot $data\n", {}}}};
  const std::vector<std::string> together = compare::plot::draw_svgs(scripts);
  ASSERT_EQ(together.size(), scripts.size());
  for (std::size_t i = 0; i < scripts.size(); ++i)
    EXPECT_EQ(without_pens(together[i]),
              without_pens(compare::plot::draw_svg(scripts[i].text, scripts[i].size)))
        << i;
}

TEST(Figures, ComeToTheirPlacesAndOneThatCannotBeDrawnSpoilsNoOther) {
  std::vector<std::size_t> drawn;  // how many in each call of gnuplot
  compare::report::Figures figures([&](std::span<const Script> scripts) {
    drawn.push_back(scripts.size());
    return compare::plot::draw_svgs(scripts);
  });
  const std::string sine = figures.add({"sine", "", "plot sin(x)\n", {}});
  const std::string cosine = figures.add({"cosine", "", "plot cos(x)\n", {}});
  const std::string given_up = figures.add({"tangent", "", "plot tan(x)\n", {}});
  EXPECT_EQ(figures.add({"nothing", "", "", {}}), "");
  const std::string page = figures.drawn("<p>1</p>" + cosine + "<p>2</p>" + sine);
  EXPECT_EQ(drawn, std::vector<std::size_t>{3});
  std::size_t at = 0;
  for (const char* part : {"<p>1</p><figure>", ">cosine</title>", "</figure>\n<p>2</p><figure>",
                           ">sine</title>", "</figure>\n"}) {
    at = page.find(part, at);
    ASSERT_NE(at, std::string::npos) << part;
  }
  EXPECT_THAT(page, Not(HasSubstr("tangent")));
  EXPECT_EQ(figures.failure(), "");

  const std::string good = figures.add({"good", "", "plot x\n", {}});
  const std::string bad = figures.add({"bad", "", "plot nonsense(x)\n", {}});
  const std::string mended = figures.drawn(bad + good);
  EXPECT_THAT(mended, HasSubstr("No figure &quot;bad&quot;: cannot plot"));
  EXPECT_THAT(mended, HasSubstr(">good<"));
  EXPECT_THAT(figures.failure(), HasSubstr("nonsense"));
}

// Oracle: the numbers of the result files, formatted here.
TEST(Report, ShowsTheNumbersOfTheFilesOfEveryKind) {
  const test::Results results;
  const std::string page = read_text(results.results() / "report.html");
  const auto summary = nlohmann::json::parse(read_text(results.results() / "one/summary.json"));
  const auto expect = [&](double value) {
    expect_shown(page, (fmt::format("<td>{:.6g}</td>", value)));
  };
  for (const auto& step : summary["steps"])
    for (const auto& [name, field] : step["fields"].items())
      for (const double component : field["dB"][0]) expect(component * 1e6);
  const auto study = nlohmann::json::parse(read_text(results.results() / "varied/study.json"));
  for (const auto& point : study["points"])
    EXPECT_THAT(
        page, HasSubstr(fmt::format("<td>{:.5g}</td>",
                                    point["pairs"]["beam/volume"]["dB_norm"].get<double>() * 1e6)));
  const auto budget = nlohmann::json::parse(read_text(results.results() / "one.budget.json"));
  for (const auto& row : budget["rows"])
    if (row["quantity"] == "dB")
      expect_shown(page, (fmt::format("<td>{:.5g}</td>", row["best"].get<double>() * 1e6)));
  const auto converge = nlohmann::json::parse(read_text(results.results() / "one.converge.json"));
  for (const auto& quantity : converge["studies"][0]["quantities"])
    if (quantity["id"].get<std::string>().find("/tip/") != std::string::npos)
      expect_shown(page, (quantity["id"].get<std::string>()));
  const auto sensed = nlohmann::json::parse(read_text(results.results() / "one.sense.json"));
  expect_shown(page, (fmt::format("<td>{:.5g}</td>",
                                  sensed["samples"][0]["magnitude"].get<double>() * 1e3)));
  expect_shown(page, "a &lt; b &amp; &quot;c&quot;");
  expect_shown(page, "data:image/png;base64,iVBORw0KGgo");
}

// Oracle: the pair's own line in errors.csv.
TEST(Report, TheMatrixOfPairsHasTheirErrorsAndVerdicts) {
  const test::Results results;
  const auto summary = nlohmann::json::parse(read_text(results.results() / "one/summary.json"));
  const std::string page = read_text(results.results() / "one/report.html");
  std::size_t found = 0;
  for (const auto& c : summary["comparisons"])
    if (c["step"] == 1 && c["quantity"] == "dB" && c["component"] == "x") {
      ++found;
      EXPECT_EQ(c["verdict"], "resolved");
      expect_shown(page, (fmt::format(">{:.3g}", 100 * c["relative"].get<double>())));
    }
  EXPECT_EQ(found, 6u);
  // Verdicts that this case does not have.
  auto changed = summary;
  for (auto& c : changed["comparisons"])
    if (c["step"] == 1 && c["quantity"] == "dB" && c["component"] == "x") {
      const bool known = c["model"] == "elastica/line";
      c["verdict"] = known ? "below uncertainty" : "inconclusive";
      c["uncertainty"] = known ? c["scale"] : nlohmann::json();
    }
  write(results.results() / "one/summary.json", changed.dump());
  ASSERT_EQ(run_program(results.folder(), "report results").code, 0);
  const std::string other = read_text(results.results() / "report.html");
  EXPECT_TRUE(std::regex_search(other, std::regex("class=\"faint\">~ [-0-9.e]+ ± 1e\\+02<")));
  EXPECT_TRUE(std::regex_search(other, std::regex("class=\"faint\">[?] [-0-9.e]+<")));
}

TEST(Report, SaysWhichProgramMadeTheResultsAndWhetherItIsOne) {
  const test::Results results;
  const fs::path file = results.results() / "one/summary.json";
  const std::string page = read_text(results.results() / "report.html");
  expect_shown(page, "ciliaval run one.toml -o results</td>");
  expect_shown(page, "ciliaval budget one.toml --without solid");
  expect_shown(page, "ciliaval converge one.toml");
  expect_shown(page, "ciliaval sense one.toml readings.csv");
  auto summary = nlohmann::json::parse(read_text(file));
  expect_shown(page, (summary["provenance"]["date"].get<std::string>()));
  EXPECT_FALSE(shows(page, "different states of the program"));
  summary["provenance"]["git"] = "another0state";
  write(file, summary.dump());
  ASSERT_EQ(run_program(results.folder(), "report results -o other.html").code, 0);
  const std::string other = read_text(results.folder() / "other.html");
  expect_shown(other, "another0state");
  expect_shown(other, "different states of the program");
  EXPECT_EQ(read_text(results.results() / "report.html"), page);
}

TEST(Report, NamesWhatIsNotThereWithItsCommand) {
  const test::Results results;
  for (const char* name : {"claims.json", "one.budget.json"}) fs::remove(results.results() / name);
  fs::remove_all(results.results() / "pictures");
  ASSERT_EQ(run_program(results.folder(), "report results").code, 0);
  const std::string page = read_text(results.results() / "report.html");
  expect_shown(page, "ciliaval claims --json results/claims.json");
  expect_shown(page, "ciliaval budget CASE.toml");
  expect_shown(page, "cases/paper/fig4b.study.toml");
  expect_shown(page, "pvpython");
  EXPECT_FALSE(shows(page, "ciliaval converge CASE.toml"));
}

TEST(Report, AFileThatIsDamagedIsNamedAndTheOthersAreShown) {
  const test::Results results;
  const fs::path folder = results.results();
  const std::string whole = read_text(folder / "one.budget.json");
  const auto fails = [&](const fs::path& file, const std::string& content) {
    SCOPED_TRACE(file);
    const fs::path path = folder / file;
    const std::string before = fs::exists(path) ? read_text(path) : "";
    write(path, content);
    const Outcome outcome = run_program(results.folder(), "report results");
    EXPECT_EQ(outcome.code, 4) << file;
    EXPECT_THAT(outcome.err, HasSubstr("results/" + file.string())) << file;
    const std::string page = read_text(folder / "report.html");
    expect_shown(page, "Files that could not be shown");
    expect_shown(page, "Study varied");
    before.empty() ? static_cast<void>(fs::remove(path)) : write(path, before);
  };
  fails("one.budget.json", whole.substr(0, whole.size() / 2));
  fails("one.budget.json",
        std::regex_replace(whole, std::regex("\"paper\": [^,]*"), "\"paper\": \"x\""));
  fails("one/summary.json", R"({"schema": 1, "case": "one", "steps": 3, "comparisons": []})");
  fails("one.budget.json",
        std::regex_replace(whole, std::regex("\"fmt\": ?\"[^\"]*\""), "\"fmt\": null"));
  fails("one.budget.json",
        std::regex_replace(whole, std::regex("\"schema\""), "\"schema\": 1, \"schema\""));
  fails("deep.json",
        R"({"schema": 1, "claims": )" + std::string(100000, '[') + std::string(100000, ']') + "}");
  fails("one/beam_0001.csv", "S,x,y\n1,2\n");
  fails("notes.json", R"({"mine": true})");
  fails("list.json", "[1, 2]");
  fails("binary.json", std::string("\x00\xff\xfe", 3));
  fails("pictures/cut.png", read_text(folder / "pictures/fig3b.png").substr(0, 5000));
  EXPECT_EQ(run_program(results.folder(), "report results").code, 0);
}

TEST(Report, WithoutGnuplotThereAreTablesAndASentence) {
  const test::Results results;
  const fs::path gone = results.results() / "one";
  fs::remove_all(gone);
  const Outcome run = run_program(results.folder(), "run one.toml -o results", "PATH=/nowhere ");
  EXPECT_EQ(run.code, 0);
  EXPECT_THAT(run.err, HasSubstr("apt-get install gnuplot-nox"));
  const std::string of_case = read_text(gone / "report.html");
  expect_shown(of_case, "apt-get install gnuplot-nox");
  expect_shown(of_case, "Shapes: what each mechanics model found");
  EXPECT_FALSE(shows(of_case, "<svg"));
  const Outcome report = run_program(results.folder(), "report results", "PATH=/nowhere ");
  EXPECT_EQ(report.code, 4);
  EXPECT_THAT(report.err, HasSubstr("apt-get install gnuplot-nox"));
  expect_shown(read_text(results.results() / "report.html"), ("The paper&#39;s claims"));
}

TEST(Report, WhatCannotBeDoneHasItsExitCodeAndMessage) {
  const test::TemporaryFolder folder;
  const auto fails = [&](const std::string& arguments, int code, const std::string& words) {
    const Outcome outcome = run_program(folder.path(), arguments);
    EXPECT_EQ(outcome.code, code) << arguments;
    EXPECT_THAT(outcome.err, HasSubstr(words)) << arguments;
  };
  fails("report", 2, "results");
  fails("report none", 2, "none");
  fs::create_directory(folder.path() / "empty");
  fails("report empty", 4, "there are no results in `empty`");
  write(folder.path() / "empty/claims.json", R"({"schema": 1, "claims": []})");
  fails("report empty -o none/x.html", 4, "none/x.html");
  EXPECT_EQ(run_program(folder.path(), "report empty").code, 0);
}

// What is there stays until the new page is complete.
TEST(Report, ReplacesItsFileAtOnceOrNotAtAll) {
  const test::Results results;
  const fs::path file = results.results() / "report.html";
  const std::string before = read_text(file);
  const std::string limited = "cd '" + results.folder().string() +
                              "' && ulimit -f 40 && trap '' XFSZ && '" CILIAVAL_PROGRAM
                              "' report results >out.txt 2>err.txt";
  EXPECT_EQ(WEXITSTATUS(std::system(("bash -c \"" + limited + "\"").c_str())), 4);
  EXPECT_EQ(read_text(file), before);
}

}  // namespace
}  // namespace ciliaval
