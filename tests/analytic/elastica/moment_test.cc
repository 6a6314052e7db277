// SPDX-License-Identifier: LGPL-2.1-or-later
// A dead couple at the tip. Oracle: arcs of circles, θ' = M/(E I) in each segment.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "cases.h"
#include "problem/error.h"

namespace ciliaval::analytic {
namespace {

using std::numbers::pi;

// Measured: 2e-15 of the length, three turns included.
TEST(ElasticaMoment, BendsEachSegmentIntoAnArc) {
  for (const Cilium& cilium : {uniform_cilium(), paper_cilium(), three_segments()}) {
    double flexibility = 0;  // ∫ dS/(EI)
    for (const Segment& segment : cilium.segments)
      flexibility += segment.length / (segment.young_modulus * cilium.second_moment(0));
    for (const double turn : {1e-6, 0.3, pi / 2, 2.5, 2 * pi, 6 * pi}) {
      const double M = turn / flexibility;
      const MechanicsStep step = solve(cilium, MomentLoad{M, 0});
      double theta = 0;
      double S = 0;
      Vector3 r = Vector3::Zero();
      for (const Segment& segment : cilium.segments) {
        const double kappa = M / (segment.young_modulus * cilium.second_moment(0));
        const double after = theta + kappa * segment.length;
        const double mean = (theta + after) / 2;
        r += 2 * std::sin((after - theta) / 2) / kappa * Vector3(std::sin(mean), 0, std::cos(mean));
        theta = after;
        S += segment.length;
        const CentrelinePoint point = step.deformation->centreline.at(S);
        EXPECT_LT((point.position - r).norm(), 1e-12 * cilium.length()) << turn;
        EXPECT_NEAR(point.forces.moment.y() / M, 1, 1e-12);
        EXPECT_EQ(point.forces.force.norm(), 0);
      }
      EXPECT_EQ(step.applied_force, 0);
    }
  }
}

TEST(ElasticaMoment, TooManyTurnsAreASlipInAUnit) {
  const MechanicsStep step =
      elastica::Elastica().solve(uniform_cilium(), {MomentLoad{1, 0}}).steps.at(0);
  EXPECT_EQ(step.status, Status::failed);
  EXPECT_NE(step.message.find("turns"), std::string::npos) << step.message;
}

TEST(ElasticaMoment, IsNotOfTheHeightForm) {
  EXPECT_THROW(solve(paper_cilium(), MomentLoad{1e-5, 0}, height_form()), InputError);
}

}  // namespace
}  // namespace ciliaval::analytic
