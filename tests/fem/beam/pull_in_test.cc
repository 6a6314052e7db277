// SPDX-License-Identifier: LGPL-2.1-or-later
// Magnets that pull the beam in. Oracles: the planar elastica with two poles, shot from the base by
// Runge and Kutta's method with the tip's deflection in place of the magnet's strength, so that it
// passes the fold; and a rigid magnet on a hinge, whose fold is the maximum of a function of one
// angle. Neither shares code with the beam but for the magnets' field.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <functional>
#include <optional>
#include <random>
#include <vector>

#include "beams.h"
#include "fem/beam/beam.h"
#include "problem/continuation/turning_point.h"
#include "problem/support/rotation.h"

namespace ciliaval::fem::beam {
namespace pull_in {

using surroundings::Environment;
using surroundings::magnets::jet;
using surroundings::magnets::Magnet;
using surroundings::magnets::Shape;

constexpr double vacuum_permeability = 1.25663706127e-6;

Magnet brick(const Vector3& position, double remanence = 1.2) {
  return {"brick",
          Shape::cuboid,
          position,
          support::turn_to(Vector3::UnitX()),
          0,
          0,
          {6e-3, 4e-3, 5e-3},
          {0, 0, remanence / vacuum_permeability}};
}

LoadPath magnets_alone(const std::vector<Magnet>& magnets) {
  Environment environment;
  environment.magnets = magnets;
  return {with_environment(EnvironmentLoad{1, 0}, environment)};
}

/// θ, x, z and M of a section of the planar elastica.
using Section = Eigen::Vector4d;

/// The planar elastica with the poles −q and q at the ends of its second segment.
struct Elastica {
  Cilium cilium;
  std::vector<Magnet> magnets;

  /// M, H and V (over their scales) that are left at the tip, and the tip's deflection less w.
  Eigen::Vector4d residuals(const Eigen::Vector4d& u, double w) const {
    const double EI = cilium.segments[1].young_modulus * cilium.second_moment(0);
    const double L = cilium.length();
    const double q = cilium.segments[1].magnetization * cilium.area();
    const double P = EI / (L * L);
    Section y(0, 0, 0, u[0] * EI / L);
    double H = u[1] * P;
    double V = u[2] * P;
    for (std::size_t i = 0; i < 2; ++i) {
      if (i == 1) {
        const Vector3 B = u[3] * jet(magnets, {y[1], 0, y[2]}).B;
        H += q * B.x();
        V += q * B.z();
      }
      const double stiffness = cilium.segments[i].young_modulus * cilium.second_moment(0);
      const auto rate = [&](const Section& s) -> Section {
        return {s[3] / stiffness, std::sin(s[0]), std::cos(s[0]),
                -H * std::cos(s[0]) + V * std::sin(s[0])};
      };
      constexpr int steps = 100;
      const double h = cilium.segments[i].length / steps;
      for (int k = 0; k < steps; ++k) {
        const Section k1 = rate(y);
        const Section k2 = rate(y + h / 2 * k1);
        const Section k3 = rate(y + h / 2 * k2);
        const Section k4 = rate(y + h * k3);
        y += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
      }
    }
    const Vector3 B = u[3] * jet(magnets, {y[1], 0, y[2]}).B;
    return {y[3] * L / EI, (H - q * B.x()) / P, (V - q * B.z()) / P, (y[1] - w) / L};
  }

  /// M, H, V at the base and the magnets' strength t with the tip at w; Newton's method with
  /// differences.
  std::optional<Eigen::Vector4d> solve(double w, Eigen::Vector4d u) const {
    for (int iteration = 0; iteration < 20; ++iteration) {
      const Eigen::Vector4d r = residuals(u, w);
      Eigen::Matrix4d jacobian;
      for (int j = 0; j < 4; ++j) {
        const Eigen::Vector4d d = 1e-6 * Eigen::Vector4d::Unit(j);
        jacobian.col(j) = (residuals(u + d, w) - residuals(u - d, w)) / 2e-6;
      }
      const Eigen::Vector4d step = jacobian.fullPivLu().solve(r);
      u -= step;
      if (step.lpNorm<Eigen::Infinity>() < 1e-9) return u;
    }
    return std::nullopt;
  }

