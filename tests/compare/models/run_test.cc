// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/models/run.h"

#include <gtest/gtest.h>

#include <limits>
#include <memory>

#include "compare/models/errors.h"
#include "compare/models/registry.h"
#include "compare/output/table.h"
#include "problem/error.h"
#include "tests/support/synthetic.h"

namespace ciliaval::compare {
namespace {

using test::arc;
using test::converged;
using test::field_entry;
using test::mechanics_entry;
using test::paper_case;

using test::L;

/// Dipole of unit moment at the tip along the tip's normal (Eq. 5).
Vector3 tip_dipole(const Deformation& d, const Vector3& point) {
  const CentrelinePoint tip = d.centreline.at(d.centreline.length());
  const Vector3 a = point - tip.position;
  const Vector3 m = tip.normal();
  return 1e-7 * (3 * m.dot(a) * a / std::pow(a.norm(), 5) - m / std::pow(a.norm(), 3));
}

models::MechanicsEntry bend(const std::string& id) {
  return mechanics_entry(id, [](const Load& load) {
    return converged(load, arc(L, 3e-3, Vector3::UnitX(), 1e4 * magnitude(load)));
  });
}

// Oracle: Eq. 5 by hand for a dipole above the sensor at the origin: B = μ₀/4π · 2m/z³ e_z.
TEST(Run, SubtractsTheFieldOfTheUndeformedCilium) {
  input::Case c = paper_case({1e-3});
  c.sensors = {Vector3::Zero()};
  c.mechanics = {"bend"};
  c.fields = {"dipole"};
  const std::vector<models::MechanicsEntry> mechanics{bend("bend")};
  const std::vector<models::FieldEntry> fields{field_entry("dipole", tip_dipole)};
  const models::CaseResult result = models::run(c, mechanics, fields);
  ASSERT_EQ(result.fields.size(), 1u);
  const models::FieldRun& field = result.fields[0];
  EXPECT_EQ(field.name(), "bend/dipole");
  const Vector3 B0(0, 0, 1e-7 * 2 / std::pow(L, 3));
  EXPECT_LT((*field.undeformed.B[0] - B0).norm(), 1e-14 * B0.norm());
  const Deformation& bent = *result.mechanics[0].result.steps[0].deformation;
  const Vector3 dB = tip_dipole(bent, Vector3::Zero()) - B0;
  EXPECT_GT(dB.norm(), 0.01 * B0.norm());
  EXPECT_LT((*field.steps[0]->dB[0] - dB).norm(), 1e-14 * B0.norm());
  EXPECT_TRUE(models::all_solved(result));
}

TEST(Run, RecordsWhatAModelThrowsAndGoesOnWithTheOthers) {
  input::Case c = paper_case({1e-3, 2e-3});
  c.mechanics = {"broken", "bend"};
  c.fields = {"bad", "dipole"};
  const std::vector<models::MechanicsEntry> mechanics{
      mechanics_entry("broken",
                      [](const Load&) -> MechanicsStep { throw SolverError("no equilibrium"); }),
      bend("bend")};
  const std::vector<models::FieldEntry> fields{
      field_entry("bad",
                  [](const Deformation&, const Vector3&) -> Vector3 {
                    throw InputError("the sensor is on the rim");
                  }),
      field_entry("dipole", tip_dipole)};
  const models::CaseResult result = models::run(c, mechanics, fields);
  ASSERT_EQ(result.mechanics.size(), 2u);
  for (const MechanicsStep& step : result.mechanics[0].result.steps) {
    EXPECT_EQ(step.status, Status::failed);
    EXPECT_EQ(step.message, "no equilibrium");
  }
  EXPECT_EQ(result.mechanics[0].result.steps.size(), 2u);
  EXPECT_EQ(result.mechanics[1].result.steps[1].status, Status::converged);
  ASSERT_EQ(result.fields.size(), 2u);  // of `bend` only
  EXPECT_EQ(result.fields[0].steps[0]->failure, "the sensor is on the rim");
  EXPECT_TRUE(result.fields[1].steps[0]->failure.empty());
  EXPECT_FALSE(models::all_solved(result));
}

/// Refuses all points if one is at x = 3, and for the straight cilium if one is at x = 2.
Vector3 singular(const Deformation& d, const Vector3& x) {
  const bool straight = d.centreline.at(L).position.x() == 0;
  if (x.x() == 3 || (straight && x.x() == 2)) throw InputError("B diverges on the rim");
  return d.centreline.at(L).position + x;
}

// Sensors 1 and 3 are never computable, sensor 4 only where the cilium is bent: it has B, not ΔB.
TEST(Run, ASensorWhereTheFieldDivergesLeavesTheOthers) {
  input::Case c = paper_case({1e-3, 2e-3});
  c.sensors = {Vector3(1, 0, 0), Vector3(3, 0, 0), Vector3(4, 0, 0), Vector3(3, 1, 0),
               Vector3(2, 0, 0)};
  c.mechanics = {"bend"};
  c.fields = {"singular"};
  const std::vector<models::MechanicsEntry> mechanics{bend("bend")};
  const std::vector<models::FieldEntry> fields{
      field_entry("singular", singular, Vector3(1e-9, 0, 0))};
  const models::CaseResult result = models::run(c, mechanics, fields);
  const models::FieldRun& field = result.fields.at(0);
  for (std::size_t i = 0; i < 2; ++i) {
    const models::FieldStep& step = *field.steps[i];
    const Deformation& bent = *result.mechanics[0].result.steps[i].deformation;
    const Vector3 tip = bent.centreline.at(L).position;
    ASSERT_EQ(step.B.size(), 5u);
    for (const std::size_t good : {0u, 2u, 4u}) {
      EXPECT_EQ(step.B[good].value(), tip + c.sensors[good]);
      EXPECT_EQ(step.uncertainty[good].value(), Vector3(1e-9, 0, 0));
    }
    for (const std::size_t good : {0u, 2u}) {
      EXPECT_LT((step.dB[good].value() - (tip - Vector3(0, 0, L))).norm(), 1e-14);
      EXPECT_EQ(step.dB_uncertainty[good].value(), Vector3(2e-9, 0, 0));
    }
    for (const std::size_t bad : {1u, 3u}) EXPECT_FALSE(step.B[bad] || step.dB[bad]);
    EXPECT_FALSE(step.dB[4] || step.dB_uncertainty[4]);
    EXPECT_EQ(step.failure,
              "sensors 1, 3: B diverges on the rim; "
              "undeformed cilium: sensors 1, 3, 4: B diverges on the rim");
  }
  EXPECT_EQ(field.undeformed.dB[0].value(), Vector3(0, 0, 0));
  EXPECT_FALSE(field.undeformed.dB[4]);
  EXPECT_FALSE(models::all_solved(result));  // exit code 3: values are missing
}

/// B whose error is not known, and says why.
class Untested : public FieldModel {
 public:
  Field field(const Cilium&, const Deformation& deformation,
              std::span<const Vector3> points) const override {
    Field field;
    for (const Vector3& x : points) field.B.push_back(tip_dipole(deformation, x));
    field.remark = "the estimate is not tested here";
    return field;
  }
};

TEST(Run, AnErrorThatAFieldModelDoesNotKnowIsNoneAndSaidWhy) {
  input::Case c = paper_case({1e-3});
  c.mechanics = {"bend"};
  c.fields = {"untested", "dipole"};
  models::FieldEntry untested = field_entry("untested", tip_dipole);
  untested.make = [](const input::ModelOptions&) { return std::make_unique<Untested>(); };
  const std::vector<models::MechanicsEntry> mechanics{bend("bend")};
  const std::vector<models::FieldEntry> fields{untested,
                                               field_entry("dipole", tip_dipole, Vector3::Zero())};
  const models::CaseResult result = models::run(c, mechanics, fields);
  const models::FieldStep& step = *result.fields.at(0).steps[0];
  EXPECT_TRUE(step.B[0] && step.dB[0]);
  EXPECT_FALSE(step.uncertainty[0] || step.dB_uncertainty[0]);
  EXPECT_EQ(step.remark, "the estimate is not tested here");
  EXPECT_TRUE(models::all_solved(result));
  for (const models::Comparison& comparison : models::compare_models(result))
    if (comparison.quantity == "dB" || comparison.quantity == "B") {
      EXPECT_EQ(comparison.verdict, models::Verdict::inconclusive);
      EXPECT_FALSE(comparison.uncertainty);
    }
  const std::string text =
      output::table(result, models::compare_models(result), output::Footnotes::reference);
  EXPECT_NE(text.find(" ? "), std::string::npos);
  EXPECT_NE(text.find("bend/untested: the estimate is not tested here"), std::string::npos);
}

/// One system for all points: its solver fails, or it refuses the points at x = 3.
class Coupled : public FieldModel {
 public:
  Coupled(bool fails, int& calls) : fails_(fails), calls_(calls) {}
  bool pointwise() const override { return false; }
  Field field(const Cilium&, const Deformation&, std::span<const Vector3> points) const override {
    ++calls_;
    if (fails_) throw SolverError("the accuracy is not reached");
    for (const Vector3& x : points)
      if (x.x() == 3) throw InputError("the sensor is in the magnet");
    return {{points.begin(), points.end()}, {}};
  }

