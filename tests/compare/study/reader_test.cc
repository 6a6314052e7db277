// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "compare/study/reader/study_reader.h"
#include "problem/error.h"
#include "tests/support/study_texts.h"

namespace ciliaval::compare::study::reader {
namespace {

namespace fs = std::filesystem;
using test::modulus_range;
using test::study_text;
using test::TemporaryFolder;
using testing::DoubleEq;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pointwise;
using testing::StartsWith;

const std::string pairs = "pairs = [\"elastica/line\", \"beam/volume\"]\n";

class StudyReader : public testing::Test {
 protected:
  Study read(const std::string& text) {
    return read_study(test::write_study(folder_.path(), text));
  }
  std::string faults(const std::string& text) {
    const fs::path file = test::write_study(folder_.path(), text);
    try {
      read_study(file);
    } catch (const InputError& error) {
      std::string what = error.what();
      const std::string folder = folder_.path().string() + "/";
      for (std::size_t at = 0; (at = what.find(folder)) != std::string::npos;)
        what.erase(at, folder.size());
      return what;
    }
    return {};
  }
  void SetUp() override { test::write_study_case(folder_.path()); }

  TemporaryFolder folder_;
};

TEST_F(StudyReader, ReadsParametersFixedNumbersPairsAndOutputs) {
  const Study study = read(study_text(pairs + "outputs = [\"range\", \"dB_x\"]\ntitle = \"T\"\n",
                                      "[fixed]\nload.force = \"2 mN\"\n" + modulus_range));
  EXPECT_EQ(study.name, "varied");
  EXPECT_EQ(study.title, "T");
  ASSERT_EQ(study.parameters.size(), 1u);
  const Parameter& p = study.parameters[0];
  EXPECT_EQ(p.name, "E1");
  EXPECT_EQ(p.unit, "MPa");
  EXPECT_TRUE(p.is_logarithmic);
  ASSERT_EQ(p.values.size(), 5u);
  EXPECT_EQ(p.values.front(), 1e5);
  EXPECT_EQ(p.values.back(), 1e6);
  for (std::size_t i = 1; i < 5; ++i)
    EXPECT_NEAR(p.values[i] / p.values[i - 1], std::pow(10.0, 0.25), 1e-12);
  EXPECT_EQ(study.describe(0), "E1 = 0.1 MPa");
  EXPECT_THAT(study.mechanics(), ElementsAre("elastica", "beam"));
  EXPECT_THAT(study.outputs, ElementsAre(Output::dB_x, Output::range));  // in their own order
  const input::Case c = study.case_at(4);
  EXPECT_EQ(c.cilium.segments[0].young_modulus, 1e6);
  EXPECT_EQ(c.cilium.segments[1].young_modulus, 3e6);
  ASSERT_EQ(c.load_path.size(), 1u);
  EXPECT_EQ(magnitude(c.load_path[0]), 2e-3);
  EXPECT_EQ(contact_height(c.load_path[0]), 0.016);
}

TEST_F(StudyReader, AProductRunsTheLastParameterFastestAndAZipAllTogether) {
  const std::string two = R"([[parameter]]
path = "cilium.diameter"
values = ["2 mm", "3 mm"]
[[parameter]]
path = "load.azimuth"
from = "0 deg"
to = "90 deg"
count = )";
  const Study product = read(study_text(pairs, two + "3\n"));
  ASSERT_EQ(product.point_count(), 6u);
  const std::vector<std::pair<double, double>> expected{{0.002, 0}, {0.002, 45}, {0.002, 90},
                                                        {0.003, 0}, {0.003, 45}, {0.003, 90}};
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_DOUBLE_EQ(product.values_at(i)[0], expected[i].first) << i;
    EXPECT_DOUBLE_EQ(product.values_at(i)[1], expected[i].second * std::numbers::pi / 180) << i;
  }
  EXPECT_EQ(product.describe(4), "diameter = 3 mm, azimuth = 45 deg");
  const Study zip = read(study_text(pairs + "combine = \"zip\"\n", two + "2\n"));
  ASSERT_EQ(zip.point_count(), 2u);
  EXPECT_THAT(zip.values_at(1), ElementsAre(0.003, DoubleEq(std::numbers::pi / 2)));
}

