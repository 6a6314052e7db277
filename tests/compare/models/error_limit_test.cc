// SPDX-License-Identifier: LGPL-2.1-or-later
// A model that is refined until its estimate is below the limit that the case sets.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>

#include "compare/models/evaluator.h"
#include "compare/models/run.h"
#include "problem/error.h"
#include "tests/support/synthetic.h"

namespace ciliaval::test {
namespace {

using namespace compare;
using input::ErrorLimit;
using testing::HasSubstr;

constexpr double turn = 0.1;  // rad, of the exact solution

struct HalvingOptions {
  unsigned int refinement = 0;
  unsigned int last_known = 3;  ///< refinement; finer ones have a remark in place of an estimate
};

/// Leans by `turn` and an error that falls to a tenth with each refinement; the step's estimate is
/// the error itself, and its companion is exact.
class Halving : public MechanicsModel {
 public:
  explicit Halving(HalvingOptions options) : options_(options) {}
  MechanicsResult solve(const Cilium& /*cilium*/, const LoadPath& path,
                        const Progress& /*progress*/) const override {
    const double error = 1e-2 * std::pow(10.0, -static_cast<double>(options_.refinement));
    const auto leaning = [&](double angle) {
      MechanicsResult result;
      result.undeformed.centreline = tilted(L, 3e-3, Vector3::UnitX(), 0);
      for (const Load& load : path)
        result.steps.push_back(converged(load, tilted(L, 3e-3, Vector3::UnitX(), angle)));
      return result;
    };
    MechanicsResult result = leaning(turn + error);
    result.companions = {leaning(turn)};
    result.error_parts = {{"angle", 0, 1, 1}};
    for (MechanicsStep& step : result.steps) {
      if (options_.refinement <= options_.last_known)
        step.tip_uncertainty = 2 * L * std::sin(error / 2);
      else
        step.message = "it folds";
      step.seconds = 1;
    }
    return result;
  }
  MechanicsResult solve_from(const Cilium& cilium, const LoadPath& path,
                             const Checkpoint& checkpoint,
                             const Progress& progress) const override {
    if (checkpoint.save) checkpoint.save({{"1", std::to_string(checkpoint.kept.size())}});
    return solve(cilium, path, progress);
  }

