// SPDX-License-Identifier: LGPL-2.1-or-later
// Errors of tip, angle, force and fields by a result's companions.
#include "problem/error_estimate.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "compare/models/errors.h"
#include "compare/models/run.h"
#include "compare/results/quantity.h"
#include "tests/support/synthetic.h"

namespace ciliaval::test {
namespace {

using namespace compare;

/// A straight line that leans by the angle.
Centreline leaning(double angle) {
  const Quaternion turn(Eigen::AngleAxisd(angle, Vector3::UnitY()));
  Centreline::Piece piece;
  for (const double S : {0.0, 3e-3, L})
    piece.states.push_back({.position = turn * Vector3(0, 0, S), .rotation = turn});
  piece.S = {0, 3e-3, L};
  return Centreline({piece});
}

/// A solution of one step, with the force.
MechanicsResult solution_of(double angle, double force) {
  MechanicsResult result{{leaning(0), nullptr},
                         {converged(ContactLoad{1e-3, 16e-3, 0}, leaning(angle))}};
  result.steps.front().applied_force = force;
  return result;
}

/// A result with two companions: 0.1 is estimated from 0.12 and, with twice the difference, from
/// 0.12 against 0.15.
models::MechanicsRun run_with_companions() {
  models::MechanicsRun run{"meshes", solution_of(0.1, 1.0)};
  run.result.companions = {solution_of(0.12, 1.1), solution_of(0.15, 1.4)};
  run.result.error_parts = {{"one", 0, 1, 0.5}, {"other", 1, 2, 2}};
  return run;
}

/// The tip's position.
Vector3 tip_field(const Deformation& deformation, const Vector3& /*x*/) {
  return deformation.centreline.at(L).position;
}

double distance_of_tips(double a, double b) {
  return 2 * L * std::sin(std::abs(a - b) / 2);
}

TEST(ErrorEstimate, IsTheSumOfThePartsAndOfTheAlgebraicError) {
  models::MechanicsRun run = run_with_companions();
  run.result.algebraic_error = 1e-3;
  estimate_errors(run.result);
  const MechanicsStep& step = run.result.steps.front();
  EXPECT_NEAR(*step.tip_angle_uncertainty, 0.5 * 0.02 + 2 * 0.03 + 1e-3, 1e-14);
  EXPECT_NEAR(*step.applied_force_uncertainty, 0.5 * 0.1 + 2 * 0.3, 1e-13);  // it is prescribed
  EXPECT_NEAR(*step.tip_uncertainty,
              0.5 * distance_of_tips(0.1, 0.12) + 2 * distance_of_tips(0.12, 0.15) + 1e-3 * L,
              1e-16);
  EXPECT_EQ(results::tip_angle_uncertainty(run.result.steps[0]), step.tip_angle_uncertainty);
}

TEST(ErrorEstimate, OfAProbesForceHasTheAlgebraicError) {
  models::MechanicsRun run = run_with_companions();
  run.result.algebraic_error = 1e-3;
  run.result.steps.front().load = ProbeLoad{1e-3, 16e-3, 0};
  estimate_errors(run.result);
  EXPECT_NEAR(*run.result.steps.front().applied_force_uncertainty, 0.5 * 0.1 + 2 * 0.3 + 1e-3,
              1e-13);
}

TEST(ErrorEstimate, OfTheSlipOffIsThatOfTheCompanionsLimits) {
  models::MechanicsRun run = run_with_companions();
  run.result.algebraic_error = 1e-3;
  estimate_errors(run.result);
  EXPECT_FALSE(run.result.steps.front().slip_off_uncertainty);  // there is no limit
  run.result.steps.front().slip_off_force = 5;
  run.result.companions[0].steps.front().slip_off_force = 5.2;
  estimate_errors(run.result);
  EXPECT_FALSE(run.result.steps.front().slip_off_uncertainty);  // one companion has none
  run.result.companions[1].steps.front().slip_off_force = 5.3;
  estimate_errors(run.result);
  EXPECT_NEAR(*run.result.steps.front().slip_off_uncertainty, 0.5 * 0.2 + 2 * 0.1 + 5e-3, 1e-14);
}

TEST(ErrorEstimate, IsUnknownWithoutPartsAndWhereACompanionHasNotConverged) {
  models::MechanicsRun run = run_with_companions();
  run.result.companions[1].steps.front() = MechanicsStep{};
  estimate_errors(run.result);
  EXPECT_FALSE(run.result.steps.front().tip_uncertainty);
  EXPECT_FALSE(run.result.steps.front().applied_force_uncertainty);
  MechanicsResult alone = solution_of(0.1, 1);
  estimate_errors(alone);
  EXPECT_FALSE(alone.steps.front().tip_uncertainty);
}

TEST(ErrorEstimate, OfAFieldIsThatOfItsChangeFromSolutionToSolution) {
  const models::MechanicsRun run = run_with_companions();
  const input::Case problem = paper_case({1e-3});
  const FormulaField field(tip_field, Vector3(1e-9, 0, 0));
  const models::FieldRun fields = models::run_field("tip", field, run, problem);
  const double expected = 0.5 * distance_of_tips(0.1, 0.12) + 2 * distance_of_tips(0.12, 0.15);
  EXPECT_NEAR(*fields.steps[0]->from_mechanics[0], expected, 1e-16);
  EXPECT_NEAR(*fields.steps[0]->dB_from_mechanics[0], expected, 1e-16);
  EXPECT_EQ(*fields.undeformed.from_mechanics[0], 0);
  EXPECT_NEAR(*models::change_uncertainty(run, fields, 0, 0), expected + 2e-9, 1e-16);
}

TEST(ErrorEstimate, OfAFieldIsUnknownWhereACompanionHasNone) {
  models::MechanicsRun run = run_with_companions();
  run.result.companions[0].steps.front() = MechanicsStep{};
  const FormulaField field(tip_field, Vector3(1e-9, 0, 0));
  const models::FieldRun fields = models::run_field("tip", field, run, paper_case({1e-3}));
  EXPECT_TRUE(fields.steps[0]->B[0]);
  EXPECT_FALSE(fields.steps[0]->from_mechanics[0]);
  EXPECT_FALSE(models::change_uncertainty(run, fields, 0, 0));
  EXPECT_EQ(*fields.undeformed.from_mechanics[0], 0);
}

/// A dear model of ten times the tip, whose changes the tip stands for.
class Dear : public FieldModel {
 public:
  Field field(const Cilium& /*cilium*/, const Deformation& deformation,
              std::span<const Vector3> points) const override {
    ++calls;
    Field result;
    for (const Vector3& x : points) result.B.emplace_back(10 * tip_field(deformation, x));
    return result;
  }
  const FieldModel& for_differences() const override { return cheap_; }
  mutable int calls = 0;

 private:
  FormulaField cheap_{tip_field, std::nullopt};
};

TEST(ErrorEstimate, OfADearFieldIsThatOfTheCheapOneInItsPlace) {
  const Dear dear;
  const models::FieldRun fields =
      models::run_field("dear", dear, run_with_companions(), paper_case({1e-3}));
  EXPECT_EQ(dear.calls, 2);  // the undeformed cilium and the step
  EXPECT_NEAR(*fields.steps[0]->from_mechanics[0],
              0.5 * distance_of_tips(0.1, 0.12) + 2 * distance_of_tips(0.12, 0.15), 1e-16);
}

}  // namespace
}  // namespace ciliaval::test