TEST_F(StudyReader, CompoundNumbersKeepWhatTheyShould) {
  const auto at = [&](const std::string& path, const std::string& value,
                      const std::string& fixed = "") {
    return read(study_text(pairs, fixed + "[[parameter]]\npath = \"" + path + "\"\nvalues = [" +
                                      value + "]\n"))
        .case_at(0)
        .cilium;
  };
  const Cilium split = at("cilium.segment.magnet.proportion", "0.7");
  EXPECT_DOUBLE_EQ(split.segments[1].length, 0.014);
  EXPECT_DOUBLE_EQ(split.segments[0].length, 0.006);
  const Cilium slender = at("cilium.aspect_ratio", "10");
  EXPECT_DOUBLE_EQ(slender.diameter, 0.002);
  EXPECT_DOUBLE_EQ(slender.length(), 0.02);
  const Cilium longer = at("cilium.length", "\"40 mm\"");
  EXPECT_DOUBLE_EQ(longer.segments[0].length, 0.006);
  EXPECT_DOUBLE_EQ(longer.segments[1].length, 0.034);
  EXPECT_DOUBLE_EQ(longer.diameter, 0.003);
  // Whatever the order in the file: plain numbers, then the length, the proportion, the ratio.
  const Cilium all =
      at("cilium.length", "\"40 mm\"",
         "[fixed]\ncilium.aspect_ratio = 20\ncilium.segment.base.proportion = 0.5\n");
  EXPECT_DOUBLE_EQ(all.segments[0].length, 0.02);
  EXPECT_DOUBLE_EQ(all.segments[1].length, 0.02);
  EXPECT_DOUBLE_EQ(all.diameter, 0.002);
}

TEST_F(StudyReader, AFlowByItsVelocityFollowsTheDiameter) {
  std::string text = test::case_text({.name = "one"}, "mechanics = [\"elastica\"]\n");
  const std::size_t load = text.find("[load]");
  text.replace(load, text.find("[sensor]") - load,
               "[load]\ntype = \"flow\"\nvelocity = \"0.5 m/s\"\n");
  std::ofstream(folder_.path() / "one.toml") << text;
  const Study study = read(study_text(
      pairs, "[[parameter]]\npath = \"cilium.diameter\"\nvalues = [\"3 mm\", \"2 mm\"]\n"));
  EXPECT_DOUBLE_EQ(magnitude(study.case_at(0).load_path[0]), 0.375);  // the paper's q_max
  EXPECT_DOUBLE_EQ(magnitude(study.case_at(1).load_path[0]), 0.25);
}

TEST_F(StudyReader, AStepOfALoadPathIsChosenByWhatIsSet) {
  test::write_study_case(folder_.path(), "[\"1 mN\", \"2 mN\"]");
  EXPECT_THAT(faults(study_text(pairs, modulus_range)), HasSubstr("the case has 2 load steps"));
  EXPECT_EQ(read(study_text(pairs, "[fixed]\nload.force = \"3 mN\"\n" + modulus_range))
                .case_at(0)
                .load_path.size(),
            1u);
}

TEST_F(StudyReader, ASensorIsChosenByNameOrNumber) {
  std::string text = test::case_text({.name = "one"}, "mechanics = [\"elastica\"]\n");
  const std::size_t sensor = text.find("[sensor]");
  text.replace(sensor, text.find("[models]") - sensor,
               "[[sensor]]\nname = \"left\"\nposition = [\"1 mm\", \"0 mm\", \"-2 mm\"]\n"
               "[[sensor]]\nname = \"right\"\nposition = [\"3 mm\", \"0 mm\", \"-2 mm\"]\n");
  std::ofstream(folder_.path() / "one.toml") << text;
  for (const char* chosen : {"sensor = \"right\"\n", "sensor = 1\n"}) {
    const input::Case c = read(study_text(pairs + chosen, modulus_range)).case_at(0);
    EXPECT_THAT(c.sensors, ElementsAre(Vector3(3e-3, 0, -2e-3))) << chosen;
    EXPECT_THAT(c.sensor_names, ElementsAre("right")) << chosen;
  }
  EXPECT_THAT(faults(study_text(pairs + "sensor = \"middle\"\n", modulus_range)),
              HasSubstr("no sensor 'middle': they are left, right"));
}

