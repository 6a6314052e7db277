// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "cases.h"
#include "problem/error.h"

namespace ciliaval::analytic {
namespace {

std::vector<Load> all_loads(double azimuth) {
  return {ContactLoad{4e-3, 16e-3, azimuth}, FlowLoad{1, azimuth},
          SectionLoad{4e-3, 16e-3, azimuth}, DeadLoad{1, azimuth}, ProbeLoad{8e-3, 16e-3, azimuth}};
}

// Claim: the azimuth turns the whole state about e_z, nothing else. Measured 4e-18 m.
TEST(ElasticaInput, AzimuthTurnsTheSolutionAboutTheAxis) {
  const Cilium cilium = paper_cilium();
  for (const double azimuth : {0.7, 2.0, -1.1, 5 * std::numbers::pi / 2}) {
    const Quaternion turn(Eigen::AngleAxisd(azimuth, Vector3::UnitZ()));
    const std::vector<Load> reference = all_loads(0);
    const std::vector<Load> turned = all_loads(azimuth);
    for (std::size_t i = 0; i < reference.size(); ++i) {
      const MechanicsStep a = solve(cilium, reference[i]);
      const MechanicsStep b = solve(cilium, turned[i]);
      for (const double S : {1e-3, 3e-3, 10e-3, 17e-3, 20e-3}) {
        const CentrelinePoint p = a.deformation->centreline.at(S);
        const CentrelinePoint q = b.deformation->centreline.at(S);
        EXPECT_LT((turn * p.position - q.position).norm(), 1e-16);
        EXPECT_LT((turn * p.normal() - q.normal()).norm(), 1e-14);
        EXPECT_LT((turn * p.curvature - q.curvature).norm(), 1e-12);
        EXPECT_LT((turn * p.forces.force - q.forces.force).norm(), 1e-16);
        EXPECT_LT((turn * p.forces.moment - q.forces.moment).norm(), 1e-18);
        // No twist: Λ turns about a horizontal axis.
        EXPECT_NEAR(q.rotation.z(), 0, 1e-15);
      }
    }
  }
}

// Claim: the pull is along e, and the rotation brings e_z to the tangent.
TEST(ElasticaInput, ForceAlongXBendsTowardsX) {
  for (const Load& load : all_loads(0)) {
    const MechanicsStep step = solve(paper_cilium(), load);
    const CentrelinePoint tip = step.deformation->centreline.at(20e-3);
    EXPECT_GT(tip.position.x(), 1e-3) << type(load);
    EXPECT_LT(std::abs(tip.position.y()), 1e-18) << type(load);
    EXPECT_GT(tip.normal().x(), 0.1) << type(load);
    const CentrelinePoint base = step.deformation->centreline.at(0);
    EXPECT_GT(base.forces.force.x(), 0) << type(load);
    EXPECT_GT(base.forces.moment.y(), 0) << type(load);  // e_z × e_x = e_y
    EXPECT_GT(base.curvature.y(), 0) << type(load);
  }
}

// Claim: segments of the same material are one. Measured 5e-16 of the length.
TEST(ElasticaInput, SplittingASegmentChangesNothing) {
  const Cilium whole = paper_cilium();
  Cilium split = whole;
  split.segments.clear();
  for (const Segment& segment : whole.segments) {
    for (const double part : {0.25, 0.01, 0.5, 0.24}) {
      split.segments.push_back(segment);
      split.segments.back().length = part * segment.length;
    }
  }
  for (const elastica::ElasticaOptions& options : {elastica::ElasticaOptions{}, height_form()}) {
    for (const Load& load : all_loads(0)) {
      const bool refused = !load.is<ContactLoad>() && !load.is<FlowLoad>();
      if (refused && options.form == elastica::ElasticaOptions::Form::height) continue;
      const MechanicsStep a = solve(whole, load, options);
      const MechanicsStep b = solve(split, load, options);
      for (const double S : {1e-3, 3e-3, 10e-3, 17e-3, 20e-3}) {
        const PlanarPoint p = planar_point(a, S);
        const PlanarPoint q = planar_point(b, S);
        EXPECT_NEAR(p.w, q.w, 1e-12 * 20e-3) << type(load);
        EXPECT_NEAR(p.z, q.z, 1e-12 * 20e-3) << type(load);
        EXPECT_NEAR(p.theta, q.theta, 1e-12) << type(load);
      }
    }
  }
}

TEST(ElasticaInput, NoLoadLeavesTheCiliumStraight) {
  for (const elastica::ElasticaOptions& options : {elastica::ElasticaOptions{}, height_form()}) {
    for (const Load& load : all_loads(0.4)) {
      if (!load.is<ContactLoad>() && !load.is<FlowLoad>() &&
          options.form == elastica::ElasticaOptions::Form::height)
        continue;
      const MechanicsStep step = solve(paper_cilium(), with_magnitude(load, 0), options);
      for (const double S : {0.0, 2e-3, 20e-3}) {
        const CentrelinePoint point = step.deformation->centreline.at(S);
        EXPECT_LT((point.position - S * Vector3::UnitZ()).norm(), 1e-17) << type(load);
        EXPECT_EQ(point.theta(), 0) << type(load);
        EXPECT_EQ(point.forces.moment.norm(), 0) << type(load);
      }
      EXPECT_EQ(step.applied_force, 0);
      if (type(load) == "contact") {
        EXPECT_NEAR(*step.contact_arclength, 16e-3, 1e-17);
      }
    }
  }
}

TEST(ElasticaInput, ReportsWhatItDid) {
  int lines = 0;
  const MechanicsResult result =
      elastica::Elastica().solve(paper_cilium(), {FlowLoad{0.1, 0}, FlowLoad{0.2, 0}},
                                 [&](const ProgressReport&) { ++lines; });
  EXPECT_EQ(lines, 2);
  EXPECT_EQ(result.undeformed.centreline.breaks(), paper_cilium().interfaces());
  EXPECT_EQ(result.undeformed.body, nullptr);
  for (const MechanicsStep& step : result.steps) {
    EXPECT_EQ(step.status, Status::converged);
    EXPECT_GT(step.iterations, 2);
    EXPECT_EQ(step.unknowns, 1);
    EXPECT_GT(step.seconds, 0);
    ASSERT_TRUE(step.tip_uncertainty);
    EXPECT_LE(*step.tip_uncertainty, 1e-12 * 20e-3);
    for (const double end : paper_cilium().interfaces())  // breaks at the interfaces, to the bit
      EXPECT_EQ(std::count(step.deformation->centreline.breaks().begin(),
                           step.deformation->centreline.breaks().end(), end),
                1);
  }
}

TEST(ElasticaInput, RefusesWhatIsNotPhysical) {
  const elastica::Elastica elastica;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  const Cilium cilium = paper_cilium();
  for (const Load& load :
       {Load(ContactLoad{-1e-3, 16e-3, 0}), Load(ContactLoad{1e-3, 20e-3, 0}),
        Load(ContactLoad{1e-3, nan, 0}), Load(ProbeLoad{-1e-3, 16e-3, 0}),
        Load(ProbeLoad{1e-3, 20e-3, 0}), Load(ProbeLoad{nan, 16e-3, 0}), Load(FlowLoad{nan, 0}),
        Load(FlowLoad{infinity, 0}), Load(SectionLoad{1e-3, 21e-3, 0}),
        Load(SectionLoad{1e-3, 0, 0}), Load(DeadLoad{1, infinity}), Load(DeadLoad{1e308, 0})})
    EXPECT_THROW(elastica.solve(cilium, {load}), InputError) << type(load);
  Cilium hollow = cilium;
  hollow.diameter = 0;
  EXPECT_THROW(elastica.solve(hollow, {FlowLoad{1, 0}}), InputError);
  Cilium rubbish = cilium;
  rubbish.segments[1].young_modulus = nan;
  EXPECT_THROW(elastica.solve(rubbish, {FlowLoad{1, 0}}), InputError);
  elastica::ElasticaOptions options;
  options.tolerance = 0;
  EXPECT_THROW(elastica::Elastica(options).solve(cilium, {FlowLoad{1, 0}}), InputError);
}

}  // namespace
}  // namespace ciliaval::analytic
