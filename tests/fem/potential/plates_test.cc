// SPDX-License-Identifier: LGPL-2.1-or-later
// Permeable plates by the charges of their faces.
#include "fem/potential/plates/charges.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <vector>

#include "bodies.h"
#include "fem/potential/adaptive.h"
#include "problem/error.h"

namespace ciliaval::fem::potential {
namespace {

/// Moment of the charges over H₀, m³, in the uniform field H₀ = e_z.
double moment(const std::vector<PermeableBox>& boxes, double step) {
  const plates::Charges on_faces(boxes, {}, step);
  const Eigen::VectorXd charges = on_faces.charges([](const Vector3&) { return Vector3::UnitZ(); });
  double sum = 0;
  for (std::size_t i = 0; i < on_faces.rectangles().size(); ++i) {
    const plates::ChargedRectangle& r = on_faces.rectangles()[i];
    r.for_each_point(2, [&](const Vector3& x, double weight, const Vector3& densities) {
      sum += weight * r.area() * x.z() *
             densities.dot(charges.segment<3>(3 * static_cast<Eigen::Index>(i)));
    });
  }
  return sum;
}

const PermeableBox cube{{Vector3::Zero().eval(), Vector3::Ones().eval()}, 1e7};

// Oracle: quadrature. Off the rectangle, and in its plane.
TEST(ChargedRectangle, FieldAndPotentialAreTheirIntegrals) {
  const plates::ChargedRectangle r{1, {-0.3, 0.2, 0.1}, {0.4, 0.2, 0.9}};
  for (const Vector3& x : {Vector3(0.1, 0.5, 0.3), Vector3(0.1, -0.2, 2), Vector3(1.5, 0.2, 0.5),
                           Vector3(-0.3, 0.9, 0.1), Vector3(0, 0.2, -1)}) {
    Matrix3 H = Matrix3::Zero();
    double psi = 0;
    constexpr int cuts = 24;
    for (int i = 0; i < cuts; ++i)
      for (int j = 0; j < cuts; ++j) {
        plates::ChargedRectangle part = r;
        const Vector3 size((r.upper.x() - r.lower.x()) / cuts, 0,
                           (r.upper.z() - r.lower.z()) / cuts);
        part.lower += Vector3(i * size.x(), 0, j * size.z());
        part.upper = part.lower + size;
        part.for_each_point(6, [&](const Vector3& y, double weight, const Vector3&) {
          const Vector3 d = x - y;
          const double dA = weight * part.area() / (4 * std::numbers::pi);
          // The axes after y are z and x.
          const Vector3 densities(1, (y.z() - 0.5) / 0.8, (y.x() - 0.05) / 0.7);
          H += dA / std::pow(d.norm(), 3) * d * densities.transpose();
          psi += dA / d.norm();
        });
      }
    EXPECT_LT((r.field(x) - H).norm(), 1e-9 * H.norm()) << x.transpose();
    EXPECT_NEAR(r.potential(x) / psi, 1, 1e-10);
  }
}

// Oracle: the polarisability of a perfectly conducting cube, 3.644305 (Sihvola et al., IEEE Trans.
// Antennas Propag. 52, 2226, 2004), which is that of an infinitely permeable one.
TEST(PlateCharges, ACubeOfIronHasTheMomentOfAConductor) {
  const double coarse = moment({cube}, 1.0);
  const double fine = moment({cube}, 0.6);
  std::printf("polarisability %.4f, %.4f\n", coarse, fine);
  EXPECT_NEAR(fine, 3.644305, 0.02);
  EXPECT_LT(std::abs(fine - 3.644305), 0.6 * std::abs(coarse - 3.644305));
}

// Oracle: one box. Cut in two at a plane, without a face between them.
TEST(PlateCharges, ABoxOfTwoIsOneBox) {
  for (const double mu : {1.5, 300.0}) {
    const PermeableBox whole{{Vector3(0, 0, 0), Vector3(1, 1, 0.4)}, mu};
    const PermeableBox left{{Vector3(0, 0, 0), Vector3(0.3, 1, 0.4)}, mu};
    const PermeableBox right{{Vector3(0.3, 0, 0), Vector3(1, 1, 0.4)}, mu};
    EXPECT_NEAR(moment({left, right}, 0.8) / moment({whole}, 0.8), 1, 3e-3) << mu;
  }
}

// Oracle: first order in μ_r − 1, M = (μ_r − 1) H₀; with two materials the sum of both.
TEST(PlateCharges, WeakBoxesAddUp) {
  const PermeableBox low{{Vector3(0, 0, 0), Vector3(1, 1, 0.4)}, 1 + 1e-6};
  const PermeableBox high{{Vector3(0, 0, 0.4), Vector3(1, 1, 1)}, 1 + 3e-6};
  EXPECT_NEAR(moment({low, high}, 1.0), 0.4e-6 + 0.6 * 3e-6, 1e-11);
}

// Oracle: two separate boxes, for boxes that touch in an edge alone; one box, for a weak one on it.
TEST(PlateCharges, EachBodyIsNeutral) {
  const PermeableBox iron{{Vector3(0, 0, 0), Vector3(1, 1, 0.4)}, 2e4};
  const auto at_corner = [](double gap) {
    return PermeableBox{{Vector3(1 + gap, 0, 0.4 + gap), Vector3(2, 1, 0.8)}, 2e4};
  };
  EXPECT_NEAR(moment({iron, at_corner(0)}, 0.8) / moment({iron, at_corner(1e-3)}, 0.8), 1, 2e-2);
  const PermeableBox film{{Vector3(0, 0, 0.4), Vector3(1, 1, 0.5)}, 1 + 1e-9};
  EXPECT_NEAR(moment({iron, film}, 0.8) / moment({iron}, 0.8), 1, 2e-3);
}

/// B_z at the chip below the paper's straight cilium, over a plate of 20 × 20 × 2 mm, mT.
PotentialResult at_the_chip(double mu, double bend) {
  PotentialProblem problem;
  problem.magnet = Magnet(test::paper_cilium(), test::arc(bend), MagnetPushForward::F);
  problem.plates = std::make_shared<const plates::Plates>(
      std::vector<PermeableBox>{{{Vector3(-1e-2, -1e-2, -6e-3), Vector3(1e-2, 1e-2, -4e-3)}, mu}});
  problem.points = {{0, 0, -2.1e-3}};
  return solve_potential(problem, {});
}

/// B, mT, over discs of the same thickness inside of the plate, of its area and around it, by ring
/// charges on their surfaces (an independent program; 160 rings).
struct Discs {
  double mu, inside, of_equal_area, around;
};

void expect_between(const Discs& discs) {
  const PotentialResult result = at_the_chip(discs.mu, 0);
  ASSERT_EQ(result.uncertainty.size(), 1U);
  const double B = 1e3 * result.B[0].z();
  std::printf("mu_r %g: %.4f mT +- %.4f\n", discs.mu, B, 1e3 * result.uncertainty[0].z());
  EXPECT_GT(B, discs.inside);
  EXPECT_LT(B, discs.around);
  EXPECT_NEAR(B / discs.of_equal_area, 1, 5e-3);
  EXPECT_LT(1e3 * result.uncertainty[0].z(), 2e-3 * B);
}

TEST(Plate, OfIronLiesBetweenDiscsInsideAndAround) {
  expect_between({4000, 2.2211, 2.2486, 2.2895});
}

TEST(PlateSlow, OfPureIronLiesBetweenDiscsInsideAndAround) {
  expect_between({20000, 2.2214, 2.2489, 2.2899});
}

// Oracle: a tenth of the tolerance. Random plates below the straight cilium or beside it, also two
// that touch, μ_r from 1.1 to 20,000; both sensors above the plate.
TEST(PlateSlow, UncertaintyHoldsOnRandomPlates) {
  std::mt19937 engine(20261129);
  const auto random = [&](double a, double b) {
    return std::uniform_real_distribution(a, b)(engine);
  };
  const Magnet magnet(test::paper_cilium(), test::arc(0), MagnetPushForward::F);
  std::vector<double> ratios;
  for (int n = 0; n < 20; ++n) {
    const double mu = std::exp(random(std::log(1.1), std::log(2e4)));
    const double top = random(-5e-3, -2.5e-3);
    const Vector3 lower(random(-12e-3, -5e-3), random(-12e-3, -5e-3), top - random(0.5e-3, 3e-3));
    const Vector3 upper(random(5e-3, 12e-3), random(5e-3, 12e-3), top);
    std::vector<PermeableBox> boxes{{{lower, upper}, mu}};
    if (n % 4 == 3)
      boxes.push_back({{Vector3(upper.x(), lower.y(), lower.z()),
                        Vector3(upper.x() + random(1e-3, 4e-3), upper.y(), random(0, 6e-3))},
                       mu});
    const std::vector<Vector3> points{
        {0, 0, top + random(0.5e-3, 2e-3)},
        {random(-2e-3, 2e-3), random(-2e-3, 2e-3), top + random(0.5e-3, 2e-3)}};
    const plates::Plates on(boxes);
    const std::vector<double> tolerance(2, 4e-6);  // T
    const plates::AddedField coarse = on.field(magnet, 0, {}, Vector3::Zero(), points, tolerance);
    plates::AddedField fine;
    try {
      fine = on.field(magnet, 0, {}, Vector3::Zero(), points, std::vector<double>(2, 6e-7));
    } catch (const SolverError&) {  // the finest is not so fine
      continue;
    }
    for (std::size_t i = 0; i < 2; ++i)
      ratios.push_back((coarse.B[i] - fine.B[i]).norm() / coarse.uncertainty[i]);
  }
  ASSERT_GT(ratios.size(), 20U);
  std::ranges::sort(ratios);
  std::printf("%zu: error over uncertainty %.2f at the median, %.2f at most\n", ratios.size(),
              ratios[ratios.size() / 2], ratios.back());
  EXPECT_LT(ratios.back(), 1);
}

// Oracle: the same with a tolerance of a quarter. Straight and bent, weak and strong; the error is
// within what is stated.
TEST(PlateSlow, UncertaintyHoldsAgainstAFinerSolution) {
  for (const double bend : {0.0, 0.6})
    for (const double mu : {10.0, 300.0, 4000.0, 20000.0}) {
      PotentialProblem problem;
      problem.magnet = Magnet(test::paper_cilium(), test::arc(bend), MagnetPushForward::F);
      problem.relative_permeability = 1.05;
      problem.plates = std::make_shared<const plates::Plates>(std::vector<PermeableBox>{
          {{Vector3(-1e-2, -1e-2, -6e-3), Vector3(1e-2, 1e-2, -4e-3)}, mu}});
      problem.points = {{0, 0, -2.1e-3}, {1e-3, 0.5e-3, -2.1e-3}};
      const PotentialResult coarse = solve_potential(problem, {.tolerance = 4e-3});
      const PotentialResult fine = solve_potential(problem, {.tolerance = 1e-3});
      for (std::size_t i = 0; i < 2; ++i) {
        const Vector3 error = coarse.B[i] - fine.B[i];
        for (Eigen::Index c = 0; c < 3; ++c)
          EXPECT_LT(std::abs(error[c]), coarse.uncertainty[i][c]) << mu << ' ' << bend << ' ' << c;
      }
    }
}

}  // namespace
}  // namespace ciliaval::fem::potential