TEST_F(StudyReader, TheFingerprintHasWhatTheResultsDependOnAndNothingElse) {
  const support::Fingerprint usual = fingerprint(read(study_text(pairs, modulus_range)));
  const auto with = [&](const std::string& header, const std::string& rest) {
    return fingerprint(read(study_text(header, rest)));
  };
  EXPECT_EQ(with(pairs + "title = \"Another\"\n", modulus_range), usual);
  std::string renamed = modulus_range;
  renamed.replace(renamed.find("E1"), 2, "Eb");
  EXPECT_EQ(with(pairs, renamed), usual);
  // The unit in which a range is stated may change its last bits; here it does not.
  EXPECT_NE(with(pairs + "outputs = [\"range\"]\n", modulus_range), usual);
  EXPECT_NE(with("pairs = [\"elastica/line\"]\n", modulus_range), usual);
  EXPECT_NE(with(pairs, "[fixed]\nload.force = \"1.0000001 mN\"\n" + modulus_range), usual);
  std::string longer = modulus_range;
  longer.replace(longer.find("= 5"), 3, "= 6");
  EXPECT_NE(with(pairs, longer), usual);
  const auto optimised = [&](const std::string& keys, const std::string& bounds) {
    return with(pairs, "[optimise]\nmaximise = \"dB_x\"\n" + keys +
                           "[[parameter]]\npath = \"cilium.diameter\"\nto = \"5 mm\"\n" + bounds);
  };
  const std::string from = "from = \"1 mm\"\n";
  const support::Fingerprint optimum = optimised("", from);
  for (const char* keys :
       {"starts = 9\n", "global_evaluations = 9\n", "at_least.dB_x = \"1 uT\"\n"})
    EXPECT_NE(optimised(keys, from), optimum) << keys;
  for (const char* bounds : {"from = \"2 mm\"\n", "from = \"1 mm\"\nstart = \"2 mm\"\n",
                             "from = \"1 mm\"\nspacing = \"logarithmic\"\n"})
    EXPECT_NE(optimised("", bounds), optimum) << bounds;
  EXPECT_EQ(optimised("", from + "name = \"d\"\n"), optimum);
  test::write_study_case(folder_.path(), "\"1 mN\"",
                         "mechanics = [\"elastica\"]\n[models.beam]\ndegree = 4\n");
  EXPECT_NE(with(pairs, modulus_range), usual);
}

