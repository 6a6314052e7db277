// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/models/errors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "problem/error.h"
#include "tests/support/synthetic.h"

namespace ciliaval::compare {
namespace {

using test::arc;
using test::converged;
using test::field_entry;
using test::mechanics_entry;
using test::paper_case;
using test::tilted;

using test::L;
const Vector3 ex = Vector3::UnitX();

const models::Comparison& find(const std::vector<models::Comparison>& all,
                               std::optional<std::size_t> step, const std::string& quantity,
                               const std::string& component, const std::string& statistic,
                               const std::string& model) {
  const auto it = std::find_if(all.begin(), all.end(), [&](const models::Comparison& c) {
    return c.step == step && c.quantity == quantity && c.component == component &&
           c.statistic == statistic && c.model == model;
  });
  if (it == all.end()) throw std::runtime_error("no comparison of " + quantity);
  return *it;
}

// Oracle: two straight lines through the base at angle δ are 2 S sin(δ/2) apart at S: largest at
// the tip, RMS over S is 2 sin(δ/2) L/√3. Rounding only: 1e-14 L.
TEST(CentrelineDistance, OfTwoTiltedLinesIsTheChordOfTheirAngle) {
  const models::CurveDistance d =
      models::distance(tilted(L, 3e-3, ex, 0.5), tilted(L, 7e-3, ex, 0.2));
  EXPECT_NEAR(d.largest, 2 * L * std::sin(0.15), 1e-14 * L);
  EXPECT_NEAR(d.rms, 2 * L * std::sin(0.15) / std::sqrt(3.0), 1e-14 * L);
}

// Oracle: for an arc of curvature k against the straight cilium |Δr|² = w² + (S − z)² with
// w = (1 − cos kS)/k, z = sin(kS)/k; the integral of it over S in closed form:
// ∫ = 2L/k² − 2 sin(kL)/k³ + L³/3 − (2/k)[sin(kL)/k² − L cos(kL)/k].
TEST(CentrelineDistance, OfAnArcFromTheStraightCiliumIsItsIntegral) {
  const double k = 60;
  const double integral = 2 * L / (k * k) - 2 * std::sin(k * L) / std::pow(k, 3) +
                          std::pow(L, 3) / 3 -
                          2 / k * (std::sin(k * L) / (k * k) - L * std::cos(k * L) / k);
  const models::CurveDistance d =
      models::distance(arc(L, 3e-3, ex, k), straight_centreline({0, 5e-3, L}));
  EXPECT_NEAR(d.rms, std::sqrt(integral / L), 1e-13 * L);
  EXPECT_NEAR(d.largest, std::hypot((1 - std::cos(k * L)) / k, L - std::sin(k * L) / k), 1e-14 * L);
}

// A distance that is largest between nodes and breaks must be seen: a bump sin²(πS/L) has its top
// at L/2 and vanishes at both ends. Oracle: its amplitude and RMS A √(3/8).
TEST(CentrelineDistance, SeesABumpBetweenTheEnds) {
  const double A = 1e-3;
  const auto bump = [&](double S) -> Vector3 {
    return S * Vector3::UnitZ() + A * std::pow(std::sin(M_PI * S / L), 2) * ex;
  };
  const Centreline curve = test::planar_curve(
      L, 6.1e-3, ex, bump, [](double) { return 0; }, [](double) { return 0; });
  const models::CurveDistance d = models::distance(curve, straight_centreline({0, L}));
  EXPECT_NEAR(d.largest, A, 1e-13);
  EXPECT_NEAR(d.rms, A * std::sqrt(3.0 / 8), 1e-13);
}

TEST(CentrelineDistance, RefusesCurvesOfDifferentLengths) {
  EXPECT_THROW(models::distance(tilted(L, 3e-3, ex, 0.1), tilted(1.01 * L, 3e-3, ex, 0.1)),
               InputError);
}

// Oracle: lines w = z tan α on N = 400 equal intervals of z: mean z² = (2N+1)/(6N) h², mean z =
// h/2.
TEST(DeflectionOverHeight, OfTwoTiltedLinesIsThatOfTwoStraightLines) {
  const double a = 0.5;
  const double b = 0.4;
  const double h = L * std::cos(a);  // the lower tip
  const double mean_square = 801.0 / 2400 * h * h;
  const auto result =
      models::compare_deflection(tilted(L, 3e-3, ex, a), tilted(L, 8e-3, ex, b), ex);
  ASSERT_TRUE(result);
  EXPECT_NEAR(result->rms, (std::tan(a) - std::tan(b)) * std::sqrt(mean_square), 1e-14 * L);
  EXPECT_NEAR(result->correlation, 1, 1e-14);  // proportional
  EXPECT_NEAR(result->deviation, std::tan(b) * std::sqrt(mean_square - h * h / 4), 1e-14 * L);
}

// Oracle: a circle, w = 1/k − √(1/k² − z²), at the same heights, against a straight cilium tilted
// by nothing. The arcs' S(z) has to be found; error left by the root-finder: 1e-13 L.
TEST(DeflectionOverHeight, FollowsACircle) {
  const double k = 50;
  const auto result =
      models::compare_deflection(straight_centreline({0, L}), arc(L, 3e-3, ex, k), ex);
  ASSERT_TRUE(result);
  const double top = std::sin(k * L) / k;
  double squares = 0;
  for (int i = 0; i <= 400; ++i)
    squares += std::pow(1 / k - std::sqrt(1 / (k * k) - std::pow(top * i / 400, 2)), 2) / 401;
  EXPECT_NEAR(result->rms, std::sqrt(squares), 1e-13 * L);
  EXPECT_TRUE(std::isnan(result->correlation));  // one of them is constant
}

// Oracle: r of z and of the circle's w(z) at the same heights, from the textbook's sums.
TEST(DeflectionOverHeight, CorrelatesALineWithACircle) {
  const double k = 50;
  const auto result = models::compare_deflection(tilted(L, 3e-3, ex, 0.3), arc(L, 3e-3, ex, k), ex);
  ASSERT_TRUE(result);
  const double top = std::sin(k * L) / k;
  double z = 0, w = 0, zz = 0, ww = 0, zw = 0;
  for (int i = 0; i <= 400; ++i) {
    const double zi = top * i / 400;
    const double wi = 1 / k - std::sqrt(1 / (k * k) - zi * zi);
    z += zi / 401;
    w += wi / 401;
    zz += zi * zi / 401;
    ww += wi * wi / 401;
    zw += zi * wi / 401;
  }
  EXPECT_NEAR(result->correlation, (zw - z * w) / std::sqrt((zz - z * z) * (ww - w * w)), 1e-11);
}

TEST(DeflectionOverHeight, IsUndefinedWhereTheCiliumHangsOver) {
  const Centreline over = arc(L, 3e-3, ex, 0.6 * M_PI / L);
  EXPECT_FALSE(models::compare_deflection(over, tilted(L, 3e-3, ex, 0.3), ex));
  EXPECT_FALSE(models::compare_deflection(tilted(L, 3e-3, ex, 0.3), over, ex));
}

// ------------------------------------------------------------------- the comparisons of a case

/// The fields of the models below: made so that every error is known in the head.
Vector3 tip_field(const Deformation& d, const Vector3&) {
  const Vector3 tip = d.centreline.at(d.centreline.length()).position;
  return {tip.x(), 0, 1};
}

models::MechanicsEntry tilt(const std::string& id, double factor,
                            std::optional<double> uncertainty = {}) {
  return mechanics_entry(id, [=](const Load& load) {
    return converged(load, tilted(L, 3e-3, ex, factor * magnitude(load)), uncertainty);
  });
}

models::CaseResult run_tilts(std::optional<double> rough_uncertainty,
                             std::optional<double> fine_uncertainty,
                             const std::optional<Vector3>& field_uncertainty,
                             const std::vector<double>& forces = {0.1, 0.2}) {
  input::Case c = paper_case(forces);
  c.mechanics = {"rough", "fine"};
  c.fields = {"tip"};
  const std::vector<models::MechanicsEntry> mechanics{tilt("rough", 1, rough_uncertainty),
                                                      tilt("fine", 2, fine_uncertainty)};
  const std::vector<models::FieldEntry> fields{field_entry("tip", tip_field, field_uncertainty)};
  return models::run(c, mechanics, fields);
}

// Oracle: tilts of 0.1 against 0.2 rad: chord, and tip deflection of the reference L sin 0.2.
TEST(Comparisons, OfMechanicsAreScaledByTheReferencesTipDeflection) {
  const auto all = models::compare_models(run_tilts(1e-6, 2e-6, {}));
  const double chord = 2 * L * std::sin(0.05);
  const double deflection = L * std::sin(0.2);
  const models::Comparison& largest = find(all, 0, "centreline", "", "maximum", "rough");
  EXPECT_EQ(largest.reference, "fine");
  EXPECT_NEAR(*largest.difference, chord, 1e-15);
  EXPECT_NEAR(*largest.scale, deflection, 1e-15);
  EXPECT_NEAR(*largest.relative, chord / deflection, 1e-13);
  EXPECT_NEAR(*find(all, 0, "centreline", "", "rms", "rough").relative,
              chord / deflection / std::sqrt(3.0), 1e-13);
  EXPECT_NEAR(*find(all, 0, "tip", "", "value", "rough").difference, chord, 1e-15);
  const models::Comparison& angle = find(all, 1, "tip_angle", "", "value", "rough");
  EXPECT_NEAR(*angle.difference, 0.2 - 0.4, 1e-14);
  EXPECT_NEAR(*angle.relative, -0.5, 1e-13);
  EXPECT_EQ(angle.unit, "rad");
  // 1 − R² = (tan 0.1 − tan 0.2)²/tan² 0.2 · mean z²/var z
  const double ratio = (std::tan(0.1) - std::tan(0.2)) / std::tan(0.2);
  const double mean_square = 801.0 / 2400;
  EXPECT_NEAR(*find(all, 0, "deflection", "", "r2", "rough").r2,
              1 - ratio * ratio * mean_square / (mean_square - 0.25), 1e-12);
}

TEST(Comparisons, AVerdictTakesBothUncertainties) {
  // The tips are 2 L sin 0.05 = 2.0 mm apart at the first step.
  const auto verdict = [](std::optional<double> a, std::optional<double> b) {
    return find(models::compare_models(run_tilts(a, b, {})), 0, "tip", "", "value", "rough")
        .verdict;
  };
  EXPECT_EQ(verdict(0.9e-3, 1.0e-3), models::Verdict::resolved);
  EXPECT_EQ(verdict(1.1e-3, 1.0e-3), models::Verdict::below_uncertainty);
  EXPECT_EQ(verdict(1.1e-3, std::nullopt), models::Verdict::inconclusive);
  EXPECT_EQ(verdict(std::nullopt, 0), models::Verdict::inconclusive);
}

// The angle's uncertainty is that of the tip in proportion: oracle, a chord 2 L sin(θ/2) of a tilt
// θ.
TEST(Comparisons, WholeCentrelinesAndAnglesHaveTheTipsUncertainty) {
  const auto all = models::compare_models(run_tilts(1e-6, 2e-6, {}));
  for (const char* statistic : {"maximum", "rms"})
    EXPECT_NEAR(*find(all, 0, "centreline", "", statistic, "rough").uncertainty, 3e-6, 1e-20);
  EXPECT_NEAR(*find(all, 0, "deflection", "", "r2", "rough").uncertainty, 3e-6, 1e-20);
  const models::Comparison& angle = find(all, 0, "tip_angle", "", "value", "rough");
  EXPECT_NEAR(*angle.uncertainty,
              0.1 * 1e-6 / (2 * L * std::sin(0.05)) + 0.2 * 2e-6 / (2 * L * std::sin(0.1)), 1e-15);
  EXPECT_EQ(angle.verdict, models::Verdict::resolved);
  EXPECT_FALSE(
      find(models::compare_models(run_tilts(1e-6, {}, {})), 0, "tip_angle", "", "value", "rough")
          .uncertainty);
}

// Two models of the same shape: every error is zero, R² is one, and nothing is resolved.
TEST(Comparisons, OfIdenticalModelsAreZero) {
  input::Case c = paper_case({0.1});
  c.mechanics = {"one", "other"};
  c.fields = {"tip"};
  const std::vector<models::MechanicsEntry> mechanics{tilt("one", 1, 1e-9), tilt("other", 1, 1e-9)};
  const std::vector<models::FieldEntry> fields{field_entry("tip", tip_field, Vector3(0, 0, 0))};
  const auto all = models::compare_models(models::run(c, mechanics, fields));
  ASSERT_EQ(all.size(), 5u + 6 + 6);
  for (const models::Comparison& comparison : all) {
    EXPECT_EQ(*comparison.difference, 0) << comparison.quantity;
    EXPECT_NE(comparison.verdict, models::Verdict::resolved);
  }
  EXPECT_EQ(*find(all, 0, "deflection", "", "r2", "one").r2, 1);
}

// Oracle: Bx is the tip's x: L sin θ, so ΔBx too; By vanishes; Bz is constant, ΔBz vanishes.
TEST(Comparisons, OfFieldsAreScaledByTheLargestOverThePathNeverByAComponent) {
  const auto all = models::compare_models(run_tilts({}, {}, {}));
  const double largest_dB = L * std::sin(0.4);
  const double largest_B = std::hypot(largest_dB, 1);
  const models::Comparison& dBx = find(all, 0, "dB", "x", "value", "rough/tip");
  EXPECT_EQ(dBx.reference, "fine/tip");
  EXPECT_NEAR(*dBx.difference, L * (std::sin(0.1) - std::sin(0.2)), 1e-15);
  EXPECT_NEAR(*dBx.scale, largest_dB, 1e-15);
  EXPECT_NEAR(*dBx.relative, L * (std::sin(0.1) - std::sin(0.2)) / largest_dB, 1e-13);
  EXPECT_NEAR(*find(all, 0, "B", "x", "value", "rough/tip").scale, largest_B, 1e-15);
  EXPECT_EQ(*find(all, 0, "dB", "y", "value", "rough/tip").relative, 0);
  EXPECT_EQ(dBx.verdict, models::Verdict::inconclusive);
  // RRMSE over the two steps.
  const double difference =
      std::hypot(std::sin(0.1) - std::sin(0.2), std::sin(0.2) - std::sin(0.4));
  const models::Comparison& rrmse = find(all, std::nullopt, "dB", "x", "rrmse", "rough/tip");
  EXPECT_NEAR(*rrmse.relative, difference / std::hypot(std::sin(0.2), std::sin(0.4)), 1e-13);
  EXPECT_NEAR(*rrmse.difference, L * difference / std::sqrt(2.0), 1e-15);
}

TEST(Comparisons, AreUndefinedAndSaySoWhereTheScaleVanishes) {
  const auto all = models::compare_models(run_tilts({}, {}, {}));
  const models::Comparison& y = find(all, std::nullopt, "dB", "y", "rrmse", "rough/tip");
  EXPECT_FALSE(y.relative);
  EXPECT_NE(y.note.find("vanishes"), std::string::npos);
  const auto unloaded = models::compare_models(run_tilts({}, {}, {}, {0.0}));
  for (const models::Comparison& c : unloaded)
    if (c.quantity != "B") {
      EXPECT_FALSE(c.relative) << c.quantity;
      EXPECT_NE(c.note.find("vanishes"), std::string::npos) << c.quantity;
    }
}

// Oracle: two field models on the same deformation differ by their own uncertainty only; on
// different deformations the tip's adds |ΔB| u/|tip displacement|, here with
// |tip displacement| = 2 L sin(θ/2) and |ΔB| = L sin θ.
TEST(Comparisons, CarryTheMechanicsUncertaintyIntoTheFieldOfDifferentMechanicsOnly) {
  const Vector3 u(1e-6, 2e-6, 3e-6);
  input::Case c = paper_case({0.1});
  c.mechanics = {"rough", "fine"};
  c.fields = {"one", "two"};
  const std::vector<models::MechanicsEntry> mechanics{tilt("rough", 1, 1e-5),
                                                      tilt("fine", 2, 3e-5)};
  const std::vector<models::FieldEntry> fields{field_entry("one", tip_field, u),
                                               field_entry("two", tip_field, u)};
  const auto all = models::compare_models(models::run(c, mechanics, fields));
  const auto uncertainty = [&](const char* model, const char* reference) {
    const auto it = std::find_if(all.begin(), all.end(), [&](const models::Comparison& x) {
      return x.step && x.quantity == "dB" && x.component == "y" && x.model == model &&
             x.reference == reference;
    });
    return *it->uncertainty;
  };
  // ΔB subtracts two fields: 2u for each model.
  EXPECT_NEAR(uncertainty("rough/one", "rough/two"), 4 * u.y(), 1e-18);
  const auto carried = [](double theta, double tip) {
    return L * std::sin(theta) * tip / (2 * L * std::sin(theta / 2));
  };
  // Rounding of the deformation: 16 ε of each B and of each B(undeformed) = e_z.
  const double rounding = 16 * std::numeric_limits<double>::epsilon() *
                          (std::hypot(1, L * std::sin(0.1)) + std::hypot(1, L * std::sin(0.2)) + 2);
  EXPECT_NEAR(uncertainty("rough/one", "fine/one"),
              4 * u.y() + carried(0.1, 1e-5) + carried(0.2, 3e-5) + rounding, 1e-18);
}

// Without a load nothing moves and nothing changes: the deformation carries no error into the field
// there, and the path has a verdict. Oracle: RMS over the two steps of the figures above.
TEST(Comparisons, AStepWithoutALoadLeavesThePathItsVerdict) {
  const auto all = models::compare_models(run_tilts(1e-6, 2e-6, Vector3(0, 0, 0), {0.0, 0.1}));
  const models::Comparison& unloaded = find(all, 0, "dB", "x", "value", "rough/tip");
  EXPECT_EQ(*unloaded.difference, 0);
  EXPECT_NEAR(*unloaded.uncertainty, 4 * 16 * std::numeric_limits<double>::epsilon(), 1e-17);
  EXPECT_EQ(unloaded.verdict, models::Verdict::below_uncertainty);
  const auto carried = [](double theta, double tip) {
    return L * std::sin(theta) * tip / (2 * L * std::sin(theta / 2));
  };
  const models::Comparison& path = find(all, std::nullopt, "dB", "x", "rrmse", "rough/tip");
  EXPECT_NEAR(*path.uncertainty, (carried(0.1, 1e-6) + carried(0.2, 2e-6)) / std::sqrt(2.0), 1e-13);
  EXPECT_EQ(path.verdict, models::Verdict::resolved);
}

// Two mechanics that agree to the last digits and claim to be exact: B ≈ 1 T differs by one ε.
TEST(Comparisons, RoundingIsNeverResolved) {
  input::Case c = paper_case({0.1});
  c.mechanics = {"one", "other"};
  c.fields = {"tip"};
  const double nudge = 1 + 4 * std::numeric_limits<double>::epsilon();
  const std::vector<models::MechanicsEntry> mechanics{tilt("one", 1, 0), tilt("other", nudge, 0)};
  const std::vector<models::FieldEntry> fields{field_entry(
      "tip",
      [](const Deformation& d, const Vector3&) -> Vector3 {
        return {d.centreline.at(L).position.x() / L, 0, 1};
      },
      Vector3(0, 0, 0))};
  const auto all = models::compare_models(models::run(c, mechanics, fields));
  const models::Comparison& dBx = find(all, 0, "dB", "x", "value", "one/tip");
  EXPECT_NE(*dBx.difference, 0);
  EXPECT_EQ(dBx.verdict, models::Verdict::below_uncertainty);
}

// Oracle: B = tip + x of every computable sensor, so ΔBx is the tip's x = L sin θ at each.
TEST(Comparisons, ASensorWhereTheFieldDivergesLeavesTheOthersCompared) {
  input::Case c = paper_case({0.1, 0.2});
  c.sensors = {Vector3(3, 0, 0), Vector3(1, 0, 0)};
  c.mechanics = {"rough", "fine"};
  c.fields = {"tip"};
  const std::vector<models::MechanicsEntry> mechanics{tilt("rough", 1, 1e-9),
                                                      tilt("fine", 2, 1e-9)};
  const std::vector<models::FieldEntry> fields{
      field_entry("tip", [](const Deformation& d, const Vector3& x) -> Vector3 {
        if (x.x() == 3) throw InputError("B diverges");
        return d.centreline.at(L).position;
      })};
  std::size_t compared = 0;
  for (const models::Comparison& x : models::compare_models(models::run(c, mechanics, fields))) {
    if (!x.sensor) continue;
    EXPECT_EQ(*x.sensor, 1u);
    if (x.quantity != "dB" || x.component != "x" || x.step != 0) continue;
    EXPECT_NEAR(*x.difference, L * (std::sin(0.1) - std::sin(0.2)), 1e-15);
    ++compared;
  }
  EXPECT_EQ(compared, 1u);
}

// Every pair once, the reference later in the registry, mechanics before fields.
TEST(Comparisons, TakeTheMoreDetailedModelAsTheReference) {
  input::Case c = paper_case({0.1});
  c.mechanics = {"b", "a"};  // asked for in the wrong order
  c.fields = {"v", "l"};
  const std::vector<models::MechanicsEntry> mechanics{tilt("a", 1), tilt("b", 2)};
  const std::vector<models::FieldEntry> fields{field_entry("l", tip_field),
                                               field_entry("v", tip_field)};
  std::vector<std::string> pairs;
  for (const models::Comparison& x : models::compare_models(models::run(c, mechanics, fields)))
    if (x.quantity == "tip" || (x.quantity == "B" && x.component == "x" && x.step))
      pairs.push_back(x.model + " " + x.reference);
  const std::vector<std::string> expected{"a b",     "a/l a/v", "a/l b/l", "a/v b/l",
                                          "a/l b/v", "a/v b/v", "b/l b/v"};
  EXPECT_EQ(pairs, expected);
}

}  // namespace
}  // namespace ciliaval::compare
