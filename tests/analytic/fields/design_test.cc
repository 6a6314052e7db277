// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>

#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "analytic/design_field.h"
#include "analytic/elastica/elastica.h"
#include "analytic/rod/field_models.h"
#include "bent_rods.h"
#include "problem/error.h"

namespace ciliaval::analytic {
namespace {

using oracle::paper_cilium;
using oracle::record;
using oracle::relative_difference;

/// Three segments, magnets below and above a gap.
Cilium two_magnets() {
  return {2e-3,
          {{"lower", 4e-3, 0.2e6, 0.49, 50e3},
           {"gap", 6e-3, 0.1e6, 0.49, 0},
           {"middle", 4e-3, 1e6, 0.49, -30e3},
           {"upper", 6e-3, 2e6, 0.49, 60e3}}};
}

const std::vector<std::pair<std::string, Load>> loads = {
    {"contact", ContactLoad{1e-4, 16e-3, 0.5}},
    {"small contact", ContactLoad{1e-9, 12e-3, 2.0}},
    {"flow", FlowLoad{0.01, -1.0}},
    {"section", SectionLoad{1e-4, 18e-3, 0.3}},
    {"dead", DeadLoad{0.01, 0.9}},
    {"no load", DeadLoad{0, 0}},
    {"probe", ProbeLoad{2e-3, 15e-3, 0.2}}};

// Oracle: the two models one after the other at 1e-12 (mechanics) and 1e-10; the design's way takes
// poses from the Taylor steps, theirs from the interpolated centreline. Measured 5e-15.
TEST(DesignField, IsThatOfTheTwoModels) {
  // Outside, and one point at the height of the magnet, where the models are asked.
  const std::vector<std::vector<Vector3>> sensors = {
      {oracle::paper_sensor, {3e-3, 1e-3, -2e-3}, {0.1, -0.2, -0.3}}, {{6e-3, -2e-3, 8e-3}}};
  double error = 0;
  for (const Cilium& cilium : {paper_cilium(), two_magnets()})
    for (const auto& [name, load] : loads)
      for (const std::vector<Vector3>& points : sensors) {
        const DesignField design = design_field(cilium, load, points);
        ASSERT_EQ(design.status, Status::converged) << name;
        const Deformation deformation = *Elastica().solve(cilium, {load}).steps.front().deformation;
        const Field field = VolumeField().field(cilium, deformation, points);
        for (std::size_t i = 0; i < points.size(); ++i) {
          EXPECT_LT(relative_difference(design.field.B[i], field.B[i]), 1e-11) << name;
          error = std::max(error, relative_difference(design.field.B[i], field.B[i]));
        }
      }
  record("design against elastica and volume", error);
}

TEST(DesignField, KeepsTheToleranceAsked) {
  const std::vector<Vector3> point{oracle::paper_sensor};
  const Load load = ContactLoad{4e-3, 16e-3, 0.5};
  const Vector3 exact = design_field(paper_cilium(), load, point, 1e-11).field.B.front();
  for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10}) {
    const Vector3 B = design_field(paper_cilium(), load, point, tolerance).field.B.front();
    EXPECT_LT(relative_difference(B, exact), tolerance);
  }
}

// The slip-off force is 5.862 mN.
TEST(DesignField, HasNoneBeyondTheSlipOff) {
  const std::vector<Vector3> point{oracle::paper_sensor};
  EXPECT_EQ(design_field(paper_cilium(), ContactLoad{5.86e-3, 16e-3, 0}, point).status,
            Status::converged);
  const DesignField beyond = design_field(paper_cilium(), ContactLoad{5.87e-3, 16e-3, 0}, point);
  EXPECT_EQ(beyond.status, Status::slipped_off);
  EXPECT_TRUE(beyond.field.B.empty());
}

TEST(DesignField, RefusesWhatTheModelsRefuse) {
  const std::vector<Vector3> point{oracle::paper_sensor};
  Cilium no_length = paper_cilium();
  no_length.segments[0].length = 0;
  EXPECT_THROW(design_field(no_length, ContactLoad{1e-3, 16e-3, 0}, point), InputError);
  EXPECT_THROW(design_field(paper_cilium(), ContactLoad{1e-3, 30e-3, 0}, point), InputError);
  EXPECT_THROW(design_field(paper_cilium(), ContactLoad{1e-3, 16e-3, 0}, point, 1e-17),
               SolverError);
  // Bent more sharply than its radius: κR = F (h − z₁)R/(EI) = 1.5 where the magnet begins.
  Cilium soft = paper_cilium();
  soft.segments[1].young_modulus = 1e3;
  soft.segments[0].young_modulus = 1e6;
  EXPECT_THROW(design_field(soft, ContactLoad{4e-3, 4e-3, 0}, point), SolverError);
}

}  // namespace
}  // namespace ciliaval::analytic
