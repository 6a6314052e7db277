// SPDX-License-Identifier: LGPL-2.1-or-later
// The second-order law of a bent bar against its section's own problem: the energy of the solid's
// material in uniform bending and stretch, least among the deformations of the section (Ritz).
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>
#include <vector>

#include "fem/solid/material/hyperelastic.h"
#include "problem/joints/joints.h"
#include "problem/lagrange.h"

namespace ciliaval::joints {
namespace {

using fem::solid::material::Hyperelastic;

constexpr double EA = std::numbers::pi;  // of E = 1 and the radius 1
constexpr double EI = std::numbers::pi / 4;

/// A bar of the radius 1: F = [∇χ, λ], χ = (x, y) of the section's points, λ = 1 + e + κ (x − x̄).
class Section {
 public:
  explicit Section(double poisson_ratio)
      : bulk_(1 / (3 * (1 - 2 * poisson_ratio))),
        material_(Hyperelastic::neo_hooke(1 / (2 * (1 + poisson_ratio)), bulk_)) {
    constexpr int degree = 6;
    for (int i = 0; i <= degree; ++i)
      for (int j = 0; i + j <= degree; ++j)
        if (i + j > 0) monomials_.push_back({i, j, j % 2 == 0});  // x is even in Y, y odd
    const QuadratureRule radii = gauss_legendre(9, 0, 1);
    constexpr int angles = 20;
    for (std::size_t r = 0; r < radii.nodes.size(); ++r)
      for (int a = 0; a < angles; ++a) {
        const double angle = 2 * std::numbers::pi * (a + 0.5) / angles;
        points_.push_back({radii.nodes[r] * std::cos(angle), radii.nodes[r] * std::sin(angle),
                           radii.weights[r] * radii.nodes[r] * 2 * std::numbers::pi / angles});
      }
    deformation_ = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(monomials_.size()));
  }

  /// Moment and force of the least energy at a curvature and a stretch.
  std::pair<double, double> resultants(double curvature, double stretch) {
    Sums sums = integrate(curvature, stretch);
    for (int iteration = 0; iteration < 50; ++iteration) {
      const Eigen::VectorXd step = sums.hessian.ldlt().solve(-sums.gradient);
      const Eigen::VectorXd before = deformation_;
      const double residual = sums.gradient.norm();
      for (double part = 1; part > 1e-4; part /= 2) {
        deformation_ = before + part * step;
        sums = integrate(curvature, stretch);
        if (sums.gradient.norm() < residual) break;
      }
      if (step.cwiseAbs().maxCoeff() < 1e-10) return {sums.moment, sums.force};
    }
    ADD_FAILURE() << "no least energy";
    return {NAN, NAN};
  }

  /// Stretch and moment without a force, from a guess of the stretch.
  std::pair<double, double> bent(double curvature, double guess) {
    double a = guess;
    double force_a = resultants(curvature, a).second;
    double b = a - force_a / EA;
    for (int iteration = 0; iteration < 20; ++iteration) {
      const auto [moment, force] = resultants(curvature, b);
      if (std::abs(force) < 1e-12) return {b, moment};
      const double next = b - force * (b - a) / (force - force_a);
      a = std::exchange(b, next);
      force_a = force;
    }
    ADD_FAILURE() << "no stretch without a force";
    return {NAN, NAN};
  }

 private:
  struct Monomial {
    int i, j;
    bool of_x;
  };
  struct Point {
    double X, Y, weight;
  };
  struct Sums {
    Eigen::VectorXd gradient;
    Eigen::MatrixXd hessian;
    double moment = 0;
    double force = 0;
  };

  static double power(double x, int n) { return n < 0 ? 0 : std::pow(x, n); }

