// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "cases.h"
#include "problem/lagrange.h"

namespace ciliaval::analytic {
namespace {

/// ∫_a^b of a function along the returned centreline, by Gauss–Legendre between its breaks.
template <class Value>
Value integral(const Centreline& centreline, double a, double b,
               const std::function<Value(const CentrelinePoint&)>& integrand, Value sum) {
  std::vector<double> ends{a};
  for (const double s : centreline.breaks())
    if (s > a && s < b) ends.push_back(s);
  ends.push_back(b);
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    const QuadratureRule rule = gauss_legendre(20, ends[i], ends[i + 1]);
    for (std::size_t k = 0; k < rule.nodes.size(); ++k)
      sum += rule.weights[k] * integrand(centreline.at(rule.nodes[k]));
  }
  return sum;
}

/// The internal force and moment at S that the load asks for on the returned geometry.
struct Balance {
  double force = 0;
  double moment = 0;
};
Balance balance(const Centreline& centreline, const Load& load, double S) {
  const double length = centreline.length();
  const double z = centreline.at(S).position.z();
  if (const auto contact = load.as<ContactLoad>()) {
    if (z > contact->height) return {};
    return {contact->force, contact->force * (contact->height - z)};
  }
  if (const auto section = load.as<SectionLoad>()) {
    if (S > section->arclength) return {};
    return {section->force, section->force * (centreline.at(section->arclength).position.z() - z)};
  }
  // Distributed: the forces dH = q dz or q dS above S, with the arm z(σ) − z(S).
  const bool flow = load.is<FlowLoad>();
  const auto density = [&](const CentrelinePoint& p) {
    return magnitude(load) * (flow ? p.normal().z() : 1.0);
  };
  return {integral<double>(centreline, S, length, density, 0.0),
          integral<double>(
              centreline, S, length,
              [&](const CentrelinePoint& p) { return density(p) * (p.position.z() - z); }, 0.0)};
}

struct Case {
  std::string name;
  Cilium cilium;
  Load load;
};

std::vector<Case> cases() {
  return {{"ContactPaper", paper_cilium(), ContactLoad{4e-3, 16e-3, 0.5}},
          {"ContactNearSlipOff", paper_cilium(), ContactLoad{5.86e-3, 16e-3, 0.5}},
          {"ContactThree", three_segments(), ContactLoad{2e-4, 12e-3, -2}},
          {"ProbePaper", paper_cilium(), ProbeLoad{8e-3, 16e-3, 0.5}},
          {"ProbeNear90Degrees", uniform_cilium(), ProbeLoad{8e-3, 2e-3, 0.5}},
          {"FlowPaper", paper_cilium(), FlowLoad{1.0, 0.5}},
          {"FlowThreeStrong", three_segments(), FlowLoad{2.0, 4}},
          {"SectionPaper", paper_cilium(), SectionLoad{4e-3, 16e-3, 0.5}},
          {"SectionThreeStrong", three_segments(), SectionLoad{0.2, 17e-3, 3}},
          {"DeadPaper", paper_cilium(), DeadLoad{0.5, 0.5}},
          {"DeadThreeStrong", three_segments(), DeadLoad{20.0, 0.1}}};
}

class ElasticaEquilibrium : public testing::TestWithParam<Case> {};

// Oracle: the definition. At random points the returned geometry alone (by Gauss–Legendre
// quadrature, which the solver does not use) gives the forces above the point; they must be the
// section forces returned, and EI κ the moment. Measured 2e-15 of the base's; margin 50.
TEST_P(ElasticaEquilibrium, HoldsAtEveryPointOfTheReturnedShape) {
  const auto& [name, cilium, given] = GetParam();
  const MechanicsStep step = solve(cilium, given);
  const Centreline& centreline = step.deformation->centreline;
  Load load = given;
  if (const auto probe = given.as<ProbeLoad>())
    load = ContactLoad{step.applied_force, probe->height, probe->azimuth};
  const Vector3 e = direction(load);
  const Vector3 axis = Vector3::UnitZ().cross(e);
  const Balance base = balance(centreline, load, 0);
  EXPECT_NEAR(step.applied_force, base.force, 1e-13 * base.force);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> material(0, cilium.length());
  for (int i = 0; i < 100; ++i) {
    const double S = material(random);
    const CentrelinePoint point = centreline.at(S);
    const Balance exact = balance(centreline, load, S);
    const double stiffness = bending_stiffness(cilium, cilium.segment_at(S));
    EXPECT_LT((stiffness * point.curvature - exact.moment * axis).norm(), 1e-13 * base.moment) << S;
    EXPECT_LT((point.forces.moment - exact.moment * axis).norm(), 1e-13 * base.moment) << S;
    EXPECT_LT((point.forces.force - exact.force * e).norm(), 1e-13 * base.force) << S;
  }
}

// Oracle: kinematics. dr/dS is the unit normal of the section (inextensible, shear-rigid), θ the
// integral of κ, r that of the normal; the base is clamped. Measured 5e-13 for dr/dS
// (differentiated interpolation: rounding over the shortest piece), 1e-14 for the integrals.
TEST_P(ElasticaEquilibrium, ShapeIsInextensibleAndShearRigid) {
  const auto& [name, cilium, load] = GetParam();
  const MechanicsStep step = solve(cilium, load);
  const Centreline& centreline = step.deformation->centreline;
  const double length = cilium.length();
  EXPECT_LT(centreline.at(0).position.norm(), 1e-15 * length);
  EXPECT_LT(centreline.at(0).theta(), 1e-13);
  std::mt19937 random(11);
  std::uniform_real_distribution<double> material(0, length);
  for (int i = 0; i < 100; ++i) {
    const double S = material(random);
    const CentrelinePoint point = centreline.at(S);
    EXPECT_LT((point.derivative - point.normal()).norm(), 1e-11) << S;
    const Vector3 position = integral<Vector3>(
        centreline, 0, S, [](const CentrelinePoint& p) { return p.normal(); }, Vector3::Zero());
    EXPECT_LT((position - point.position).norm(), 5e-14 * length) << S;
    const Vector3 turned = integral<Vector3>(
        centreline, 0, S, [](const CentrelinePoint& p) { return p.curvature; }, Vector3::Zero());
    const Eigen::AngleAxisd rotation(point.rotation);
    EXPECT_LT((rotation.angle() * rotation.axis() - turned).norm(), 2e-13) << S;
  }
}

INSTANTIATE_TEST_SUITE_P(AllLoads, ElasticaEquilibrium, testing::ValuesIn(cases()),
                         [](const auto& instance) { return instance.param.name; });

}  // namespace
}  // namespace ciliaval::analytic
