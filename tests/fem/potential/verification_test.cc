// SPDX-License-Identifier: LGPL-2.1-or-later
// B of whole problems against closed forms, and how true its estimate is.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>
#include <utility>

#include "analytic/rod/field_models.h"
#include "bodies.h"
#include "fem/potential/adaptive.h"
#include "fem/potential/potential.h"
#include "permeable_cylinder.h"
#include "problem/lagrange.h"
#include "tests/analytic/oracles/cylinder_body.h"
#include "tests/analytic/oracles/derby_olbert.h"

namespace ciliaval::fem::potential {
namespace {

using test::R;

/// Checks every mesh of the sequence: the error of the vector B at each point
/// over |B| is its estimate within a factor of two either way (measured 0.79 to 1.38).
void check(const char* name, const PotentialResult& result, const std::vector<Vector3>& exact,
           double tolerance) {
  for (const PotentialCycle& cycle : result.cycles) {
    for (std::size_t i = 0; i < exact.size(); ++i) {
      const double error = (cycle.B[i] - exact[i]).norm();
      const double estimate = cycle.estimate(i).norm();
      std::printf("%s: %7zu unknowns, error %.1e, estimate %.1e, effectivity %.2f\n", name,
                  cycle.unknowns, error / exact[i].norm(), estimate / exact[i].norm(),
                  estimate / error);
      EXPECT_GT(estimate / error, 0.5);
      EXPECT_LT(estimate / error, 2);
    }
  }
  for (std::size_t i = 0; i < exact.size(); ++i)
    EXPECT_LT((result.B[i] - exact[i]).norm(), tolerance * exact[i].norm());
}

PotentialResult solve(const Magnet& magnet, double mu, const std::vector<Vector3>& points,
                      double tolerance, const Vector3& uniform = Vector3::Zero()) {
  PotentialProblem problem;
  problem.magnet = magnet;
  problem.relative_permeability = mu;
  problem.points = points;
  problem.uniform_field = uniform;
  PotentialControl control;
  control.tolerance = 2 * tolerance;  // the uncertainty is twice the estimate
  return solve_potential(problem, control);
}

const std::vector<Vector3> around_ball{{0.4e-3, 2.2e-3, 1.1e-3}, {-0.2e-3, 0.3e-3, -3.1e-3}};
const Vector3 ball_magnetization(20e3, -30e3, 60e3);
const double ball_volume = 4 * std::numbers::pi / 3 * R * R * R;

/// The field of a dipole at the ball's centre in a uniform one, around the ball.
std::vector<Vector3> dipole_fields(const Vector3& moment,
                                   const Vector3& uniform = Vector3::Zero()) {
  std::vector<Vector3> result;
  result.reserve(around_ball.size());
  for (const Vector3& x : around_ball) result.emplace_back(uniform + test::dipole_field(moment, x));
  return result;
}

// Oracle: outside of a uniformly magnetised ball the field is that of the dipole V m, exactly.
TEST(MagnetisedBall, FieldIsThatOfItsDipole) {
  const std::vector<Vector3> exact = dipole_fields(ball_volume * ball_magnetization);
  const Magnet magnet(test::ball(R, ball_magnetization), MagnetPushForward::F);
  check("ball", solve(magnet, 1, around_ball, 1e-3), exact, 1e-3);
}

// Oracle: a ball of remanent m and recoil permeability μ_r has inside H = −m/(μ_r + 2) (the
// demagnetising factor is 1/3), so that outside it is the dipole 3V m/(μ_r + 2).
TEST(MagnetisedBall, RecoilPermeabilityWeakensTheDipole) {
  const std::vector<Vector3> exact = dipole_fields(3 * ball_volume / 3.05 * ball_magnetization);
  const Magnet magnet(test::ball(R, ball_magnetization), MagnetPushForward::F);
  check("ball, 1.05", solve(magnet, 1.05, around_ball, 2e-3), exact, 2e-3);
}

// Oracle: a permeable ball in a uniform field B₀ is the dipole 4πR³ (μ_r − 1)/(μ_r + 2) B₀/μ₀. Its
// own magnetisation here is 1e-9 of the induced one.
TEST(PermeableBall, DisturbsAUniformFieldByADipole) {
  const Vector3 B0(2e-3, 1e-3, -3e-3);
  for (const double mu : {0.5, 5.0}) {
    const Vector3 dipole = 3 * ball_volume * (mu - 1) / (mu + 2) / vacuum_permeability * B0;
    const std::vector<Vector3> exact = dipole_fields(dipole, B0);
    const Magnet magnet(test::ball(R, Vector3(0, 0, 1e-6)), MagnetPushForward::F);
    check("permeable ball", solve(magnet, mu, around_ball, 1e-2, B0), exact, 1e-2);
  }
}

// Oracle: Derby & Olbert in 50 digits.
TEST(StraightCilium, FieldIsDerbyAndOlbertsAtThePapersSensor) {
  const std::vector<Vector3> points{test::paper_sensor()};
  const std::vector<Vector3> exact{
      oracle::derby_olbert(75e3, R, 3e-3, 20e-3, test::paper_sensor())};
  const Magnet magnet(test::paper_cilium(), test::arc(0), MagnetPushForward::F);
  const PotentialResult result = solve(magnet, 1, points, 4e-4);
  check("straight", result, exact, 4e-4);
  // The outer boundary's error is far below: a bound, at most a tenth of the estimate.
  const PotentialCycle& last = result.cycles.back();
  EXPECT_LT(last.truncation, 0.1 * last.difference.front().norm());
}

// Oracle: an integral equation for the charge on the magnet's surface (permeable_cylinder.h), to
// eleven digits.
TEST(PermeableStraightCilium, FieldIsThatOfItsSurfaceCharge) {
  const std::vector<Vector3> points{test::paper_sensor()};
  const Magnet magnet(test::paper_cilium(), test::arc(0), MagnetPushForward::F);
  for (const auto& [mu, tolerance] : {std::pair(1.05, 3e-4), std::pair(2.0, 5e-3)}) {
    const std::vector<Vector3> exact{
        oracle::PermeableCylinder(75e3, mu, R, 3e-3, 20e-3, {}).B(points[0])};
    check("permeable straight cilium", solve(magnet, mu, points, tolerance), exact, tolerance);
  }
}

// Oracle: the two charged discs of the bent rod's true volume (docs/theory/fields.md), another
// code; and the same body as a solid's cells of degree 6 in place of the rod.
TEST(BentCilium, FieldIsThatOfTwoDiscsAsRodAndAsSolid) {
  const Deformation bent = test::arc(60);
  const std::vector<Vector3> points{test::paper_sensor()};
  const std::vector<Vector3> exact = analytic::rod::VolumeField(analytic::rod::VolumeOptions{})
                                         .field(test::paper_cilium(), bent, points)
                                         .B;
  const Magnet rod(test::paper_cilium(), bent, MagnetPushForward::F);
  check("bent rod", solve(rod, 1, points, 1e-3), exact, 1e-3);

  const auto map = [&](const Vector3& X) {
    const CentrelinePoint section = bent.centreline.at(X[2]);
    return Vector3(section.position + section.rotation * Vector3(X[0], X[1], 0));
  };
  const Magnet solid(oracle::CylinderBody{}.moved(map), MagnetPushForward::F);
  check("bent solid", solve(solid, 1, points, 1e-3), exact, 1e-3);
}

// The error that a narrow box makes is below its bound, and the bound of the usual box is nothing
// beside the estimate.
TEST(OuterBoundary, ErrorIsBelowItsBoundAndFarBelowTheEstimate) {
  const std::vector<Vector3> points{test::paper_sensor()};
  const Vector3 exact = oracle::derby_olbert(75e3, R, 3e-3, 20e-3, test::paper_sensor());
  PotentialProblem problem;
  problem.magnet = Magnet(test::paper_cilium(), test::arc(0), MagnetPushForward::F);
  problem.points = points;
  PotentialControl control;
  control.tolerance = 4e-2;
  control.box = 2.5;
  const PotentialResult narrow = solve_potential(problem, control);
  control.box = 16;
  const PotentialResult wide = solve_potential(problem, control);
  const auto error = [&](const PotentialResult& r) {
    const PotentialCycle& last = r.cycles.back();
    return (last.B[0] + last.difference[0] - exact).norm();
  };
  std::printf("narrow: bound %.1e, error one degree higher %.1e; wide: bound %.1e, error %.1e\n",
              narrow.cycles.back().truncation / exact.norm(), error(narrow) / exact.norm(),
              wide.cycles.back().truncation / exact.norm(), error(wide) / exact.norm());
  EXPECT_LT(error(narrow), narrow.cycles.back().truncation + 1e-3 * exact.norm());
  EXPECT_LT(wide.cycles.back().truncation, 1e-3 * narrow.cycles.back().truncation);
}

// The errors that the estimate does not see, by the sampling of the magnet, the quadrature of the
// sensor's ball and the outer boundary, are far below it: the error that is left one degree higher.
// Oracle: the two charged discs; measured below 0.1 of the estimate.
TEST(Sampling, OfTheMagnetIsFarBelowTheEstimate) {
  const Deformation bent = test::arc(60);
  const std::vector<Vector3> points{test::paper_sensor()};
  const Vector3 exact = analytic::rod::VolumeField(analytic::rod::VolumeOptions{})
                            .field(test::paper_cilium(), bent, points)
                            .B[0];
  const Magnet rod(test::paper_cilium(), bent, MagnetPushForward::F);
  const PotentialCycle last = solve(rod, 1, points, 1e-3).cycles.back();
  const double rest = (last.B[0] + last.difference[0] - exact).norm() / last.difference[0].norm();
  std::printf("rest %.1e of the estimate\n", rest);
  EXPECT_LT(rest, 0.3);
}

// Oracle: the image of a magnet in a permeable half-space, −m mirrored, times (μ_r − 1)/(μ_r + 1).
// A plate of 100 × 100 × 40 mm stands for the half-space; its finite size is worth less than 0.5 %.
TEST(Plate, ActsLikeTheImageOfTheMagnet) {
  constexpr double mu = 4;
  const Vector3 centre(0, 0, 4e-3);
  PotentialProblem problem;
  std::shared_ptr<SolidBody> body = std::make_shared<SolidBody>(*test::ball(R, ball_magnetization));
  for (SolidCell& cell : body->cells)
    for (std::size_t i = 0; i < cell.current.size(); ++i) {
      cell.current[i] += centre;
      cell.reference[i] += centre;
    }
  problem.magnet = Magnet(body, MagnetPushForward::F);
  problem.plates = std::make_shared<const plates::Plates>(
      std::vector<PermeableBox>{{{Vector3(-50e-3, -50e-3, -40e-3), Vector3(50e-3, 50e-3, 0)}, mu}});
  problem.points = {{0.3e-3, -0.4e-3, 1e-3}};
  PotentialControl control;
  control.tolerance = 2e-2;
  const PotentialResult result = solve_potential(problem, control);
  const Vector3 m = ball_volume * ball_magnetization;
  const Vector3 image = (mu - 1) / (mu + 1) * Vector3(-m[0], -m[1], m[2]);
  const std::vector<Vector3> exact{test::dipole_field(m, problem.points[0] - centre) +
                                   test::dipole_field(image, problem.points[0] + centre)};
  const double error = (result.B[0] - exact[0]).norm() / exact[0].norm();
  std::printf("image in a plate: %.1e\n", error);
  EXPECT_LT(error, 1e-2);
}

/// B of the charge M·n on the mantle of a standing cylinder: Gauss's rule along it, the trapezoidal
/// one around.
Vector3 of_mantle(double bottom, double top, const Eigen::Vector2d& M, const Vector3& x) {
  constexpr int around = 96;
  const QuadratureRule rule = gauss_legendre(80, bottom, top);
  Vector3 B = Vector3::Zero();
  for (std::size_t i = 0; i < rule.nodes.size(); ++i)
    for (int k = 0; k < around; ++k) {
      const double phi = 2 * std::numbers::pi * k / around;
      const Eigen::Vector2d n(std::cos(phi), std::sin(phi));
      const Vector3 offset = x - Vector3(R * n.x(), R * n.y(), rule.nodes[i]);
      B += 1e-7 * M.dot(n) * rule.weights[i] * R * 2 * std::numbers::pi / around * offset /
           std::pow(offset.norm(), 3);
    }
  return B;
}

// Oracle: the charge on the mantle. The coarsest mesh's estimate is not looked at: it is four times
// too small at the sensor below.
TEST(MagnetisedCylinder, FieldAcrossItsAxisIsThatOfItsMantle) {
  Cilium cilium = test::paper_cilium();
  cilium.segments.back().magnetization = 0;
  cilium.segments.back().transverse_magnetization = {60e3, -30e3};
  const std::vector<Vector3> points{test::paper_sensor(), {3.5e-3, 2e-3, 10e-3}};
  std::vector<Vector3> exact;
  for (const Vector3& x : points) exact.push_back(of_mantle(3e-3, 20e-3, {60e3, -30e3}, x));
  const PotentialResult result =
      solve(Magnet(cilium, test::arc(0), MagnetPushForward::F), 1, points, 2e-3);
  const PotentialCycle& last = result.cycles.back();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double error = (result.B[i] - exact[i]).norm();
    const double estimate = last.estimate(i).norm();
    std::printf("across the axis: error %.1e, estimate %.1e\n", error / exact[i].norm(),
                estimate / exact[i].norm());
    EXPECT_LT(error, 2e-3 * exact[i].norm());
    EXPECT_GT(estimate / error, 0.5);
    EXPECT_LT(estimate / error, 2);
  }
}

}  // namespace
}  // namespace ciliaval::fem::potential
