// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/study/summary/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "compare/study/reader/study_reader.h"
#include "tests/support/study_texts.h"

namespace ciliaval::compare::study::summary {
namespace {

using test::study_text;
using test::TemporaryFolder;
using testing::HasSubstr;
using testing::Not;

const std::string lengths =
    "[[parameter]]\npath = \"cilium.segment.magnet.proportion\"\nname = \"L2/L0\"\nfrom = "
    "0.1\nto = 0.9\ncount = 17\n";

/// A study of |dB| with values from a function of the first parameter; none where it is NaN.
StudyResult result_of(const std::string& parameters, const std::function<double(double)>& f,
                      const std::string& header =
                          "pairs = [\"elastica/line\"]\noutputs = "
                          "[\"dB_norm\"]\ntitle = \"A title\"\n") {
  const TemporaryFolder folder;
  test::write_study_case(folder.path());
  StudyResult result{
      reader::read_study(test::write_study(folder.path(), study_text(header, parameters))), {}};
  for (std::size_t i = 0; i < result.study.point_count(); ++i) {
    const double value = f(result.study.values_at(i)[0]);
    PairResult r{Status::converged, "", {value}};
    if (std::isnan(value)) r = {Status::slipped_off, "the contact slips off: \"far\", too", {{}}};
    result.points.emplace_back(result.study.pairs.size(), r);
  }
  return result;
}

// Oracle: a parabola, whose peak is known and which the report's own one must meet.
TEST(StudyTrend, FindsThePeakBetweenThePoints) {
  const Trend peak = trend(
      result_of(lengths, [](double x) { return 2e-6 - 1e-6 * (x - 0.6123) * (x - 0.6123); }), 0, 0);
  EXPECT_EQ(peak.kind, Trend::Kind::peak);
  EXPECT_NEAR(peak.extreme_at, 0.6123, 1e-9);
  EXPECT_NEAR(peak.largest, 2e-6, 1e-15);
  const Trend trough =
      trend(result_of(lengths, [](double x) { return 1e-6 * (x - 0.3) * (x - 0.3); }), 0, 0);
  EXPECT_EQ(trough.kind, Trend::Kind::trough);
  EXPECT_NEAR(trough.extreme_at, 0.3, 1e-9);
}

TEST(StudyTrend, TellsMonotoneConstantAndOther) {
  const auto kind = [](const std::function<double(double)>& f) {
    return trend(result_of(lengths, f), 0, 0).kind;
  };
  EXPECT_EQ(kind([](double x) { return x; }), Trend::Kind::rising);
  EXPECT_EQ(kind([](double x) { return -x; }), Trend::Kind::falling);
  EXPECT_EQ(kind([](double) { return 1.0; }), Trend::Kind::constant);
  EXPECT_EQ(kind([](double x) { return std::sin(12 * x); }), Trend::Kind::other);
  EXPECT_EQ(kind([](double x) { return x < 0.85 ? NAN : x; }), Trend::Kind::none);
  const Trend t = trend(result_of(lengths, [](double x) { return x < 0.2 ? NAN : x; }), 0, 0);
  EXPECT_EQ(t.missing, 2u);
  EXPECT_NEAR(t.first, 0.2, 1e-12);
}

// Oracle: y = ln x over two decades has done 95 % of its change at x = 0.1 · 100^0.95.
TEST(StudyTrend, SaysWhereAMonotoneOutputHasSettled) {
  const std::string moduli =
      "[[parameter]]\npath = \"cilium.segment.base.young_modulus\"\nname = \"E1\"\nfrom = \"0.1 "
      "MPa\"\nto = \"10 MPa\"\ncount = 30\nspacing = \"logarithmic\"\n";
  const StudyResult result = result_of(moduli, [](double E) { return std::log(E); });
  const Trend t = trend(result, 0, 0);
  EXPECT_EQ(t.kind, Trend::Kind::rising);
  EXPECT_NEAR(t.settled_at, 1e5 * std::pow(100, 0.95), 1);
}

TEST(StudyReport, CsvHasALineForEachPointAndPairWithUnitsAndQuotes) {
  const StudyResult result = result_of(
      "[[parameter]]\npath = \"cilium.diameter\"\nvalues = [\"3 mm\", \"1 mm\"]\n",
      [](double d) { return d > 0.002 ? 0.1 : NAN; },
      "pairs = [\"elastica/line\", \"beam/line\"]\noutputs = [\"dB_norm\"]\n");
  EXPECT_EQ(csv(result),
            "point,cilium.diameter,pair,status,dB_norm,message\n"
            "# units: cilium.diameter m, dB_norm T\n"
            "0,0.003,elastica/line,converged,0.1,\n"
            "0,0.003,beam/line,converged,0.1,\n"
            "1,0.001,elastica/line,slipped_off,,\"the contact slips off: \"\"far\"\", too\"\n"
            "1,0.001,beam/line,slipped_off,,\"the contact slips off: \"\"far\"\", too\"\n");
}

TEST(StudyReport, JsonGivesBackEveryNumber) {
  const StudyResult result =
      result_of(lengths, [](double x) { return x > 0.85 ? NAN : std::exp(-x) / 3; });
  const auto document =
      nlohmann::json::parse(json(result, {"1", "abc", {}, "the command", "the date"}).dump());
  EXPECT_EQ(document["outputs"][0]["unit"], "T");
  ASSERT_EQ(document["points"].size(), 17u);
  for (std::size_t i = 0; i < 17; ++i) {
    const auto& point = document["points"][i];
    const double x = point["parameters"]["cilium.segment.magnet.proportion"];
    EXPECT_EQ(x, result.study.values_at(i)[0]);
    const auto& pair = point["pairs"]["elastica/line"];
    if (x > 0.85) {
      EXPECT_TRUE(pair["dB_norm"].is_null());
      EXPECT_EQ(pair["status"], "slipped_off");
    } else {
      EXPECT_EQ(pair["dB_norm"].get<double>(), std::exp(-x) / 3);
    }
  }
  // Nothing that differs from call to call.
  EXPECT_THAT(document.dump(),
              Not(testing::AnyOf(HasSubstr("the command"), HasSubstr("the date"))));
}

TEST(StudyReport, TheTableIsThinnedAndTellsWhatSlippedOff) {
  const std::string many =
      "[[parameter]]\npath = \"cilium.diameter\"\nfrom = \"1 mm\"\nto = \"5 mm\"\ncount = 401\n";
  const std::string out = text(result_of(many, [](double d) { return d < 0.00105 ? NAN : d; }));
  EXPECT_LT(std::count(out.begin(), out.end(), '\n'), 40);
  EXPECT_THAT(out, HasSubstr("401 points, 25 of them below, 376 left out"));
  EXPECT_THAT(out, HasSubstr("      1  slipped_off\n"));
  EXPECT_THAT(out, HasSubstr("      5         5000\n"));
  EXPECT_THAT(out, HasSubstr("slipped_off at 5 of 401 points, first at diameter = 1 mm"));
}

// Of 41 x 7 points whole values of the parameters are left out: the rows form a grid.
TEST(StudyReport, TheTableOfTwoParametersHasWholeValues) {
  const std::string two =
      "[[parameter]]\npath = \"cilium.diameter\"\nfrom = \"1 mm\"\nto = \"5 mm\"\ncount = 41\n"
      "[[parameter]]\npath = \"load.azimuth\"\nfrom = \"0 deg\"\nto = \"60 deg\"\ncount = 7\n";
  const std::string out = text(result_of(two, [](double d) { return d; }));
  EXPECT_THAT(out, HasSubstr("287 points, 25 of them below, 262 left out"));
  std::map<std::string, std::vector<std::string>> rows;  // azimuths of each diameter
  std::istringstream lines(out.substr(out.find("|dB|")));
  std::string line;
  std::getline(lines, line);
  std::string diameter;
  std::string azimuth;
  std::string value;
  while (std::getline(lines, line) && std::istringstream(line) >> diameter >> azimuth >> value)
    rows[diameter].push_back(azimuth);
  EXPECT_EQ(rows.size(), 5u);
  for (const auto& [d, azimuths] : rows)
    EXPECT_THAT(azimuths, testing::ElementsAre("0", "10", "30", "40", "60")) << d;
}

}  // namespace
}  // namespace ciliaval::compare::study::summary