// Each fault is planted in a study that is right without it, and said where it stands.
TEST_F(StudyReader, FaultsAreSaidWithTheirPlaceAndAnAdvice) {
  struct Planted {
    std::string header;
    std::string rest;
    std::string place;
    std::string words;
  };
  const auto parameter = [](const std::string& lines) { return "[[parameter]]\n" + lines; };
  const std::string diameter = "path = \"cilium.diameter\"\n";
  const std::vector<Planted> planted{
      {pairs + "oututs = [\"range\"]\n", modulus_range, "5:1:", "did you mean 'outputs'?"},
      {pairs + "outputs = [\"ranje\"]\n", modulus_range, "5:12:", "did you mean 'range'?"},
      {pairs + "outputs = []\n", modulus_range, "5:11:", "must be a list"},
      {"pairs = [\"elastica/lin\"]\n", modulus_range, "4:10:", "did you mean 'elastica/line'?"},
      {"pairs = [\"elastica/mesh\"]\n", modulus_range, "4:10:", "cannot be 'elastica/mesh'"},
      {"pairs = [\"elastica/line\", \"elastica/line\"]\n", modulus_range, "4:27:", "twice"},
      {"", modulus_range, "1:1:", "needs 'pairs'"},
      {pairs + "combine = \"zipp\"\n", modulus_range, "5:11:", "did you mean 'zip'?"},
      {pairs + "noise = \"1 uT\"\n", modulus_range, "5:9:", "goes with the output 'resolution'"},
      {pairs + "outputs = [\"resolution\"]\n", modulus_range, "1:1:", "needs 'noise'"},
      {pairs + "outputs = [\"resolution\"]\nnoise = \"1 mm\"\n", modulus_range, "6:9:", "flux"},
      {pairs + "rotation = \"60 deg\"\n", modulus_range, "5:12:", "goes with the output 'range'"},
      {pairs + "sensor = 1\n", modulus_range, "5:10:", "no sensor 1"},
      {pairs, "[fixed]\nload.forc = \"1 mN\"\n" + modulus_range,
       "7:6:", "did you mean 'load.force'?"},
      {pairs, "[fixed]\nload.force = \"1\"\n" + modulus_range, "7:14:", "'load.force'"},
      {pairs, "[fixed]\nload.force = \"1 mm\"\n" + modulus_range, "7:14:", "force"},
      {pairs, "[fixed]\nload.force = \"-1 mN\"\n" + modulus_range, "7:14:", "not negative"},
      {pairs, "[fixed]\nload.displacement = \"1 mm\"\n" + modulus_range, "7:6:", "no number"},
      {pairs, "[fixed]\ncilium.segment.base.young_modulus = \"1 MPa\"\n" + modulus_range,
       "9:8:", "is set twice"},
      {pairs, "[fixed]\ncilium.aspect_ratio = 5\n" + parameter(diameter + "values = [\"3 mm\"]\n"),
       "9:8:", "contradicts 'cilium.aspect_ratio'"},
      {pairs, "", "1:1:", "varies one parameter or more"},
      {pairs, "[parameter]\n" + diameter + "values = [\"3 mm\"]\n", "6:1:", "[[parameter]]"},
      {pairs, parameter("path = \"cilium.diametr\"\nvalues = [\"3 mm\"]\n"),
       "7:8:", "did you mean 'cilium.diameter'?"},
      {pairs, parameter("path = \"xyz\"\nvalues = [\"3 mm\"]\n"),
       "7:8:", "there are cilium.diameter"},
      {pairs, parameter(diameter), "6:1:", "needs 'values', or 'from'"},
      {pairs, parameter(diameter + "values = [\"3 mm\"]\nfrom = \"1 mm\"\n"),
       "8:10:", "contradicts 'from'"},
      {pairs, parameter(diameter + "values = [3]\n"), "8:11:", "has no unit"},
      {pairs, parameter(diameter + "values = [\"3 mm\", \"3 MPa\"]\n"), "8:19:", "length"},
      {pairs, parameter(diameter + "values = [\"3 mm\", \"0.3 cm\"]\n"), "8:19:", "listed twice"},
      {pairs, parameter(diameter + "values = []\n"), "8:10:", "must be a list"},
      {pairs, parameter(diameter + "from = \"1 mm\"\nto = \"3 mm\"\n"), "6:1:", "needs 'count'"},
      {pairs, parameter(diameter + "from = \"1 mm\"\nto = \"3 mm\"\ncount = 1\n"),
       "10:9:", "count"},
      {pairs, parameter(diameter + "from = \"1 mm\"\nto = \"1 mm\"\ncount = 3\n"),
       "9:6:", "the same"},
      {pairs,
       parameter("path = \"load.azimuth\"\nfrom = \"0 deg\"\nto = \"9 deg\"\ncount = 3\nspacing = "
                 "\"logarithmic\"\n"),
       "11:11:", "one sign"},
      {pairs, parameter("path = \"models.beam.degree\"\nfrom = 2\nto = 5\ncount = 3\n"),
       "10:9:", "whole number"},
      {pairs, parameter("path = \"models.beam.degree\"\nvalues = [2.5]\n"),
       "8:11:", "whole number"},
      {pairs, parameter("path = \"cilium.segment.magnet.proportion\"\nvalues = [1]\n"),
       "8:11:", "a segment is a part"},
      {pairs, parameter("path = \"models.solid.refinement\"\nvalues = [1]\n"),
       "7:8:", "no pair of the study runs solid"},
      {pairs, "[fixed]\nmodels.potential.tolerance = 1e-3\n" + modulus_range,
       "7:18:", "no pair of the study runs potential"},
      {pairs, "[tolerances]\nmodels.solid.kernel_width = \"0.1 mm\"\n",
       "7:14:", "no pair of the study runs solid"},
      {pairs + "combine = \"zip\"\n", modulus_range + parameter(diameter + "values = [\"3 mm\"]\n"),
       "1:1:", "has 5, 'diameter' 1"},
      {pairs,
       parameter(diameter + "from = \"1 mm\"\nto = \"3 mm\"\ncount = 2000\n") + modulus_range +
           parameter("path = \"load.azimuth\"\nfrom = \"1 deg\"\nto = \"3 deg\"\ncount = 2000\n"),
       "1:1:", "points, more than"},
      // Right by itself, not with the rest of the case: the contact beyond the tip.
      {pairs, parameter("path = \"cilium.length\"\nvalues = [\"30 mm\", \"15 mm\"]\n"),
       "1:1:", "at length = 15 mm: the contact height 0.016 m must lie between"},
  };
  for (const Planted& p : planted) {
    SCOPED_TRACE(p.header + p.rest);
    const std::string said = faults(study_text(p.header, p.rest));
    EXPECT_THAT(said, StartsWith("varied.study.toml:" + p.place));
    EXPECT_THAT(said, HasSubstr(p.words));
  }
  EXPECT_EQ(faults(study_text(pairs, modulus_range)), "");
}