 private:
  bool fails_;
  int& calls_;
};

// Its solutions take long: after a failure of the solver it is asked no second time.
TEST(Run, AModelOfOneSystemIsAskedAgainOnlyIfItRefusesSensors) {
  input::Case c = paper_case({1e-3});
  c.sensors = {Vector3(1, 0, 0), Vector3(3, 0, 0), Vector3(4, 0, 0)};
  c.mechanics = {"bend"};
  c.fields = {"coupled"};
  const std::vector<models::MechanicsEntry> mechanics{bend("bend")};
  int calls = 0;
  const auto run_coupled = [&](bool fails) {
    calls = 0;
    const models::FieldEntry entry{"coupled", "", [&calls, fails](const input::ModelOptions&) {
                                     return std::make_unique<Coupled>(fails, calls);
                                   }};
    return models::run(c, mechanics, std::vector<models::FieldEntry>{entry})
        .fields.at(0)
        .steps.at(0)
        .value();
  };
  const models::FieldStep failed = run_coupled(true);
  EXPECT_EQ(calls, 2);  // the straight and the bent cilium
  EXPECT_EQ(failed.B.size(), 3u);
  EXPECT_FALSE(failed.any());
  EXPECT_EQ(failed.failure, "the accuracy is not reached");
  const models::FieldStep refused = run_coupled(false);
  EXPECT_EQ(calls, 10);  // all, sensor 0, sensors 1 and 2, 1, 2, of both
  EXPECT_TRUE(refused.B[0] && !refused.B[1] && refused.B[2]);
}

TEST(Run, TakesAFieldOrAShapeThatIsNotFiniteForAFailure) {
  input::Case c = paper_case({1e-3});
  c.mechanics = {"nan", "bend"};
  c.fields = {"nan"};
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<models::MechanicsEntry> mechanics{
      mechanics_entry("nan",
                      [=](const Load& load) {
                        Centreline::Piece piece{{0, L}, std::vector<SectionState>(2)};
                        piece.states[1].position = Vector3(nan, 0, L);
                        return converged(load, Centreline({piece}));
                      }),
      bend("bend")};
  const std::vector<models::FieldEntry> fields{
      field_entry("nan", [=](const Deformation&, const Vector3&) -> Vector3 {
        return {nan, 0, 0};
      })};
  const models::CaseResult result = models::run(c, mechanics, fields);
  EXPECT_EQ(result.mechanics[0].result.steps[0].status, Status::failed);
  EXPECT_FALSE(result.mechanics[0].result.steps[0].deformation);
  EXPECT_FALSE(result.fields.back().steps[0]->failure.empty());
  EXPECT_FALSE(result.fields.back().steps[0]->any());
}

TEST(Run, ASlipOffIsAResultWithoutAFieldAndNoFailure) {
  input::Case c = paper_case({1e-3, 9e-3});
  c.mechanics = {"slips"};
  c.fields = {"dipole"};
  const std::vector<models::MechanicsEntry> mechanics{
      mechanics_entry("slips", [](const Load& load) {
        if (magnitude(load) < 5e-3) return converged(load, arc(L, 3e-3, Vector3::UnitX(), 20));
        MechanicsStep step;
        step.load = load;
        step.status = Status::slipped_off;
        step.slip_off_force = 5.8e-3;
        return step;
      })};
  const std::vector<models::FieldEntry> fields{field_entry("dipole", tip_dipole)};
  const models::CaseResult result = models::run(c, mechanics, fields);
  EXPECT_TRUE(models::all_solved(result));
  EXPECT_TRUE(result.fields[0].steps[0]);
  EXPECT_FALSE(result.fields[0].steps[1]);
}

TEST(Run, AFieldModelThatNeedsABodyRunsOnlyWhereThereIsOne) {
  input::Case c = paper_case({1e-3});
  c.mechanics = {"rod", "body"};
  c.fields = {"mesh"};
  const std::vector<models::MechanicsEntry> mechanics{
      bend("rod"), mechanics_entry("body", [](const Load& load) {
        MechanicsStep step = converged(load, arc(L, 3e-3, Vector3::UnitX(), 20));
        step.deformation->body = std::make_shared<SolidBody>(test::BentBricks::body());
        return step;
      })};
  const std::vector<models::FieldEntry> fields{field_entry("mesh", tip_dipole, {}, true)};
  const models::CaseResult result = models::run(c, mechanics, fields);
  ASSERT_EQ(result.fields.size(), 1u);
  EXPECT_EQ(result.fields[0].name(), "body/mesh");
}

TEST(Run, RefusesAModelThatDoesNotExist) {
  input::Case c = paper_case({1e-3});
  c.mechanics = {"elastika"};
  const std::vector<models::MechanicsEntry> mechanics{bend("bend")};
  EXPECT_THROW(models::run(c, mechanics, {}), InputError);
}

}  // namespace
}  // namespace ciliaval::compare
