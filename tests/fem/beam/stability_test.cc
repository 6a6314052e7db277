// SPDX-License-Identifier: LGPL-2.1-or-later
// The second variation of the beam: buckling loads that are known in closed form.
#include "fem/beam/stability/stability.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <utility>

#include "analytic/elastica/elastica.h"
#include "fem/beam/beam.h"
#include "fem/beam/cilium_beam.h"
#include "fem/beam/newton.h"
#include "fem/lanczos.h"

namespace ciliaval::fem::beam {
namespace {

using std::numbers::pi;

/// EI/L² = 1 N, A M L²/EI = 1 per T, ρA = 1 kg/m.
Cilium unit_rod() {
  const double d = 0.01;
  const double area = pi * d * d / 4;
  return {d, {{"rod", 1, 64 / (pi * std::pow(d, 4)), 0.3, 1 / area, 1 / area}}};
}

/// The straight rod in equilibrium with the load.
struct Straight {
  Eigenpair eigenvalue;
  int negative = 0;
};

Straight straight(const Load& load, bool shear_rigid = true) {
  const Cilium cilium = unit_rod();
  BeamOptions options{.degree = 8, .refinement = 1};
  options.shear_rigid = shear_rigid;
  CiliumBeam beam = cilium_beam(cilium, options);
  State state = beam.system.reference_state();
  const Loads all = loads(cilium, load, beam);
  const PathReport report = advance(beam.system, state, {}, all, {1e-13, 30, 8});
  EXPECT_TRUE(report.converged) << report.message;
  const int negative = stability::unstable_modes(beam.system, state, all);
  return {stability::smallest_eigenvalue(beam.system, state, all, negative), negative};
}

double critical(const std::function<Load(double)>& load, double low, double high) {
  const auto eigenvalue = [&](double t) { return straight(load(t)).eigenvalue.value; };
  std::uintmax_t iterations = 60;
  const auto [a, b] = boost::math::tools::toms748_solve(
      eigenvalue, low, high, boost::math::tools::eps_tolerance<double>(44), iterations);
  return (a + b) / 2;
}

Load weighed(double K) {
  return with_environment(EnvironmentLoad{}, {.gravity = {0, 0, -K}});
}

Load opposed(double lambda) {
  return with_environment(EnvironmentLoad{}, {.uniform_field = {0, 0, -lambda}});
}

// Oracle: Greenhill's number, w L³/EI = 7.837347438943486, and (π/2)² of an opposing field.
TEST(BeamStability, FindsGreenhillsWeightAndTheOpposingField) {
  EXPECT_NEAR(critical(weighed, 6, 9) / 7.837347438943486, 1, 1e-9);
  EXPECT_NEAR(critical(opposed, 2, 3) / (pi * pi / 4), 1, 1e-9);
}

// Oracle: both planes buckle at once; the next mode of an opposing field at (3π/2)².
TEST(BeamStability, CountsTheModes) {
  EXPECT_EQ(straight(opposed(0)).negative, 0);
  EXPECT_EQ(straight(opposed(2.4)).negative, 0);
  EXPECT_EQ(straight(opposed(2.5)).negative, 2);
  EXPECT_EQ(straight(opposed(22.2)).negative, 2);
  EXPECT_EQ(straight(opposed(22.3)).negative, 4);
  EXPECT_EQ(straight(opposed(2.5), false).negative, 2);  // with shear and extension
  EXPECT_EQ(straight(opposed(-50)).negative, 0);
}

// Oracle: u = 1 − cos(πz/2L) of the buckled column, K = 3EI/L³-like at rest: the first eigenvalue
// of a clamped column, ω = EI (1.87510407)⁴/L⁴ per unit of length.
TEST(BeamStability, KnowsTheFirstEigenvalueAndItsMode) {
  EXPECT_NEAR(straight(opposed(0)).eigenvalue.value / std::pow(1.8751040687, 4), 1, 1e-8);
  const Cilium cilium = unit_rod();
  BeamOptions options{.degree = 8, .refinement = 1};
  options.shear_rigid = true;
  const CiliumBeam beam = cilium_beam(cilium, options);
  const Eigen::VectorXd mode = straight(opposed(pi * pi / 4 * (1 - 1e-8))).eigenvalue.vector;
  const State at = beam.system.reference_state();
  const auto tip = at.position.size() - 1;
  for (std::size_t node = 1; node < tip; node += 3) {
    const double z = beam.system.node_arclength(at, node);
    for (std::size_t c = 0; c < 2; ++c) {
      const auto i = static_cast<Eigen::Index>(beam.system.node_unknown(node, c));
      const auto end = static_cast<Eigen::Index>(beam.system.node_unknown(tip, c));
      EXPECT_NEAR(mode[i], (1 - std::cos(pi * z / 2)) * mode[end],
                  1e-6 * mode.head(6 * static_cast<Eigen::Index>(tip)).norm());
    }
  }
}

/// The smallest eigenvalue of EI = L = 1 under an opposing field λ over that without it, by Ritz's
/// method with z², …, z⁹: ∫ u″² − λ u′² dz = ω ∫ u² dz.
double by_ritz(double lambda) {
  constexpr int n = 8;
  Eigen::MatrixXd bending(n, n), turning(n, n), weight(n, n);
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < n; ++k) {
      const double p = i + 2, q = k + 2;
      bending(i, k) = p * (p - 1) * q * (q - 1) / (p + q - 3);
      turning(i, k) = p * q / (p + q - 1);
      weight(i, k) = 1 / (p + q + 1);
    }
  const auto smallest = [&](double field) {
    return Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(bending - field * turning,
                                                                     weight)
        .eigenvalues()[0];
  };
  return smallest(lambda) / smallest(0);
}

// Oracle: Ritz's method. At λ = 20 the eigenvalue nearest to 0 is the second one, which is
// positive.
TEST(BeamStability, StatesTheSmallestEigenvalueOverThatAtRest) {
  BeamOptions rigid;
  rigid.shear_rigid = true;
  for (const double lambda : {-5.0, 0.5, 2.0, 3.0, 10.0, 20.0}) {
    const MechanicsStep step = Beam(rigid).solve(unit_rod(), {opposed(lambda)}).steps.at(0);
    EXPECT_EQ(step.unstable_modes, lambda < 2.4 ? 0 : 2) << lambda;
    EXPECT_NEAR(step.smallest_eigenvalue.value() / by_ritz(lambda), 1, 1e-4) << lambda;
  }
  const MechanicsStep plain = Beam().solve(unit_rod(), {DeadLoad{0.1, 0}}).steps.at(0);
  EXPECT_FALSE(plain.unstable_modes || plain.smallest_eigenvalue);
}

// Oracle: Eigen's dense solver. W does not see every unknown.
TEST(Lanczos, FindsTheSmallestEigenvalue) {
  constexpr int n = 60;
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  Eigen::MatrixXd any(n, n);
  for (double& entry : any.reshaped()) entry = normal(random);
  const Eigen::MatrixXd Q = Eigen::HouseholderQR<Eigen::MatrixXd>(any).householderQ();
  Eigen::VectorXd weights = Eigen::VectorXd::Ones(n);
  weights.tail(20).setZero();
  for (const int negative : {0, 1, 3}) {
    Eigen::VectorXd values(n);
    for (int i = 0; i < n; ++i) values[i] = 0.01 * std::pow(1.2, i);
    for (int i = 0; i < negative; ++i) values[5 * i] *= -1;
    const Eigen::MatrixXd K = Q * values.asDiagonal() * Q.transpose();
    const Eigen::MatrixXd inverse = K.inverse();
    const Eigenpair found = smallest_eigenpair(
        {n, [&](const Eigen::VectorXd& f) -> Eigen::VectorXd { return inverse * f; },
         [&](const Eigen::VectorXd& u) -> Eigen::VectorXd { return weights.cwiseProduct(u); }},
        negative);
    // W^½ K⁻¹ W^½ has the eigenvalues 1/ω.
    const Eigen::MatrixXd root = weights.cwiseSqrt().asDiagonal();
    const Eigen::VectorXd all =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(root * inverse * root).eigenvalues();
    double oracle = 1 / all[n - 1];
    for (const double theta : all)
      if (negative > 0 && theta < -1e-9) oracle = std::min(oracle, 1 / theta);
    EXPECT_NEAR(found.value / oracle, 1, 1e-10) << negative;
    const Eigen::VectorXd rest =
        K * found.vector - found.value * weights.cwiseProduct(found.vector);
    EXPECT_LT(rest.norm(), 1e-6 * std::abs(found.value) * found.vector.norm()) << negative;
  }
}

/// θ(1) under an opposing field that is tilted by the angle, in one step and in many.
double tip_angle(const MechanicsModel& model, double lambda, double tilt, int steps) {
  LoadPath path;
  for (int i = 1; i <= steps; ++i) {
    const double field = lambda * i / steps;
    path.push_back(
        with_environment(EnvironmentLoad{},
                         {.uniform_field = {field * std::sin(tilt), 0, -field * std::cos(tilt)}}));
  }
  const MechanicsStep last = model.solve(unit_rod(), path).steps.back();
  EXPECT_EQ(last.status, Status::converged) << last.message;
  EXPECT_EQ(last.message, "");
  return last.deformation ? last.deformation->centreline.at(1).theta() : 0;
}

// A slight tilt chooses the side. One large step must not leap over the bifurcation to the branch
// that stays near the axis. Oracle: many small steps; beam and elastica, which share no code.
TEST(BeamStability, FollowsThePathToTheSideOfTheImperfection) {
  BeamOptions rigid{.degree = 6, .refinement = 2};
  rigid.shear_rigid = true;
  const Beam beam(rigid);
  const analytic::elastica::Elastica elastica;
  for (const double degrees : {5.0, 1.0, 0.2}) {
    for (const double lambda : {3.0, 5.0, 25.0}) {
      const double tilt = degrees * pi / 180;
      const double slow = tip_angle(elastica, lambda, tilt, 60);
      EXPECT_GT(slow, 0.5) << lambda;
      EXPECT_NEAR(tip_angle(elastica, lambda, tilt, 1), slow, 1e-8) << lambda << ' ' << degrees;
      EXPECT_NEAR(tip_angle(beam, lambda, tilt, 1), slow, 1e-6) << lambda << ' ' << degrees;
      EXPECT_NEAR(tip_angle(beam, lambda, tilt, 7), slow, 1e-6) << lambda << ' ' << degrees;
    }
  }
}

TEST(BeamStability, SaysThatAPerfectRodBuckles) {
  const MechanicsStep step = Beam().solve(unit_rod(), {opposed(3)}).steps.at(0);
  EXPECT_EQ(step.status, Status::converged);
  EXPECT_EQ(step.message, "this equilibrium is not stable: it buckles in 2 modes");
  EXPECT_EQ(step.unstable_modes, 2);
  EXPECT_LT(std::abs(step.deformation->centreline.at(1).position.x()), 1e-9);
}

}  // namespace
}  // namespace ciliaval::fem::beam