TEST_F(StudyReader, ReadsAnOptimisation) {
  const Study study = read(study_text(
      pairs + "outputs = [\"dB_x\"]\n",
      "[fixed]\nload.force = \"2 mN\"\n[optimise]\nmaximise = \"sensitivity\"\nstarts = 3\n"
      "at_least.range = \"2.5 mN\"\n[optimise.at_most]\nB_z = \"3 mT\"\nsensitivity = \"1 mT/mN\"\n"
      "[[parameter]]\npath = \"cilium.segment.base.young_modulus\"\nname = \"E1\"\nfrom = \"0.2 "
      "MPa\"\nto = \"3 MPa\"\nspacing = \"logarithmic\"\n"
      "[[parameter]]\npath = \"cilium.diameter\"\nfrom = \"1 mm\"\nto = \"5 mm\"\n"
      "[[parameter]]\npath = \"load.height\"\nfrom = \"14 mm\"\nto = \"18 mm\"\nstart = \"17 "
      "mm\"\n"));
  // The goal and the limits of the search are among the outputs.
  EXPECT_THAT(study.outputs,
              ElementsAre(Output::B_z, Output::dB_x, Output::sensitivity, Output::range));
  EXPECT_TRUE(study.parameters.empty());
  EXPECT_EQ(study.point_count(), 0u);
  const Optimisation& o = study.optimisation.value();
  EXPECT_EQ(o.goal, Output::sensitivity);
  EXPECT_EQ(o.starts, 3u);
  EXPECT_EQ(o.global_evaluations, 2000u);
  ASSERT_EQ(o.limits.size(), 3u);
  EXPECT_EQ(o.limits[0].output, Output::range);
  EXPECT_TRUE(o.limits[0].is_lower);
  EXPECT_DOUBLE_EQ(o.limits[0].value, 2.5e-3);
  EXPECT_EQ(o.limits[1].output, Output::B_z);
  EXPECT_FALSE(o.limits[1].is_lower);
  EXPECT_DOUBLE_EQ(o.limits[2].value, 1);
  // The case's own value, brought within the bounds, unless the study says another.
  EXPECT_THAT(o.start, ElementsAre(0.2e6, 0.003, 0.017));
  EXPECT_TRUE(o.parameters[0].is_logarithmic);
  EXPECT_THAT(o.parameters[1].values, ElementsAre(0.001, 0.005));
  const input::Case c = study.design({1e6, 0.002, 0.015});
  EXPECT_EQ(c.cilium.segments[0].young_modulus, 1e6);
  EXPECT_EQ(c.cilium.diameter, 0.002);
  EXPECT_EQ(contact_height(c.load_path.front()), 0.015);
  EXPECT_EQ(magnitude(c.load_path.front()), 2e-3);
}

