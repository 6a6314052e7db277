// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/claims/claim.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>

#include "analytic/elastica/elastica.h"
#include "analytic/rod/field_models.h"
#include "compare/claims/misprint.h"
#include "tests/support/program.h"

namespace ciliaval::compare {
namespace {

using testing::HasSubstr;

TEST(Claims, AFindingHoldsFailsOrIsUndecidedWithinItsUncertainty) {
  EXPECT_EQ(claims::in_range("a", {1, 2}, "", 0.5, 2.5).holds, true);
  EXPECT_EQ(claims::in_range("a", {1, 2}, "", 1.5, 2.5).holds, false);
  EXPECT_EQ(claims::in_range("a", {1, 2, 0.1}, "", 0.95, 2.5).holds, std::nullopt);
  EXPECT_EQ(claims::in_range("a", {1, 2, 0.1}, "", 1.05, 2.5).holds, std::nullopt);
  EXPECT_EQ(claims::in_range("a", {1, 2, 0.1}, "", 1.2, 2.5).holds, false);
  EXPECT_EQ(claims::in_range("a", {std::nan(""), 2}, "", 0, 3).holds, false);
}

TEST(Claims, TheVerdictIsThatOfTheFindings) {
  const claims::Evidence yes{"a", {1, 1}, "", true};
  const claims::Evidence no{"b", {1, 1}, "", false};
  const claims::Evidence open = claims::in_range("c", {1, 1, 0.1}, "", 1.05, 2);
  const auto verdict = [](std::vector<claims::Evidence> findings) {
    return claims::Claim{"1", "s", "", std::move(findings)}.verdict();
  };
  EXPECT_EQ(verdict({yes, yes}), claims::ClaimVerdict::reproduced);
  EXPECT_EQ(verdict({yes, open}), claims::ClaimVerdict::reproduced);
  EXPECT_EQ(verdict({no, open}), claims::ClaimVerdict::not_reproduced);
  EXPECT_EQ(verdict({yes, no}), claims::ClaimVerdict::depends_on_the_model);
  EXPECT_EQ(verdict({open}), claims::ClaimVerdict::not_checkable);
  EXPECT_EQ(verdict({}), claims::ClaimVerdict::not_checkable);
}

// Oracle: the closed forms of the same integrals; and of a straight cilium, where cos θ = 1, the
// equations as printed are right.
TEST(Misprints, TheEquationsAsMeantAreTheModels) {
  const input::Case problem = test::paper_case({3e-3});
  const MechanicsResult elastica =
      analytic::elastica::Elastica().solve(problem.cilium, problem.load_path);
  const Vector3 x = problem.sensors.front();
  const Deformation& bent = *elastica.steps.front().deformation;
  const claims::PrintedFields fields = claims::printed_fields(problem.cilium, bent.centreline, x);
  const auto model = [&](const FieldModel& field) {
    return field.field(problem.cilium, bent, problem.sensors).B.front();
  };
  const Vector3 line = model(analytic::rod::LineField());
  const Vector3 volume =
      model(analytic::rod::VolumeField({.slices = analytic::rod::VolumeOptions::Slices::stacked}));
  EXPECT_LT((fields.line - line).norm(), 1e-8 * line.norm());
  EXPECT_LT((fields.volume - volume).norm(), 1e-6 * volume.norm());
  EXPECT_EQ(fields.line_printed.x(), fields.line.x());
  EXPECT_GT(std::abs(fields.line_printed.z() / fields.line.z()), 1.001);
  const claims::PrintedFields straight =
      claims::printed_fields(problem.cilium, elastica.undeformed.centreline, x);
  EXPECT_EQ(straight.line_printed, straight.line);
  EXPECT_EQ(straight.volume_printed, straight.volume);
}

// The program's ledger: every claim with a verdict, and the arithmetic ones as anyone can check.
TEST(Claims, TheLedgerJudgesEveryClaimOfThePaper) {
  const test::TemporaryFolder folder;
  const test::Outcome outcome =
      test::run_program(folder.path(), "claims --quick --json claims.json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto claims =
      nlohmann::json::parse(test::read_text(folder.path() / "claims.json"))["claims"];
  ASSERT_GE(claims.size(), 25u);
  const auto claim = [&](const std::string& part) -> const nlohmann::json& {
    for (const auto& c : claims)
      if (c["statement"].get<std::string>().find(part) != std::string::npos) return c;
    throw std::out_of_range(part);
  };
  EXPECT_EQ(claim("0.375 N/m")["verdict"], "reproduced");
  EXPECT_EQ(claim("two orders of magnitude")["verdict"], "not reproduced");  // 30
  EXPECT_NEAR(claim("two orders")["findings"][0]["low"].get<double>(), std::log10(30), 1e-12);
  EXPECT_EQ(claim("measured B_x")["verdict"], "not checkable");
  EXPECT_THAT(claim("measured B_x")["note"].get<std::string>(), HasSubstr("not published"));
  EXPECT_EQ(claim("falls as E1 grows")["verdict"], "reproduced");
  // Section 3.6: these are what the models find on the assumed surfaces, not what the paper says.
  EXPECT_EQ(claim("negative bending leads directly")["verdict"], "reproduced");
  EXPECT_EQ(claim("four textures")["findings"].size(), 4U);
  EXPECT_THAT(claim("four textures")["note"].get<std::string>(), HasSubstr("assumed"));
  for (const auto& c : claims)
    for (const auto& f : c["findings"]) {
      EXPECT_FALSE(f["low"].is_null()) << c;
      const double off = f["uncertainty"];
      EXPECT_TRUE(std::isfinite(off) && off >= 0) << c;
      // What pairs of models find has an interval, but for R² and rates.
      const std::string models = f["models"];
      if (models.find(": dB") != std::string::npos || models.find(": peak") != std::string::npos ||
          models.ends_with(": B")) {
        EXPECT_GT(off, 0) << c;
      }
    }
  EXPECT_THAT(outcome.out, HasSubstr("claims: "));
}

// With a beam of two short elements the intervals widen, and hold what the fine beam finds. Oracle:
// the beam of degree 6 of the shipped case.
TEST(Claims, TheIntervalsOfACoarseBeamHoldTheFineBeams) {
  const test::TemporaryFolder folder;
  const std::filesystem::path shipped =
      std::filesystem::path(CILIAVAL_SOURCE_DIR) / "cases/paper/fig3d.toml";
  std::ofstream(folder.path() / "fig3d.toml")
      << test::read_text(shipped) << "\n[models.beam]\ndegree = 2\n";
  const std::vector<claims::Claim> coarse = claims::model_claims(folder.path(), false, {});
  const std::vector<claims::Claim> fine = claims::model_claims(shipped.parent_path(), false, {});
  ASSERT_EQ(coarse.size(), fine.size());
  int compared = 0;
  for (std::size_t i = 0; i < fine.size(); ++i)
    for (std::size_t j = 0; j < fine[i].evidence.size(); ++j) {
      const claims::Evidence& a = coarse[i].evidence[j];
      const claims::Evidence& b = fine[i].evidence[j];
      ASSERT_EQ(a.models, b.models);
      if (a.models.find("beam") == std::string::npos || a.unit == "s") continue;
      ++compared;
      const claims::Span& c = a.values;
      const claims::Span& f = b.values;
      const double off = c.uncertainty + f.uncertainty;
      EXPECT_GE(c.uncertainty, f.uncertainty) << a.models;
      EXPECT_LE(std::abs(c.low - f.low), off) << a.models;
      EXPECT_LE(std::abs(c.high - f.high), off) << a.models;
      std::printf("%s: off by %.1e, interval %.1e\n", a.models.c_str(),
                  std::max(std::abs(c.low - f.low), std::abs(c.high - f.high)), c.uncertainty);
    }
  EXPECT_EQ(compared, 9);
}

}  // namespace
}  // namespace ciliaval::compare
