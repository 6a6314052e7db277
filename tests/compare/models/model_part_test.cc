// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/models/model_part.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "compare/models/registry.h"
#include "compare/output/results.h"
#include "compare/results/band.h"
#include "tests/support/synthetic.h"

namespace ciliaval::compare {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// A rod whose tip moves aside by `softness` F, and whose error is a micrometre; one that is
/// corrected by F, and by 0.1 F/2 more if its corrections are as wrong as they may be.
struct RodOptions {
  bool is_corrected = false;
  bool operator==(const RodOptions&) const = default;
};

class Rod : public MechanicsModel {
 public:
  Rod(double softness, bool is_corrected, double slips_off_at)
      : softness_(softness), is_corrected_(is_corrected), slips_off_at_(slips_off_at) {}

  MechanicsResult solve(const Cilium& cilium, const LoadPath& path,
                        const Progress&) const override {
    MechanicsResult result = solve_with(is_corrected_ ? 1 : softness_, cilium, path);
    if (is_corrected_) {
      result.companions.push_back(solve_with(1.05, cilium, path));
      result.error_parts.push_back({"joints", 1, 0, 1});
    }
    return result;
  }

 private:
  MechanicsResult solve_with(double softness, const Cilium& cilium, const LoadPath& path) const {
    MechanicsResult result{};
    result.undeformed.centreline = straight_centreline(cilium.interfaces());
    for (const Load& load : path) {
      const double F = magnitude(load);
      const double aside = softness * F;
      if (F > slips_off_at_) {
        MechanicsStep step;
        step.load = load;
        step.status = Status::slipped_off;
        step.slip_off_force = slips_off_at_;
        step.slip_off_uncertainty = 1e-5;
        result.steps.push_back(step);
        continue;
      }
      const double L = cilium.length();
      result.steps.push_back(test::converged(
          load,
          test::planar_curve(
              L, 3e-3, Vector3::UnitX(), [=](double S) { return Vector3(aside * S / L, 0, S); },
              [=](double) { return aside; }, [](double) { return 0; }),
          is_corrected_ ? 0.05 * F : 1e-6));
      result.steps.back().tip_angle_uncertainty = is_corrected_ ? 0.02 * F : 1e-6;
      result.steps.back().applied_force = F;
      result.steps.back().applied_force_uncertainty = 0;
    }
    return result;
  }

  double softness_;
  bool is_corrected_;
  double slips_off_at_;
};

/// The same, softer the higher its contact.
class RodAtHeight : public MechanicsModel {
 public:
  explicit RodAtHeight(bool is_corrected) : is_corrected_(is_corrected) {}
  MechanicsResult solve(const Cilium& cilium, const LoadPath& path,
                        const Progress& progress) const override {
    MechanicsResult result;
    for (const Load& load : path) {
      const double h = contact_height(load).value() / cilium.length();
      const Load larger = with_magnitude(load, (1 + h * h) * magnitude(load));
      MechanicsResult one = Rod(1, is_corrected_, 1).solve(cilium, {larger}, progress);
      result.undeformed = one.undeformed;
      result.steps.push_back(one.steps.front());
    }
    return result;
  }