TEST_F(StudyReader, FaultsOfAnOptimisationAreSaidWithTheirPlace) {
  const std::string optimise = "[optimise]\nmaximise = \"dB_norm\"\n";  // lines 6 and 7
  const std::string d = "[[parameter]]\npath = \"cilium.diameter\"\n";
  const std::string ends = "from = \"1 mm\"\nto = \"5 mm\"\n";
  struct Planted {
    std::string header;
    std::string rest;
    std::string place;
    std::string words;
  };
  const std::vector<Planted> planted{
      {pairs, "[optimise]\n" + d + ends, "6:1:", "needs 'maximise'"},
      {pairs, "[optimise]\nmaximise = \"dB_nrm\"\n" + d + ends, "7:12:", "did you mean 'dB_norm'?"},
      {pairs, "[optimise]\nmaximise = \"resolution\"\n" + d + ends,
       "7:12:", "cannot be 'resolution'"},
      {pairs, optimise + "at_leest.range = \"2 mN\"\n" + d + ends,
       "8:1:", "did you mean 'at_least'?"},
      {pairs, optimise + "at_least.ranje = \"2 mN\"\n" + d + ends,
       "8:10:", "did you mean 'range'?"},
      {pairs, optimise + "at_least.range = \"2 mm\"\n" + d + ends, "8:18:", "force"},
      {pairs, optimise + "at_least.range = \"0 mN\"\n" + d + ends, "8:18:", "positive"},
      {pairs, optimise + "at_least.range = 2\n" + d + ends, "8:18:", "has no unit"},
      {pairs, optimise + "at_least.range = \"2 mN\"\nat_most.range = \"1 mN\"\n" + d + ends,
       "9:17:", "at least 0.002 and at most 0.001"},
      {pairs, optimise + "starts = -1\n" + d + ends, "8:10:", "'starts'"},
      {pairs, optimise + "global_evaluations = 2.5\n" + d + ends, "8:22:", "whole number"},
      {pairs, optimise, "1:1:", "searches one parameter or more"},
      {pairs, optimise + d + "from = \"1 mm\"\n", "8:1:", "needs 'to'"},
      {pairs, optimise + d + ends + "count = 3\n", "12:9:", "and no 'count'"},
      {pairs, optimise + d + ends + "values = [\"1 mm\"]\n", "12:10:", "and no 'values'"},
      {pairs, optimise + d + "from = \"5 mm\"\nto = \"1 mm\"\n", "10:8:", "must be below 'to'"},
      {pairs, optimise + d + ends + "start = \"6 mm\"\n", "12:9:", "between 'from' and 'to'"},
      {pairs, optimise + d + ends + "strat = \"3 mm\"\n", "12:1:", "did you mean 'start'?"},
      {pairs, optimise + d + ends + d + ends, "13:8:", "is set twice"},
      {pairs, optimise + "[[parameter]]\npath = \"models.beam.degree\"\nfrom = 2\nto = 5\n",
       "8:1:", "is a whole number"},
      {pairs + "combine = \"zip\"\n", optimise + d + ends, "5:11:", "not with [optimise]"},
      {pairs, optimise + "[tolerances]\ncilium.diameter = \"1 %\"\n" + d + ends,
       "8:1:", "of another study"},
      {pairs, optimise + "at_most.resolution = \"1 mN\"\n" + d + ends, "1:1:", "needs 'noise'"},
      // Right by itself, not with the rest of the case: the contact beyond the tip.
      {pairs,
       optimise + "[[parameter]]\npath = \"cilium.length\"\nfrom = \"15 mm\"\nto = \"30 mm\"\n",
       "1:1:", "at length = 15 mm: the contact height 0.016 m must lie between"},
  };
  for (const Planted& p : planted) {
    SCOPED_TRACE(p.header + p.rest);
    const std::string said = faults(study_text(p.header, p.rest));
    EXPECT_THAT(said, StartsWith("varied.study.toml:" + p.place));
    EXPECT_THAT(said, HasSubstr(p.words));
  }
  EXPECT_EQ(faults(study_text(pairs, optimise + d + ends)), "");
}