  Sums integrate(double curvature, double stretch) const {
    const auto n = static_cast<Eigen::Index>(monomials_.size());
    Eigen::VectorXd means = Eigen::VectorXd::Zero(n);
    for (Eigen::Index m = 0; m < n; ++m)
      for (const Point& p : points_) means[m] += p.weight / EA * x_value(m, p);
    Sums sums{Eigen::VectorXd::Zero(n), Eigen::MatrixXd::Zero(n, n)};
    Eigen::MatrixXd dF(9, n);
    for (const Point& p : points_) {
      double x = p.X;
      Matrix3 F = Matrix3::Identity();
      dF.setZero();
      for (Eigen::Index m = 0; m < n; ++m) {
        const auto& [i, j, of_x] = monomials_[static_cast<std::size_t>(m)];
        const Eigen::Index row = of_x ? 0 : 3;
        dF(row, m) = i * power(p.X, i - 1) * power(p.Y, j);
        dF(row + 1, m) = j * power(p.X, i) * power(p.Y, j - 1);
        const double centred = x_value(m, p) - means[m];
        dF(8, m) = curvature * centred;
        x += deformation_[m] * centred;
      }
      F(2, 2) += stretch + curvature * p.X;
      const Eigen::VectorXd change = dF * deformation_;
      for (Eigen::Index k = 0; k < 9; ++k) F(k / 3, k % 3) += change[k];
      const double J = F.determinant();
      const double pressure = bulk_ * (J - 1);
      const Matrix3 P = first_piola_stress(material_, F, pressure);
      const Matrix3 cofactor = J * F.inverse().transpose();
      Eigen::Matrix<double, 9, 1> P9;
      Eigen::Matrix<double, 9, 1> H9;
      for (Eigen::Index k = 0; k < 9; ++k) {
        P9[k] = P(k / 3, k % 3);
        H9[k] = cofactor(k / 3, k % 3);
      }
      const Eigen::Matrix<double, 9, 9> A =
          stress_tangent(material_, F, pressure) + bulk_ * H9 * H9.transpose();
      sums.gradient += p.weight * dF.transpose() * P9;
      sums.hessian += p.weight * dF.transpose() * A * dF;
      sums.force += p.weight * P(2, 2);
      sums.moment += p.weight * P(2, 2) * x;
    }
    return sums;
  }

  double x_value(Eigen::Index m, const Point& p) const {
    const auto& [i, j, of_x] = monomials_[static_cast<std::size_t>(m)];
    return of_x ? power(p.X, i) * power(p.Y, j) : 0;
  }

  double bulk_;
  Hyperelastic material_;
  std::vector<Monomial> monomials_;
  std::vector<Point> points_;
  Eigen::VectorXd deformation_;
};

BendingLaw law(double poisson_ratio) {
  return bending_law(
      2, {.name = "bar", .length = 1, .young_modulus = 1, .poisson_ratio = poisson_ratio});
}

TEST(BendingLaw, BentBarsLengthenAndSoften) {
  for (const double nu : {0.3, 0.4, 0.45, 0.49}) {
    const BendingLaw second = law(nu);
    Section section(nu);
    for (const double curvature : {0.05, 0.1, 0.2, 0.3, 0.4}) {
      const auto [stretch, M] =
          section.bent(curvature, second.lengthening * std::pow(curvature * EI, 2));
      const double mu = M / EI;
      EXPECT_NEAR(stretch, second.lengthening * M * M, 0.3 * std::pow(mu, 4)) << nu;
      const double by_law =
          M / EI + second.softening * std::pow(M, 3) + second.further_softening * std::pow(M, 5);
      EXPECT_NEAR(by_law, curvature, curvature * (3e-3 * mu * mu + std::pow(mu, 6)))
          << "nu " << nu << ", strain " << curvature;
    }
  }
}

// The same number couples tension and bending: it is one energy.
TEST(BendingLaw, TensionSoftensBending) {
  for (const double nu : {0.0, 0.3, 0.49}) {
    constexpr double curvature = 1e-3;
    const auto [up, N_up] = Section(nu).resultants(curvature, 1e-3);
    const auto [down, N_down] = Section(nu).resultants(curvature, -1e-3);
    const double slope = (curvature / up - curvature / down) / (N_up - N_down);
    EXPECT_NEAR(slope, 2 * law(nu).lengthening, 2e-3 * law(nu).lengthening) << nu;
  }
}

}  // namespace
}  // namespace ciliaval::joints