 private:
  HalvingOptions options_;
};

models::MechanicsEntry halving() {
  return {
      .id = "halving",
      .description = "",
      .make = input::make<Halving, HalvingOptions>,
      .options = {input::option(&HalvingOptions::refinement, "refinement", {0, 3, false, ""}, "")},
      .refinements = {{.option = "refinement",
                       .values = {0, 1, 2, 3},
                       .size = [](double value) { return std::exp2(-value); },
                       .size_name = "size"}},
      .error_limit = [](const input::ModelOptions& o) { return o.of<ErrorLimit>(); }};
}

input::Case problem_with(const ErrorLimit& limit) {
  input::Case problem = paper_case({1e-3, 2e-3});
  problem.options.of<ErrorLimit>() = limit;
  return problem;
}

/// The tip's error over its displacement, %, of a refinement.
double tip_error(double refinement) {
  const double error = 1e-2 * std::pow(10.0, -refinement);
  return 100 * std::sin(error / 2) / std::sin((turn + error) / 2);
}

MechanicsStep last_step(const ErrorLimit& limit,
                        const std::vector<models::FieldEntry>& fields = {}) {
  return models::run_mechanics(halving(), problem_with(limit), fields).result.steps.back();
}

TEST(ErrorLimit, TakesTheCoarsestMeshWithinIt) {
  for (const double refinement : {0.0, 1.0, 2.0, 3.0}) {
    const MechanicsStep step = last_step({.percent = 1.01 * tip_error(refinement)});
    EXPECT_NEAR(*step.tip_uncertainty, 2 * L * std::sin(5e-3 * std::pow(10.0, -refinement)), 1e-15);
    EXPECT_THAT(step.message, HasSubstr("refinement " + std::to_string(int(refinement)) + ","));
    EXPECT_EQ(step.message.find("not met"), std::string::npos);
    EXPECT_EQ(step.seconds, refinement + 1);  // of all refinements
  }
}

TEST(ErrorLimit, ThatCannotBeMetIsSaidToBeSo) {
  const MechanicsStep step = last_step({.percent = 0.9 * tip_error(3)});
  EXPECT_EQ(step.status, Status::converged);
  EXPECT_THAT(step.message, HasSubstr("not met"));
  EXPECT_THAT(step.message, HasSubstr("refinement 3"));
}

TEST(ErrorLimit, ThatIsNotSetLeavesTheOptions) {
  const MechanicsStep step = last_step({});
  EXPECT_NEAR(*step.tip_uncertainty, 2 * L * std::sin(5e-3), 1e-15);
  EXPECT_EQ(step.message, "");
}

// The field falls off so fast that its error is ten times the tip's.
TEST(ErrorLimit, OfTheFieldIsThatOfItsChangeAtTheSensors) {
  const auto steep = [](const Deformation& deformation, const Vector3&) -> Vector3 {
    const Vector3 tip = deformation.centreline.at(L).position;
    return {std::pow(tip.x() / L, 10), 0, 0};
  };
  const std::vector<models::FieldEntry> fields{field_entry("steep", steep, Vector3::Zero(), true)};
  const double limit = 2 * tip_error(1);
  EXPECT_THAT(last_step({.percent = limit}).message, HasSubstr("refinement 1"));
  const MechanicsStep step = last_step({limit, ErrorLimit::Of::field}, fields);
  EXPECT_THAT(step.message, HasSubstr("refinement 2"));
  EXPECT_THAT(step.message, HasSubstr("of |dB|"));
}

TEST(ErrorLimit, OfAFieldThatIsNotKnownIsNotMet) {
  const auto any = [](const Deformation& deformation, const Vector3&) -> Vector3 {
    return deformation.centreline.at(L).position;
  };
  const std::vector<models::FieldEntry> fields{field_entry("any", any, std::nullopt, true)};
  EXPECT_THAT(last_step({50, ErrorLimit::Of::field}, fields).message, HasSubstr("not met"));
}

/// Finer meshes would not tell more, and the model's own remark stays.
TEST(ErrorLimit, StopsWhereTheErrorIsNotKnown) {
  input::Case problem = problem_with({.percent = 0.5 * tip_error(1)});
  problem.options.of<HalvingOptions>().last_known = 0;
  const MechanicsStep step = models::run_mechanics(halving(), problem, {}).result.steps.back();
  EXPECT_FALSE(step.tip_uncertainty);
  EXPECT_THAT(step.message, testing::StartsWith("it folds; refinement 1: the error is not known"));
}

TEST(ErrorLimit, EachRefinementHasACheckpointOfItsOwn) {
  Checkpoint::Entries kept;
  const Checkpoint checkpoint{{{"refinement 1: 1", "left"}},
                              [&](const Checkpoint::Entries& entries) {
                                for (const auto& [name, bytes] : entries) kept[name] = bytes;
                              }};
  models::run_mechanics(halving(), problem_with({.percent = 1.01 * tip_error(1)}), {}, {},
                        checkpoint);
  EXPECT_EQ(kept, (Checkpoint::Entries{{"refinement 0: 1", "0"}, {"refinement 1: 1", "1"}}));
}

// The one door: what it refuses is said by the entry, before the model runs.
TEST(Evaluator, RefusesWhatTheModelDoesNotTake) {
  models::MechanicsEntry entry = halving();
  entry.loads = {&ContactLoad::type()};
  const input::Case problem = problem_with({});
  const auto message = [&](const LoadPath& path) {
    try {
      models::Evaluator(entry, problem, {}).solve(problem.cilium, path);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("taken");
  };
  EXPECT_EQ(message(problem.load_path), "taken");
  EXPECT_EQ(message({FlowLoad{1, 0}}), "halving takes no load of the type 'flow'");
  EXPECT_EQ(message({with_environment(problem.load_path[0], {.gravity = {0, 0, -9.81}})}),
            "halving takes no environment");
  EXPECT_EQ(message({}), "taken");
  entry.check = [](const input::CaseCheck& check) {
    if (check.problem.load_path.size() > 1) check.report("load", "one step is enough");
  };
  EXPECT_EQ(message(problem.load_path), "halving: one step is enough");
}

// As in studies and in `sense`: the path is not that of the case.
TEST(Evaluator, RefinesWhateverPathItIsGiven) {
  const input::Case problem = problem_with({.percent = 1.01 * tip_error(2)});
  const auto entry = halving();
  const MechanicsResult result =
      models::Evaluator(entry, problem, {}).solve(problem.cilium, {ContactLoad{5e-3, 16e-3, 0}});
  ASSERT_EQ(result.steps.size(), 1U);
  EXPECT_THAT(result.steps[0].message, HasSubstr("refinement 2,"));
}

}  // namespace
}  // namespace ciliaval::test