  struct Fold {
    double fraction = 0;
    double deflection = 0;
  };
  /// The largest strength on the way of the tip to the side `way`; none up to 1.
  std::optional<Fold> fold(double way) const {
    const double step = way * cilium.length() / 400;
    std::array<Eigen::Vector4d, 2> u{Eigen::Vector4d::Zero(), Eigen::Vector4d::Zero()};
    for (int k = 1; k < 300; ++k) {
      const auto next = solve(k * step, k > 1 ? Eigen::Vector4d(2 * u[1] - u[0]) : u[1]);
      if (!next) return std::nullopt;
      if ((*next)[3] < u[1][3]) {
        const auto weakness = [&](double w) { return -solve(w, u[1]).value()[3]; };
        const double low = std::min((k - 2) * step, k * step);
        const double high = std::max((k - 2) * step, k * step);
        const auto [w, t] = boost::math::tools::brent_find_minima(weakness, low, high, 30);
        return -t < 1 ? std::optional(Fold{-t, w}) : std::nullopt;
      }
      u = {u[1], *next};
    }
    return std::nullopt;
  }
};

/// Without shear and extension.
MechanicsStep solved(const Cilium& cilium, const std::vector<Magnet>& magnets) {
  return Beam({.shear_rigid = true, .error_estimate = false})
      .solve(cilium, magnets_alone(magnets))
      .steps[0];
}

// The input of the guide as it was: no equilibrium.
// Measured 2e-13 of the fraction.
TEST(PullIn, AgreesWithTheElasticaAboutTheFold) {
  const Cilium cilium = beams::paper_cilium();
  const std::vector<Magnet> magnets{brick({12e-3, 0, 20e-3})};
  const MechanicsStep step = solved(cilium, magnets);
  ASSERT_EQ(step.status, Status::pulled_in) << step.message;
  const auto fold = Elastica{cilium, magnets}.fold(1);
  ASSERT_TRUE(fold);
  EXPECT_LT(beams::measured("fraction", std::abs(step.pull_in->fraction - fold->fraction)), 1e-6);
  EXPECT_LT(beams::measured("tip", std::abs(step.pull_in->tip.x() - fold->deflection)),
            1e-3 * beams::L);
  EXPECT_EQ(step.pull_in->magnet, "brick");
  EXPECT_EQ(step.pull_in->load, step.pull_in->fraction);
  EXPECT_FALSE(step.deformation);
  EXPECT_NE(step.message.find("brick"), std::string::npos);
}

// The smallest eigenvalue falls as sqrt(1 − t/t_c): near the fold its square is linear in t.
TEST(PullIn, TheSmallestEigenvalueVanishesAsASquareRoot) {
  const MechanicsStep step = solved(beams::paper_cilium(), {brick({12e-3, 0, 20e-3})});
  ASSERT_EQ(step.status, Status::pulled_in) << step.message;
  const std::vector<continuation::ApproachToFold>& way = step.pull_in->approach;
  ASSERT_GT(way.size(), 3U);
  EXPECT_EQ(way.front().fraction, 0);
  EXPECT_NEAR(way.front().smallest_eigenvalue, 1, 1e-9);
  EXPECT_EQ(way.back().fraction, step.pull_in->fraction);
  EXPECT_LT(std::abs(way.back().smallest_eigenvalue), 1e-3);
  for (std::size_t i = 1; i < way.size(); ++i) {
    EXPECT_GT(way[i].fraction, way[i - 1].fraction);
    EXPECT_LT(way[i].smallest_eigenvalue, way[i - 1].smallest_eigenvalue);
  }
  // At 99 and 99.9 % the same magnet is borne.
  const auto eigenvalue = [&](double part) {
    const MechanicsStep near =
        solved(beams::paper_cilium(),
               {brick({12e-3, 0, 20e-3}, 1.2 * step.pull_in->fraction * (1 - part))});
    EXPECT_EQ(near.status, Status::converged) << near.message;
    return near.smallest_eigenvalue.value_or(0);
  };
  EXPECT_NEAR(eigenvalue(1e-2) / eigenvalue(1e-3), std::sqrt(10), 0.2);
}

// Random balls in the plane. Five of 24 pull the cilium in, to a magnet or to another equilibrium.
// Measured 1e-12.
TEST(PullIn, AgreesWithTheElasticaBesideRandomMagnets) {
  const Cilium cilium = beams::paper_cilium();
  int pulled_in = 0;
  for (unsigned int seed = 1; seed <= 24; ++seed) {
    std::mt19937 engine(seed);
    std::uniform_real_distribution<double> uniform(0, 1);
    const double side = uniform(engine) < 0.5 ? -1 : 1;
    const Vector3 position(side * (7e-3 + 7e-3 * uniform(engine)), 0,
                           12e-3 + 12e-3 * uniform(engine));
    const double angle = 2 * beams::pi * uniform(engine);
    const double size = 3e-3 + 3e-3 * uniform(engine);
    const double M = (0.5 + uniform(engine)) / vacuum_permeability;
    const std::vector<Magnet> magnets{{"ball",
                                       Shape::ball,
                                       position,
                                       Quaternion::Identity(),
                                       size,
                                       0,
                                       {0, 0, 0},
                                       {M * std::cos(angle), 0, M * std::sin(angle)}}};
    const MechanicsStep step = solved(cilium, magnets);
    if (!step.pull_in) continue;
    ++pulled_in;
    const auto fold = Elastica{cilium, magnets}.fold(step.pull_in->tip.x() > 0 ? 1 : -1);
    ASSERT_TRUE(fold) << "seed " << seed;
    EXPECT_LT(beams::measured("fraction", std::abs(step.pull_in->fraction - fold->fraction)), 1e-6)
        << "seed " << seed;
  }
  EXPECT_GE(pulled_in, 5);
}

// A rigid magnet of length l on a hinge of stiffness k: t T(θ) = k θ with the torque T of the
// poles, so the fold is the maximum of t = kθ/T(θ). The hinge is a base of l/1000, whose end moves
// by as much; measured 6e-4.
TEST(PullIn, ARigidMagnetOnAHingeIsPulledInAtTheMaximumOfItsEquilibria) {
  const double base = 17e-6;
  const double l = 17e-3;
  const double E = 3e6 / 30 * base / 3e-3;
  const Cilium cilium{3e-3, {{"hinge", base, E, 0.49, 0}, {"magnet", l, 3e9, 0.49, 75e3}}};
  const std::vector<Magnet> magnets{brick({12e-3, 0, 17e-3})};
  const double k = E * cilium.second_moment(0) / base;
  const double q = 75e3 * cilium.area();
  const auto strength = [&](double theta) {
    const Vector3 arm(l * std::sin(theta), 0, l * std::cos(theta));
    const Vector3 force = q * jet(magnets, arm).B;
    return k * theta / arm.cross(force).y();
  };
  const auto [theta, t] = boost::math::tools::brent_find_minima(
      [&](double angle) { return -strength(angle); }, 1e-3, 0.35, 30);
  const MechanicsStep step = solved(cilium, magnets);
  ASSERT_EQ(step.status, Status::pulled_in) << step.message;
  EXPECT_LT(beams::measured("fraction", std::abs(step.pull_in->fraction / -t - 1)), 3e-3);
  EXPECT_NEAR(step.pull_in->tip_angle, theta, 5e-3);
}

TEST(PullIn, AFarMagnetConverges) {
  const MechanicsStep step = solved(beams::paper_cilium(), {brick({30e-3, 0, 20e-3})});
  EXPECT_EQ(step.status, Status::converged) << step.message;
  EXPECT_FALSE(step.pull_in);
}

// One iteration is too few for Newton's method: no evidence of a fold.
TEST(PullIn, ASolverThatFailsIsNoPullIn) {
  for (const double distance : {12e-3, 30e-3}) {
    const MechanicsStep step =
        Beam({.max_iterations = 1, .max_cutbacks = 0, .error_estimate = false})
            .solve(beams::paper_cilium(), magnets_alone({brick({distance, 0, 20e-3})}))
            .steps[0];
    EXPECT_EQ(step.status, Status::failed);
    EXPECT_FALSE(step.pull_in);
  }
}

// A path of strengths: the step beyond the fold starts anew and is borne.
TEST(PullIn, ThePathGoesOn) {
  Environment environment;
  environment.magnets = {brick({12e-3, 0, 20e-3})};
  LoadPath path;
  for (const double scale : {0.05, 1.0, 2.0, 0.05})
    path.push_back(with_environment(EnvironmentLoad{scale, 0}, environment));
  const auto steps = Beam({.error_estimate = false}).solve(beams::paper_cilium(), path).steps;
  EXPECT_EQ(steps[0].status, Status::converged) << steps[0].message;
  ASSERT_EQ(steps[1].status, Status::pulled_in) << steps[1].message;
  ASSERT_EQ(steps[2].status, Status::pulled_in) << steps[2].message;
  EXPECT_EQ(steps[3].status, Status::converged) << steps[3].message;
  // The same magnet at half the fraction of twice the load.
  EXPECT_NEAR(steps[1].pull_in->fraction, 2 * steps[2].pull_in->fraction, 1e-9);
  EXPECT_NEAR(steps[1].pull_in->load, steps[2].pull_in->load, 1e-6);
  const CentrelinePoint first = steps[0].deformation->centreline.at(beams::L);
  const CentrelinePoint last = steps[3].deformation->centreline.at(beams::L);
  EXPECT_LT((first.position - last.position).norm(), 1e-9 * beams::L);
}

// With a contact on its way, the environment that pulls the cilium in before is said to.
TEST(PullIn, IsStatedBesideAContactToo) {
  Environment environment;
  environment.magnets = {brick({12e-3, 0, 20e-3})};
  const Load load = with_environment(ContactLoad{1e-3, 16e-3, 0}, environment);
  const MechanicsStep step =
      Beam({.error_estimate = false}).solve(beams::paper_cilium(), {load}).steps[0];
  ASSERT_EQ(step.status, Status::pulled_in) << step.message;
  EXPECT_EQ(step.pull_in->load, 0);
}

// The textbook's plate on a spring, t = x (1 − x)²: it is pulled in at x = 1/3, t = 4/27.
TEST(TurningPoint, OfAPlateOnASpringIsAtAThirdOfTheGap) {
  for (const double first : {1e-3, 0.125, 1.0}) {
    double accepted = 0;
    double x = 0;
    const continuation::Branch branch{
        [&](double s) -> std::optional<continuation::BranchPoint> {
          x = accepted + s;
          if (x >= 1) return std::nullopt;
          return continuation::BranchPoint{x * (1 - x) * (1 - x), (1 - x) * (1 - 3 * x)};
        },
        [&] { accepted = x; }};
    const auto fold = continuation::turning_point(branch, {0, 1}, first);
    ASSERT_TRUE(fold) << first;
    EXPECT_NEAR(fold->fraction, 4.0 / 27, 1e-12);
    EXPECT_NEAR(x, 1.0 / 3, 1e-6);
  }
}

// 7 x (1 − x)² has its maximum, 28/27, beyond t = 1.
TEST(TurningPoint, BeyondTheEndOfTheWayIsNone) {
  double accepted = 0;
  double x = 0;
  const continuation::Branch branch{
      [&](double s) -> std::optional<continuation::BranchPoint> {
        x = accepted + s;
        if (x >= 1) return std::nullopt;
        return continuation::BranchPoint{7 * x * (1 - x) * (1 - x), 7 * (1 - x) * (1 - 3 * x)};
      },
      [&] { accepted = x; }};
  EXPECT_FALSE(continuation::turning_point(branch, {0, 7}, 0.125));
}

}  // namespace pull_in
}  // namespace ciliaval::fem::beam