 private:
  bool is_corrected_;
};

models::MechanicsEntry rod(std::string id, double softness, double slips_off_at = 1,
                           double corrected_slips_off_at = 1) {
  models::MechanicsEntry entry;
  entry.id = std::move(id);
  entry.make = [=](const input::ModelOptions& options) {
    const bool corrected = options.of<RodOptions>().is_corrected;
    return std::make_unique<Rod>(softness, corrected,
                                 corrected ? corrected_slips_off_at : slips_off_at);
  };
  entry.options = {input::flag(&RodOptions::is_corrected, "is_corrected", "Whether it is.")};
  entry.correct = [](input::ModelOptions& options) {
    options.of<RodOptions>().is_corrected = true;
  };
  return entry;
}

/// B = (tesla x_tip, 0, 0), known to 1e-9 T.
models::FieldEntry lamp(std::string id, double tesla) {
  return test::field_entry(
      std::move(id),
      [=](const Deformation& deformation, const Vector3&) -> Vector3 {
        const Centreline& line = deformation.centreline;
        return {tesla * line.at(line.length()).position.x(), 0, 0};
      },
      Vector3(1e-9, 0, 0));
}

models::CaseResult run(const std::vector<models::MechanicsEntry>& mechanics,
                       const std::vector<models::FieldEntry>& fields, bool corrected = false,
                       double force = 1e-3) {
  input::Case c = test::paper_case({force});
  c.options.of<RodOptions>().is_corrected = corrected;
  c.mechanics.clear();
  for (const auto& entry : mechanics) c.mechanics.push_back(entry.id);
  c.fields.clear();
  for (const auto& entry : fields) c.fields.push_back(entry.id);
  models::CaseResult result = models::run(c, mechanics, fields);
  models::add_model_parts(result, mechanics, fields);
  return result;
}

// By hand: the rod is 20 % softer than the corrected one, which knows itself to 5 %.
TEST(ModelPart, IsTheDifferenceFromTheCorrectedRodAndItsOwnError) {
  const models::CaseResult result = run({rod("rod", 1.2)}, {lamp("one", 0.3), lamp("best", 0.5)});
  const models::ShapeModelParts& parts = result.mechanics[0].model_parts.at(0);
  EXPECT_EQ(parts.unknown, "");
  EXPECT_NEAR(parts.tip.value().uncertainty(), 0.2e-3 + 0.05e-3, 1e-15);
  EXPECT_NEAR(parts.tip.value().band(1e-6), 0.25e-3 + 1e-6, 1e-15);
  EXPECT_NEAR(parts.tip_angle.value().uncertainty(), 0.2e-3 + 0.02e-3, 1e-15);
  EXPECT_EQ(parts.applied_force.value().uncertainty(), 0);
  // dB of rod/one is 0.3 · 1.2 mm, of the better pair 0.5 · 1 mm, whose tip is known to 5 %.
  const auto dB = results::field_bands(result, result.fields[0], 0, true).model.at(0).value();
  const double own = 2e-9;                 // of B and of the straight cilium's
  const double of_joints = 0.5 * 0.05e-3;  // in any direction
  EXPECT_NEAR(dB.x(), 0.14e-3 + own + of_joints, 1e-15);
  EXPECT_NEAR(dB.y(), own + of_joints, 1e-15);
  const std::string json = output::summary_json(result, {}, {}, "");
  EXPECT_THAT(json, HasSubstr("\"model_uncertainty\""));
  EXPECT_THAT(json, HasSubstr("\"dB_band\""));
}

TEST(ModelPart, OfACorrectedRodIsInItsNumericalErrorAlready) {
  const models::CaseResult result = run({rod("rod", 1.2)}, {}, true);
  const auto part = result.mechanics[0].model_parts.at(0).tip.value();
  EXPECT_NEAR(part.uncertainty(), 0.05e-3, 1e-15);
  EXPECT_NEAR(part.band(0.05e-3), 0.05e-3, 1e-15);
}

TEST(ModelPart, IsNotKnownWhereTheCorrectionsDoNotReach) {
  models::MechanicsEntry refuses = rod("rod", 1.2);
  refuses.check = [](const input::CaseCheck& check) {
    if (check.problem.options.of<RodOptions>().is_corrected) check.report("", "too short a stub");
  };
  const auto unknown = [](const models::CaseResult& result) {
    EXPECT_FALSE(result.mechanics[0].model_parts.at(0).tip);
    if (!result.fields.empty() && result.fields[0].steps[0]) {
      EXPECT_FALSE(results::field_bands(result, result.fields[0], 0, true).total.at(0));
      EXPECT_EQ(result.fields[0].steps[0]->model_part_unknown,
                result.mechanics[0].model_parts.at(0).unknown);
    }
    return result.mechanics[0].model_parts.at(0).unknown;
  };
  EXPECT_EQ(unknown(run({refuses}, {})), "rod: too short a stub");
  EXPECT_THAT(unknown(run({rod("rod", 1.2, 1, 0.5e-3)}, {})), HasSubstr("has no equilibrium"));
  EXPECT_THAT(unknown(run({rod("rod", 1.2, 0.5e-3)}, {})), HasSubstr("has an equilibrium"));
  models::MechanicsEntry solid = rod("body", 1);
  solid.correct = nullptr;
  EXPECT_THAT(unknown(run({solid}, {})), HasSubstr("only rods"));
}

TEST(ModelPart, OfTheRangeIsThatOfTheTwoLimits) {
  const models::CaseResult result = run({rod("rod", 1.2, 0.9e-3, 0.8e-3)}, {});
  const auto part = result.mechanics[0].model_parts.at(0).slip_off.value();
  EXPECT_NEAR(part.uncertainty(), 0.1e-3 + 1e-5, 1e-15);
}

// Its tip goes by (1 + (h/L)²) F aside; the kernel's variance is w² (1/3 − 2/π²), w = 0.5 mm.
TEST(ModelPart, HasWhatAContactOfSomeWidthMakes) {
  models::MechanicsEntry at_height = rod("rod", 1);
  at_height.make = [](const input::ModelOptions& options) {
    const bool corrected = options.of<RodOptions>().is_corrected;
    return std::make_unique<RodAtHeight>(corrected);
  };
  const models::CaseResult result = run({at_height}, {});
  const double variance = std::pow(0.5e-3, 2) * (1.0 / 3 - 2 / std::pow(std::numbers::pi, 2));
  const double F = 1e-3;
  EXPECT_NEAR(result.mechanics[0].model_parts.at(0).tip.value().difference,
              F * variance / std::pow(test::L, 2), 1e-12);
}

// The better model of all is the last rod that takes the case, corrected.
TEST(ModelPart, HoldsAllRodsAgainstTheMostDetailedOne) {
  models::MechanicsEntry other = rod("other", 1.1);
  const models::CaseResult result = run({rod("rod", 1.2), other}, {});
  EXPECT_NEAR(result.mechanics[0].model_parts.at(0).tip.value().difference, 0.2e-3, 1e-15);
  EXPECT_NEAR(result.mechanics[1].model_parts.at(0).tip.value().difference, 0.1e-3, 1e-15);
}

TEST(Reference, IsACorrectedRodBeforeAPlainOne) {
  struct OtherOptions {
    bool is_corrected = false;
  };
  models::MechanicsEntry plain = rod("plain", 1.1);
  plain.options = {input::flag(&OtherOptions::is_corrected, "is_corrected", "Whether it is.")};
  plain.correct = [](input::ModelOptions& options) {
    options.of<OtherOptions>().is_corrected = true;
  };
  std::vector<std::string> order;
  for (const auto& of : run({rod("corrected", 1.2), plain}, {}, true).mechanics)
    order.push_back(of.model);
  EXPECT_THAT(order, ElementsAre("plain", "corrected"));
}

}  // namespace
}  // namespace ciliaval::compare