TEST_F(StudyReader, SeveralFaultsAreSaidAtOnceInTheOrderOfTheFile) {
  const std::string said =
      faults(study_text(pairs + "outputs = [\"ranje\"]\n",
                        "[fixed]\nload.forc = \"1 mN\"\n[[parameter]]\npath = \"cilium.diametr\"\n"
                        "values = [\"3 mm\"]\n[more]\n"));
  EXPECT_THAT(said, testing::MatchesRegex(
                        "varied.study.toml:5:[^\n]*\nvaried.study.toml:8:[^\n]*\n"
                        "varied.study.toml:10:[^\n]*\nvaried.study.toml:12:[^\n]*unknown key.*"));
}

TEST_F(StudyReader, FaultsOfTheCaseAreSaidThere) {
  EXPECT_THAT(faults("[study]\nname = \"x\"\ncase = \"none.toml\"\n" + pairs + modulus_range),
              StartsWith("varied.study.toml:3:8: there is no case file 'none.toml'"));
  test::write_study_case(folder_.path(), "\"1 m\"");
  EXPECT_THAT(faults(study_text(pairs, modulus_range)), StartsWith("one.toml:19:9: 'force'"));
  test::write_study_case(folder_.path());
  EXPECT_THAT(faults("[study"), StartsWith("varied.study.toml:1:"));
  EXPECT_THAT(faults(""), HasSubstr("the table [study] is missing"));
}

TEST(ShippedStudies, HaveTheFiguresOfThePaper) {
  // Oracle: the paper, section 3.4.
  const auto read = [](const std::string& name) {
    const Study study = read_study(CILIAVAL_SOURCE_DIR "/cases/paper/" + name + ".study.toml");
    EXPECT_EQ(study.name, name);
    for (const std::size_t point : {std::size_t{0}, study.point_count() - 1}) {
      const input::Case c = study.case_at(point);
      const auto load = *c.load_path.front().as<ContactLoad>();
      EXPECT_EQ(load.force, 1e-3);
      EXPECT_EQ(load.height, 0.016);
      EXPECT_DOUBLE_EQ(load.azimuth, std::numbers::pi / 6);
      EXPECT_DOUBLE_EQ(c.cilium.length(), 0.02);
      EXPECT_EQ(c.cilium.segments[1].magnetization, 7.5e4);
      EXPECT_THAT(c.sensors, ElementsAre(Vector3(-0.1e-3, 0.2e-3, -1.55e-3)));
    }
    return study;
  };
  const auto moduli = [](const Study& study) {
    const input::Case c = study.case_at(0);
    return std::pair(c.cilium.segments[0].young_modulus, c.cilium.segments[1].young_modulus);
  };
  EXPECT_EQ(moduli(read("fig4a-e1")), std::pair(0.1e6, 1e6));
  EXPECT_EQ(moduli(read("fig4a-e2")), std::pair(1e6, 0.1e6));
  const Study b = read("fig4b");
  EXPECT_EQ(moduli(b), std::pair(0.5e6, 1e6));
  EXPECT_EQ(b.case_at(0).cilium.interfaces()[1], 0.003);
  const Study c = read("fig4c");
  EXPECT_EQ(moduli(c), std::pair(0.5e6, 1e6));
  EXPECT_EQ(c.case_at(0).cilium.diameter, 0.003);
}

}  // namespace
}  // namespace ciliaval::compare::study::reader
