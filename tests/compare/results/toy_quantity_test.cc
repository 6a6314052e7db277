// SPDX-License-Identifier: LGPL-2.1-or-later
// A number of a result that only this file declares goes into summary.json, baselines, checks and
// mesh studies.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "compare/convergence/study.h"
#include "compare/models/registry.h"
#include "compare/models/run.h"
#include "compare/output/provenance.h"
#include "compare/output/results.h"
#include "compare/regression/check.h"
#include "compare/results/quantity.h"
#include "compare/study/evaluate.h"
#include "compare/study/reader/study_reader.h"
#include "tests/support/study_texts.h"
#include "tests/support/synthetic.h"
#include "tests/support/temporary_folder.h"

namespace ciliaval::compare {
namespace {

/// Deflection over height of the tip.
double lean_of(const MechanicsStep& step) {
  const Centreline& centreline = step.deformation->centreline;
  const Vector3 tip = centreline.at(centreline.length()).position;
  return tip.head<2>().norm() / tip.z();
}

class ToyQuantity : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    results::add_quantity({.name = "lean",
                           .unit = "",
                           .values =
                               [](const MechanicsStep& step) {
                                 return step.deformation ? std::vector{lean_of(step)}
                                                         : std::vector<double>{};
                               },
                           .is_looked_at = true});
  }

  const input::Case problem =
      input::read_case(test::case_text({.name = "toy", .force = R"(["1 mN", "2 mN", "7 mN"])"},
                                       "mechanics = [\"elastica\", \"beam\"]\n"),
                       "toy.toml", models::known());
  const models::CaseResult result =
      models::run(problem, models::mechanics_models(), models::field_models());
};

TEST_F(ToyQuantity, IsInTheSummary) {
  const auto json =
      nlohmann::json::parse(output::summary_json(result, {}, output::provenance("test"), ""));
  const auto of_beam = [&](std::size_t step) {
    return json.at("steps").at(step).at("mechanics").at("beam").at("lean");
  };
  EXPECT_EQ(of_beam(1).get<double>(), lean_of(result.mechanics[1].result.steps[1]));
  EXPECT_TRUE(of_beam(2).is_null());  // it slips off
}

TEST_F(ToyQuantity, IsCheckedAgainstABaseline) {
  const regression::Baseline baseline =
      regression::make_baseline(problem, regression::measurements(result), {}, nullptr);
  const auto found = std::ranges::find(baseline.quantities, "steps/1/mechanics/beam/lean",
                                       &regression::Expected::id);
  ASSERT_NE(found, baseline.quantities.end());
  // The largest of the path, by the beam's accuracy.
  EXPECT_NEAR(found->allowed.absolute / found->value, 1e-10, 0.5e-11);
  EXPECT_TRUE(regression::check(problem, result, baseline).passed());

  regression::Baseline other = baseline;
  other.quantities[static_cast<std::size_t>(found - baseline.quantities.begin())].value *= 1 + 1e-8;
  const regression::CheckReport report = regression::check(problem, result, other);
  EXPECT_EQ(report.failures(), 1U);
  EXPECT_THAT(regression::report_text({report}),
              testing::HasSubstr("steps/1/mechanics/beam/lean (baseline): is "));
}

TEST_F(ToyQuantity, ConvergesWithTheMesh) {
  const auto all = convergence::refinements(problem);
  const auto beam = std::ranges::find(all, "beam", &convergence::ModelRefinement::model);
  ASSERT_NE(beam, all.end());
  const convergence::RefinementStudy study = convergence::refinement_study(problem, *beam, 3);
  const auto lean = std::ranges::find(study.quantities, "steps/1/mechanics/beam/lean",
                                      &convergence::ConvergedQuantity::id);
  ASSERT_NE(lean, study.quantities.end());
  EXPECT_TRUE(lean->extrapolation.conclusive) << lean->extrapolation.reason;
  EXPECT_NEAR(lean->extrapolation.limit, lean_of(result.mechanics[0].result.steps[1]),
              0.05 * lean->extrapolation.limit);
  EXPECT_THAT(convergence::study_text({study}, true),
              testing::HasSubstr("steps/1/mechanics/beam/lean"));
}

TEST_F(ToyQuantity, IsAnOutputOfAStudy) {
  const test::TemporaryFolder folder;
  test::write_study_case(folder.path());
  const study::Study study = study::reader::read_study(test::write_study(
      folder.path(),
      test::study_text("pairs = [\"beam/line\"]\noutputs = [\"lean\", \"tip_z\", \"dB_norm\"]\n",
                       "[[parameter]]\npath = \"load.force\"\nvalues = [\"1 mN\", \"2 mN\"]\n"
                       "[fixed]\n\"sensor.position.z\" = \"-3 mm\"\n")));
  const auto results = study::evaluate(study, study.case_at(1), "beam", models::mechanics_models(),
                                       models::field_models());
  ASSERT_EQ(results.at(0).values.size(), 3U);
  const MechanicsStep& step = result.mechanics[1].result.steps[1];
  // In the order of all outputs: what is seen at the sensor first, then the shape's.
  EXPECT_NEAR(results[0].values[2].value(), lean_of(step), 1e-9);
  const double L = problem.cilium.length();
  EXPECT_NEAR(results[0].values[1].value(), step.deformation->centreline.at(L).position.z(), 1e-12);
  EXPECT_EQ(study::id(study.outputs[2]), "lean");
  EXPECT_EQ(study::quantity_of(study.outputs[1], study.load()).unit, "m");
}

}  // namespace
}  // namespace ciliaval::compare
