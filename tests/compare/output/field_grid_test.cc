// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/output/field_grid.h"

#include <gtest/gtest.h>

#include <memory>

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

models::MechanicsEntry bend(const std::string& id, bool body) {
  return mechanics_entry(id, [body](const Load& load) {
    MechanicsStep step = converged(load, arc(L, 3e-3, Vector3::UnitX(), 20));
    if (body) step.deformation->body = std::make_shared<SolidBody>(test::BentBricks::body());
    return step;
  });
}

Vector3 linear(const Deformation&, const Vector3& x) {
  return {x.x(), 2 * x.y(), 3 * x.z()};
}

// Oracle: a field B = (x, 2y, 3z), read back at each grid point.
TEST(FieldGrid, IsTheMostDetailedMechanicsAndFieldThatNeedsNoBody) {
  input::Case c = paper_case({1e-3});
  c.mechanics = {"rod", "beam", "solid"};
  c.fields = {"line", "volume", "mesh"};
  const std::vector<models::MechanicsEntry> mechanics{bend("rod", false), bend("beam", false),
                                                      bend("solid", true)};
  const std::vector<models::FieldEntry> fields{
      field_entry("line",
                  [](const Deformation&, const Vector3&) -> Vector3 {
                    return {9, 9, 9};
                  }),
      field_entry("volume", linear), field_entry("mesh", linear, {}, true)};
  const models::CaseResult result = models::run(c, mechanics, fields);
  const auto grid = output::field_grid(result, fields);
  ASSERT_TRUE(grid);
  EXPECT_EQ(grid->mechanics, "solid");
  EXPECT_EQ(grid->field, "volume");
  const output::FieldGrid::Step step = *grid->sample(0);
  ASSERT_EQ(step.B.size(), 33u * 33 * 49);
  const std::size_t i = 5 + 33 * (7 + 33 * 11);
  const Vector3 x = grid->origin + grid->spacing.cwiseProduct(Vector3(5, 7, 11));
  EXPECT_LT((step.B[i] - linear({}, x)).norm(), 1e-15);
  // The box holds the sensor and the bent cilium.
  const Vector3 top = grid->origin + grid->spacing.cwiseProduct(Vector3(32, 32, 48));
  const Vector3 tip = arc(L, 3e-3, Vector3::UnitX(), 20).at(L).position;
  for (const Vector3& point : {tip, c.sensors[0]}) {
    EXPECT_TRUE((point.array() > grid->origin.array()).all());
    EXPECT_TRUE((point.array() < top.array()).all());
  }
}

TEST(FieldGrid, MasksThePointsAtWhichTheModelHasNoField) {
  input::Case c = paper_case({1e-3});
  c.mechanics = {"rod"};
  c.fields = {"volume"};
  const std::vector<models::MechanicsEntry> mechanics{bend("rod", false)};
  const std::vector<models::FieldEntry> fields{
      field_entry("volume", [](const Deformation&, const Vector3& x) -> Vector3 {
        if (x.z() > 10e-3 && x.x() > 0) throw InputError("B diverges here");
        return {1, 1, 1};
      })};
  const models::CaseResult result = models::run(c, mechanics, fields);
  const auto grid = output::field_grid(result, fields);
  ASSERT_TRUE(grid);
  const output::FieldGrid::Step step = *grid->sample(0);
  std::size_t point = 0;
  std::size_t masked = 0;
  for (int k = 0; k < 49; ++k)
    for (int j = 0; j < 33; ++j)
      for (int i = 0; i < 33; ++i, ++point) {
        const Vector3 x = grid->origin + grid->spacing.cwiseProduct(Vector3(i, j, k));
        const bool diverges = x.z() > 10e-3 && x.x() > 0;
        EXPECT_EQ(step.valid[point], diverges ? 0 : 1);
        EXPECT_EQ(step.B[point].x(), diverges ? 0 : 1);
        masked += diverges ? 1 : 0;
      }
  EXPECT_GT(masked, 100u);
}

// A sensor two metres away, as one that measures the earth's field, would leave the cilium of 20 mm
// between two planes of the grid; one of 50 mm away (2.5 lengths) is left out too, one of 39 mm
// not.
TEST(FieldGrid, StaysAroundTheCiliumWhateverTheSensors) {
  for (const double far : {2.0, 50e-3, 39e-3}) {
    input::Case c = paper_case({1e-3});
    c.sensors = {Vector3(0, 0, -1.55e-3), Vector3(0, -far, 0)};
    c.mechanics = {"rod"};
    c.fields = {"volume"};
    const std::vector<models::MechanicsEntry> mechanics{bend("rod", false)};
    const std::vector<models::FieldEntry> fields{field_entry("volume", linear)};
    const models::CaseResult result = models::run(c, mechanics, fields);
    const auto grid = output::field_grid(result, fields);
    ASSERT_TRUE(grid);
    EXPECT_LT(grid->spacing.maxCoeff(), 3e-3);  // a diameter
    EXPECT_EQ(grid->origin.y() < -far, far < 40e-3) << far;
    EXPECT_LT(grid->origin.z(), -1.55e-3);
  }
}

// A path of any length needs the memory of one step: nothing is sampled before it is asked for.
TEST(FieldGrid, IsSampledStepByStep) {
  input::Case c = paper_case({1e-3, 2e-3, 3e-3});
  c.mechanics = {"rod"};
  c.fields = {"volume"};
  const std::vector<models::MechanicsEntry> mechanics{mechanics_entry("rod", [](const Load& load) {
    MechanicsStep step = converged(load, arc(L, 3e-3, Vector3::UnitX(), 1e4 * magnitude(load)));
    if (magnitude(load) > 2.5e-3) {
      step.status = Status::failed;
      step.deformation.reset();
    }
    return step;
  })};
  const std::vector<models::FieldEntry> fields{field_entry(
      "volume",
      [](const Deformation& d, const Vector3&) -> Vector3 { return d.centreline.at(L).position; })};
  const models::CaseResult result = models::run(c, mechanics, fields);
  std::vector<std::string> sampled;
  const auto grid = output::field_grid(result, fields,
                                       [&](const ProgressReport& s) { sampled.push_back(s.text); });
  ASSERT_TRUE(grid);
  EXPECT_TRUE(sampled.empty());
  const Vector3 tip = result.mechanics[0].result.steps[1].deformation->centreline.at(L).position;
  EXPECT_EQ(grid->sample(1)->B.at(0), tip);
  EXPECT_EQ(sampled, std::vector<std::string>{"field grid: step 2"});
  EXPECT_FALSE(grid->sample(2));
}

}  // namespace
}  // namespace ciliaval::compare
