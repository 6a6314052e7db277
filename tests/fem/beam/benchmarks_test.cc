// SPDX-License-Identifier: LGPL-2.1-or-later
// The beam core against solutions of the field: Mattiasson's and Batista's cantilever, roll-up, the
// 45° bend.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "beams.h"
#include "fem/beam/centreline.h"
#include "oracles.h"
#include "problem/lagrange.h"

namespace {

using namespace beams;
using namespace ciliaval::fem::beam;
using ciliaval::Quaternion;
using ciliaval::Vector3;

const Vector3 none = Vector3::Zero();

double angle(const State& state) {
  const Vector3 d3 = state.rotation.back() * Vector3::UnitZ();
  return std::atan2(d3[0], d3[2]);
}

TEST(BeamCantilever, MatchesTheTableOfTheInextensibleElastica) {
  // Oracle: Mattiasson's table to ten digits (elliptic integrals), PL²/EI = 1, 2, 5, 10. The
  // tolerance is the table's last half digit and 20 % for the beam.
  struct Row {
    double load, theta, deflection, shortening;
  };
  constexpr std::array rows{Row{1, 0.4613519497, 0.3017207738, 0.0564332363},
                            Row{2, 0.7817498316, 0.4934574804, 0.1606417208},
                            Row{5, 1.2153681176, 0.7137915236, 0.3876283607},
                            Row{10, 1.4302855388, 0.8106090249, 0.5549955978}};
  System system(straight_curve, uniform_mesh(1, 8, 6, isotropic(1, 1, infinity, infinity)), {{0}});
  State state = system.reference_state();
  Loads before;
  for (const Row& row : rows) {
    const Loads loads = end_load(8, {row.load, 0, 0}, none);
    const PathReport report = advance(system, state, before, loads, {});
    ASSERT_TRUE(report.converged) << report.message;
    before = loads;
    const Vector3& tip = state.position.back();
    const double error =
        std::max({std::abs(angle(state) - row.theta), std::abs(tip[0] - row.deflection),
                  std::abs(1 - tip[2] - row.shortening)});
    EXPECT_LT(measured("load_" + std::to_string(row.load), error), 6e-11);
  }
}

/// Section of a circular beam with L = EI = 1 and slenderness L/d, ν = 0.3.
SectionStiffness slender(double slenderness) {
  const double d = 1 / slenderness;
  const double I = pi * std::pow(d, 4) / 64;
  return circular_section(d, 1 / I, 0.3);
}

/// Largest error of tip position (by L) and angle (rad) under F L²/EI = 5.
double cantilever_error(double slenderness, unsigned int degree, std::size_t elements) {
  const SectionStiffness law = slender(slenderness);
  System system(straight_curve, uniform_mesh(1, elements, degree, section(law)), {{0}});
  State state = system.reference_state();
  const PathReport report = advance(system, state, {}, end_load(elements, {5, 0, 0}, none), {});
  EXPECT_TRUE(report.converged) << report.message;
  const oracle::Tip tip = oracle::cantilever(1, law.EI1, 1 / law.EA, 1 / law.kGA1, 5);
  return std::max({std::abs(state.position.back()[0] - tip.x),
                   std::abs(state.position.back()[2] - tip.z), std::abs(angle(state) - tip.theta)});
}

TEST(BeamCantilever, MatchesTheClosedFormWithShearAndExtension) {
  // Oracle: first integral of Reissner's beam by quadrature (oracles.h). Measured 1e-13.
  for (const double slenderness : {3.0, 10.0, 100.0, 1e3, 1e4})
    EXPECT_LT(measured("slenderness_" + std::to_string(static_cast<int>(slenderness)),
                       cantilever_error(slenderness, 6, 8)),
              2e-12);
}

TEST(BeamCantilever, DoesNotLockWithSlenderness) {
  // Oracle: the same. The error of coarse low-order meshes is that of bending alone: it must not
  // grow with slenderness. Locking would multiply it by orders of magnitude.
  for (const unsigned int degree : {1U, 2U, 3U}) {
    const double stubby = cantilever_error(10, degree, 8);
    for (const double slenderness : {100.0, 1e3, 1e4})
      EXPECT_LT(measured("degree_" + std::to_string(degree) + "_ratio_" +
                             std::to_string(static_cast<int>(slenderness)),
                         cantilever_error(slenderness, degree, 8) / stubby),
                1.1);
  }
}

TEST(BeamCantilever, FeelsShear) {
  // Oracle: the same quadrature; without shear and extension the tip of a stubby beam is elsewhere,
  // so the test above cannot pass with a rigid section.
  const SectionStiffness law = slender(3);
  const oracle::Tip with = oracle::cantilever(1, law.EI1, 1 / law.EA, 1 / law.kGA1, 5);
  const oracle::Tip without = oracle::cantilever(1, law.EI1, 0, 0, 5);
  EXPECT_GT(std::abs(with.x - without.x), 1e-2);
}

TEST(BeamBend45, MatchesTheBoundaryValueSolution) {
  // Oracle: tip displacement of the 45° bend by two boundary-value solvers, eight decimals.
  // Measured 1e-8, the last printed digit; asked: 1e-5.
  const double L = 100 * pi / 4;
  const std::size_t n = 8;
  System system([](double S) { return arc(100, S); },
                uniform_mesh(L, n, 5, isotropic(8.333e5, 8.333e5, 1e7, 41.6667e5)), {{0}});
  State state = system.reference_state();
  const Vector3 start = state.position.back();
  const PathReport report = advance(system, state, {}, end_load(n, {0, 0, 600}, none), {});
  ASSERT_TRUE(report.converged) << report.message;
  const Vector3 exact(-23.56129679, 13.60502301, 53.47610814);
  EXPECT_LT(measured("error", (state.position.back() - start - exact).lpNorm<Eigen::Infinity>()),
            2e-8);
}

TEST(BeamCurved, IsFreeOfStressInItsReferenceShape) {
  System system([](double S) { return arc(100, S); },
                uniform_mesh(70, 3, 2, isotropic(8e5, 8e5, 1e7, 4e6)), {{0}});
  EXPECT_LT(system.residual(system.reference_state(), {}).lpNorm<Eigen::Infinity>(), 1e-15);
}

/// Rolls a straight beam with base rotation Q up by an end moment about Q a, a ⟂ e₃.
void roll_up(const Quaternion& Q, const Vector3& axis) {
  const std::size_t n = 6;
  System system(
      [&](double S) {
        return Pose{S * (Q * Vector3::UnitZ()), Q};
      },
      uniform_mesh(1, n, 8, isotropic(2, 3, 500, 200)), {{0}});
  State state = system.reference_state();
  const PathReport report =
      advance(system, state, {}, end_load(n, none, 2 * pi * 2 * (Q * axis)), {});
  ASSERT_TRUE(report.converged) << report.message;
  EXPECT_LT(measured("gap", state.position.back().norm()), 1e-10);
  // A whole turn: the quaternion has changed sign.
  EXPECT_LT(measured("turn", (state.rotation.back().coeffs() + Q.coeffs()).norm()), 1e-10);
  // Half-way round the circle of circumference 1.
  const Vector3 half = Q * (axis.cross(Vector3::UnitZ())) / pi;
  EXPECT_LT(measured("half", (state.position[state.position.size() / 2] - half).norm()), 1e-10);
}

TEST(BeamRollUp, ClosesIntoACircle) {
  // Oracle: a pure end moment 2πEI/L bends the beam into a circle. Measured below 2e-12.
  roll_up(Quaternion::Identity(), Vector3::UnitY());
}

TEST(BeamRollUp, ClosesIntoACircleInAnyPlane) {
  roll_up(Quaternion(0.3, -0.5, 0.7, 0.2).normalized(), Vector3(0.6, -0.8, 0));
}

/// Errors of the half circle under πEI/L: of the tip and of r in L2.
struct CircleError {
  double tip, L2;
};
CircleError half_circle(unsigned int degree, std::size_t n) {
  System system(straight_curve, uniform_mesh(1, n, degree, isotropic(1, 1, 1e3, 1e3)), {{0}});
  State state = system.reference_state();
  const PathReport report = advance(system, state, {}, end_load(n, none, {0, pi, 0}), {});
  EXPECT_TRUE(report.converged) << report.message;
  const auto exact = [](double S) {
    return Vector3((1 - std::cos(pi * S)) / pi, 0, std::sin(pi * S) / pi);
  };
  const ciliaval::Centreline curve = centreline(system, state);
  double square = 0;
  for (std::size_t e = 0; e < n; ++e) {
    const ciliaval::QuadratureRule rule =
        ciliaval::gauss_legendre(8, curve.breaks()[e], curve.breaks()[e + 1]);
    for (std::size_t g = 0; g < 8; ++g)
      square += rule.weights[g] *
                (curve.at(rule.nodes[g], e).position - exact(rule.nodes[g])).squaredNorm();
  }
  return {(state.position.back() - exact(1)).norm(), std::sqrt(square)};
}

TEST(BeamRollUp, ConvergesWithTheOrderOfTheInterpolation) {
  // Oracle: the circle. Orders p+1 in L2 and 2p at the tip (superconvergence of p-point reduced
  // integration).
  for (const unsigned int degree : {1U, 2U, 3U}) {
    const std::size_t n = degree == 1 ? 64 : 8;
    const CircleError coarse = half_circle(degree, n);
    const CircleError fine = half_circle(degree, 2 * n);
    const double L2_order = std::log2(coarse.L2 / fine.L2);
    const double tip_order = std::log2(coarse.tip / fine.tip);
    EXPECT_NEAR(measured("L2_order_" + std::to_string(degree), L2_order), degree + 1.0, 0.1);
    EXPECT_NEAR(measured("tip_order_" + std::to_string(degree), tip_order), 2.0 * degree, 0.1);
  }
}

TEST(BeamSupports, PrescribedTipPoseNeedsTheForceThatMadeIt) {
  // Oracle: uniqueness. Solve under a tip force, prescribe the tip pose found, read the reaction.
  const Mesh mesh = uniform_mesh(1, 4, 5, isotropic(1, 0.7, 900, 300));
  System free_end(straight_curve, mesh, {{0}});
  State loaded = free_end.reference_state();
  const Vector3 force(1.5, -0.8, 0.4);
  ASSERT_TRUE(advance(free_end, loaded, {}, end_load(4, force, none), {}).converged);
  const Eigen::AngleAxisd turn(loaded.rotation.back());
  Loads ends;
  ends.displacements.push_back(
      {4, loaded.position.back() - Vector3::UnitZ(), turn.angle() * turn.axis()});
  System held(straight_curve, mesh, {{0}, {4}});
  State state = held.reference_state();
  const PathReport report = advance(held, state, {}, ends, {});
  ASSERT_TRUE(report.converged) << report.message;
  const Eigen::VectorXd residual = held.residual(state, ends);
  EXPECT_LT(measured("tip", (held.reaction(residual, 4) - force).norm()), 1e-10);
  EXPECT_LT(measured("base", (held.reaction(residual, 0) + force).norm()), 1e-10);
}

}  // namespace
