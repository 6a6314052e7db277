// SPDX-License-Identifier: LGPL-2.1-or-later

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "compare/models/registry.h"
#include "compare/study/reader/study_reader.h"
#include "compare/study/summary/report.h"
#include "problem/error.h"
#include "tests/support/study_texts.h"
#include "tests/support/synthetic.h"

namespace ciliaval::compare::study::summary {
namespace {

namespace fs = std::filesystem;
using test::study_text;
using test::TemporaryFolder;
using testing::HasSubstr;
using testing::StartsWith;

using test::L;

Study study_of(const fs::path& folder, const std::string& header, const std::string& rest) {
  test::write_study_case(folder);
  return reader::read_study(test::write_study(folder, study_text(header, rest)));
}

StudyResult solve(const Study& study, std::span<const models::MechanicsEntry> mechanics,
                  std::span<const models::FieldEntry> fields) {
  Solutions in_memory;
  return run_study(study, in_memory, mechanics, fields);
}

const std::string tolerances = R"([tolerances]
load.force = "0.1 mN"
sensor.position.x = "10 mm"
cilium.diameter = "2 %"
)";

/// B = 25 T/rad² θ² (1 + x/m)³ e_x of a cilium that turns by 0.1 rad under 1 mN.
StudyResult of_formulas(const std::string& header, const std::string& rest, double largest = 1) {
  const TemporaryFolder folder;
  const std::vector<models::MechanicsEntry> mechanics{
      test::mechanics_entry("elastica", [=](const Load& l) {
        if (magnitude(l) > largest) throw SolverError("too much");
        return test::converged(l, test::tilted(L, L / 2, direction(l), 100 * magnitude(l)));
      })};
  const std::vector<models::FieldEntry> fields{
      test::field_entry("line", [](const Deformation& d, const Vector3& x) -> Vector3 {
        const double theta = d.centreline.at(L).theta();
        return 25 * theta * theta * std::pow(1 + x.x(), 3) * Vector3::UnitX();
      })};
  return solve(study_of(folder.path(), header, rest), mechanics, fields);
}

// Oracle: the derivatives by hand. The differences are exact for cubics.
TEST(StudyTolerances, AreFirstOrderSlopesAndTheirRootSumOfSquares) {
  const StudyResult result = of_formulas(
      "pairs = [\"elastica/line\"]\noutputs = [\"B_x\", \"dB_norm\", \"dB_y\"]\n", tolerances);
  EXPECT_EQ(result.study.point_count(), 0u);
  const double x = 1 - 1e-4;                   // the sensor is at −0.1 mm
  for (const std::size_t output : {0u, 2u}) {  // B_x, dB_norm in the order of all outputs
    const Propagation p = propagate(result, 0, output);
    ASSERT_EQ(p.shares.size(), 3u);
    EXPECT_NEAR(p.nominal.value(), 0.25 * x * x * x, 1e-12);
    // In the order of the paths: cilium, load, sensor.
    EXPECT_NEAR(p.shares[0].slope.value(), 0, 1e-9);
    EXPECT_NEAR(p.shares[1].slope.value(), 500 * x * x * x, 1e-7);
    EXPECT_NEAR(p.shares[2].slope.value(), 0.75 * x * x, 1e-9);
    EXPECT_NEAR(p.shares[1].spread.value(), 500 * x * x * x * 1e-4, 1e-10);
    // D(h) − f' = f''' h²/6 of the cubic, h = σ/4.
    EXPECT_NEAR(p.shares[2].error, 1.5 * 0.0025 * 0.0025 / 6, 1e-9);
    EXPECT_NEAR(p.deviation.value(), std::hypot(0.05 * x * x * x, 0.0075 * x * x), 1e-9);
  }
  EXPECT_EQ(propagate(result, 0, 1).deviation, 0.0);  // dB_y
}

TEST(StudyTolerances, APercentageIsOfTheNominalValueWithWhatIsFixed) {
  const TemporaryFolder folder;
  const Study study = study_of(folder.path(), "pairs = [\"elastica/line\"]\n",
                               "[fixed]\ncilium.diameter = \"2 mm\"\n" + tolerances);
  EXPECT_DOUBLE_EQ(study.tolerances[0].nominal, 0.002);
  EXPECT_DOUBLE_EQ(study.tolerances[0].deviation, 4e-5);
  EXPECT_EQ(study.all_points(), 1u + 4 * 3);
  EXPECT_DOUBLE_EQ(study.case_at(0).cilium.diameter, 0.002);
  EXPECT_DOUBLE_EQ(study.case_at(1).cilium.diameter, 0.002 - 2e-5);
  EXPECT_DOUBLE_EQ(study.case_at(4).cilium.diameter, 0.002 + 2e-5);
  EXPECT_DOUBLE_EQ(study.case_at(5).cilium.diameter, 0.002);
  EXPECT_DOUBLE_EQ(magnitude(study.case_at(6).load_path[0]), 1e-3 - 0.025e-3);
}

TEST(StudyTolerances, StandBehindTheSweep) {
  const StudyResult result = of_formulas(
      "pairs = [\"elastica/line\"]\n",
      tolerances + "[[parameter]]\npath = \"load.force\"\nvalues = [\"2 mN\", \"3 mN\"]\n");
  EXPECT_EQ(result.study.point_count(), 2u);
  EXPECT_EQ(result.points.size(), 2u + 13);
  const auto document = tolerance_json(result);
  EXPECT_EQ(json(result, {})["points"].size(), 2u);
  const auto& entry = document["pairs"]["elastica/line"]["dB_x"];
  EXPECT_NEAR(entry["nominal"].get<double>(), 0.25, 1e-3);
  EXPECT_EQ(entry["slopes"].size(), 3u);
  EXPECT_THAT(text(result), HasSubstr("force("));
}

TEST(StudyTolerances, WhatFailsLeavesAGapAndNoSum) {
  const StudyResult result = of_formulas("pairs = [\"elastica/line\"]\n", tolerances, 1.01e-3);
  const Propagation p = propagate(result, 0, 0);
  EXPECT_TRUE(p.nominal.has_value());
  EXPECT_TRUE(p.shares[0].slope.has_value());
  EXPECT_FALSE(p.shares[1].slope.has_value());
  EXPECT_FALSE(p.deviation.has_value());
  EXPECT_THAT(tolerance_text(result), HasSubstr("-"));
  EXPECT_THAT(tolerance_csv(result), HasSubstr("load.force,N,0.001,0.0001,,,\n"));
  EXPECT_THAT(tolerance_text(of_formulas("pairs = [\"elastica/line\"]\n", tolerances, 1e-5)),
              HasSubstr("failed: too much"));
}

// Oracle: the standard deviation of 4,000 random cilia, all numbers normally distributed. Its own
// relative error is 1/√8000 = 1.1 %; second-order terms of the tolerances are below 1 %.
TEST(StudyTolerances, AgreeWithRandomCilia) {
  const TemporaryFolder folder;
  const Study study =
      study_of(folder.path(), "pairs = [\"elastica/line\"]\noutputs = [\"dB_x\", \"dB_norm\"]\n",
               R"([tolerances]
cilium.diameter = "1 %"
cilium.segment.base.young_modulus = "3 %"
cilium.segment.magnet.magnetization = "2 %"
load.azimuth = "1 deg"
sensor.position.x = "0.05 mm"
sensor.position.z = "0.05 mm"
)");
  const StudyResult result = solve(study, models::mechanics_models(), models::field_models());
  std::mt19937 random(20261122);  // NOLINT(cert-msc51-cpp): the same cilia in every run
  std::normal_distribution<double> normal;
  constexpr std::size_t count = 4000;
  // The random cilia as the points of a zipped study of the same case.
  Study cilia = study;
  cilia.tolerances.clear();
  cilia.is_zipped = true;
  for (const Tolerance& t : study.tolerances) {
    Parameter parameter{t.number, t.number.path, "", 1, {}, false};
    for (std::size_t i = 0; i < count; ++i)
      parameter.values.push_back(t.nominal + t.deviation * normal(random));
    cilia.parameters.push_back(std::move(parameter));
  }
  const StudyResult samples = solve(cilia, models::mechanics_models(), models::field_models());
  for (std::size_t output = 0; output < 2; ++output) {
    double mean = 0;
    for (const auto& point : samples.points) mean += point[0].values[output].value() / count;
    double variance = 0;
    for (const auto& point : samples.points)
      variance += std::pow(point[0].values[output].value() - mean, 2) / (count - 1);
    const Propagation p = propagate(result, 0, output);
    EXPECT_NEAR(p.deviation.value(), std::sqrt(variance), 0.04 * std::sqrt(variance)) << output;
    for (const Propagation::Share& share : p.shares)
      EXPECT_LT(share.error, 1e-2 * std::abs(share.slope.value()) + 1e-12);
  }
}

TEST(StudyTolerances, FaultsAreSaidWithTheirPlace) {
  const TemporaryFolder folder;
  const auto fault = [&](const std::string& lines) -> std::string {
    try {
      study_of(folder.path(), "pairs = [\"elastica/line\"]\n", "[tolerances]\n" + lines);
    } catch (const InputError& error) {
      const std::string what = error.what();
      return what.substr(what.find("varied"));
    }
    return {};
  };
  const auto check = [&](const std::string& lines, const std::string& words) {
    const std::string said = fault(lines);
    EXPECT_THAT(said, StartsWith("varied.study.toml:7:")) << lines;
    EXPECT_THAT(said, HasSubstr(words)) << lines;
  };
  check("cilium.diametr = \"1 %\"\n", "did you mean 'cilium.diameter'?");
  check("cilium.diameter = \"1 MPa\"\n", "length");
  check("cilium.diameter = \"0 mm\"\n", "is positive");
  check("cilium.diameter = \"0 %\"\n", "a percentage is positive");
  check("cilium.diameter = \"-1 %\"\n", "a percentage is positive");
  check("cilium.diameter = 3\n", "has no unit");
  check("cilium.segment.base.magnetization = \"5 %\"\n", "not zero");
  check("cilium.segment.base.poisson_ratio = \"10 %\"\n", "moved by half of its tolerance is 0.51");
  check("models.beam.degree = \"10 %\"\n", "is a whole number");
  EXPECT_EQ(fault("cilium.segment.base.poisson_ratio = \"1 %\"\ncilium.diameter = \"5%\"\n"), "");
  // Right by itself, not with the height of the contact.
  EXPECT_THAT(fault("cilium.length = \"10 mm\"\n"), HasSubstr("the contact height"));
}

}  // namespace
}  // namespace ciliaval::compare::study::summary
