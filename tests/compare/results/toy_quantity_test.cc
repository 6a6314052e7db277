// SPDX-License-Identifier: LGPL-2.1-or-later
// A number of a result that only this file declares goes into summary.json, baselines, checks, mesh
// studies, studies, the budget and what can be measured.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "compare/budget/budget.h"
#include "compare/budget/report.h"
#include "compare/convergence/study.h"
#include "compare/models/registry.h"
#include "compare/models/run.h"
#include "compare/output/provenance.h"
#include "compare/output/results.h"
#include "compare/output/table.h"
#include "compare/regression/check.h"
#include "compare/results/quantity.h"
#include "compare/study/evaluate.h"
#include "compare/study/reader/study_reader.h"
#include "compare/validation/validation.h"
#include "problem/error.h"
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
                           .values =
                               [](const MechanicsStep& step) {
                                 return step.deformation ? std::vector{lean_of(step)}
                                                         : std::vector<double>{};
                               },
                           .is_looked_at = true,
                           .words = "leans by {}"});
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

TEST_F(ToyQuantity, IsSaidOnTheTerminal) {
  EXPECT_THAT(output::table(result, {}, output::Footnotes::reference, output::Steps::all),
              testing::HasSubstr(fmt::format("  beam: leans by {:.4g}\n",
                                             lean_of(result.mechanics[1].result.steps[1]))));
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
  const auto lean = std::ranges::find_if(study.quantities, [](const auto& quantity) {
    return quantity.finest.id() == "steps/1/mechanics/beam/lean";
  });
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

TEST_F(ToyQuantity, IsInTheBudget) {
  const budget::Budget budget =
      budget::error_budget(problem, models::mechanics_models(), models::field_models(),
                           {"solid", "volume", "mesh", "potential", "sensitivity"});
  const auto row = std::ranges::find_if(budget.rows, [](const budget::BudgetRow& of) {
    return of.quantity == "lean" && of.step == 1;
  });
  ASSERT_NE(row, budget.rows.end());
  const double paper = lean_of(result.mechanics[0].result.steps[1]);
  EXPECT_NEAR(row->paper, paper, 1e-9);
  EXPECT_NEAR(row->links.at(0).value, lean_of(result.mechanics[1].result.steps[1]) - paper, 1e-9);
  EXPECT_EQ(row->links[0].verdict, models::Verdict::inconclusive);  // it has no uncertainty
  EXPECT_THAT(budget::budget_text(budget, output::Footnotes::reference),
              testing::HasSubstr("lean"));
}

TEST_F(ToyQuantity, IsMeasured) {
  const auto with = [](const std::string& measurement) {
    return input::read_case(
        test::case_text({.name = "toy", .force = R"(["1 mN", "2 mN"])"},
                        "mechanics = [\"elastica\"]\n[[measurement]]\nsource = \"a photograph\"\n"
                        "uncertainty = 0.001\n" +
                            measurement),
        "toy.toml", models::known());
  };
  const input::Case measured = with("quantity = \"lean\"\nstep = 1\nvalue = 0.3\n");
  const models::CaseResult of_elastica =
      models::run(measured, models::mechanics_models(), models::field_models());
  const auto validation =
      validation::validate(of_elastica, models::mechanics_models(), models::field_models());
  ASSERT_TRUE(validation);
  const validation::Point& point = validation->series.at(0).points.at(0);
  EXPECT_EQ(point.simulated, lean_of(of_elastica.mechanics[0].result.steps[1]));
  EXPECT_EQ(point.measured.value, 0.3);
  EXPECT_EQ(
      input::read_case(input::to_toml(measured, models::known()), "again.toml", models::known())
          .measured.measurements[0]
          .measurand,
      point.measured.measurand);
  try {
    with("quantity = \"leen\"\nstep = 1\nvalue = 0.3\n");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("did you mean 'lean'?"));
  }
}

}  // namespace
}  // namespace ciliaval::compare
