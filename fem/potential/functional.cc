// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/potential/functional.h"

#include <deal.II/base/mpi.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "problem/support/interruption.h"

namespace ciliaval::fem::potential {
namespace {

/// ∫ k y₁² dv over a ball of radius 1, k = (1 − r²)⁴: 4π/3 ∫ r⁴ (1 − r²)⁴ dr = 4π/3 · 128/15015.
constexpr double normalisation = 4 * std::numbers::pi / 3 * 128 / 15015;

}  // namespace

SensorFunctional::SensorFunctional(const PotentialSpace& space, std::vector<SensorBall> balls)
    : space_(space), balls_(std::move(balls)) {}

/// Calls act(cell, weights) with the row of ∂/∂u_i of ∇ψ for each node i of each own leaf that
/// meets the ball. Leaves larger than a fifth of the radius are cut for the quadrature.
template <typename Act>
void SensorFunctional::for_each_cell(const SensorBall& ball, const Act& act) const {
  constexpr std::size_t points = 5;
  support::check_interruption();
  const Vector3 reach = Vector3::Constant(ball.radius);
  const double scale = 1 / (normalisation * std::pow(ball.radius, 5));
  Eigen::Matrix<double, Eigen::Dynamic, 3> weights(space_.nodes(), 3);
  const auto add_cell = [&](int cell) {
    const Cube& cube = space_.octree().cubes()[static_cast<std::size_t>(cell)];
    if (cube.box().exteriorDistance(ball.centre) >= ball.radius) return;
    weights.setZero();
    const auto parts = static_cast<std::size_t>(std::ceil(5 * cube.size / ball.radius));
    std::vector<double> x;
    std::vector<double> w;
    for (std::size_t part = 0; part < parts; ++part) {
      const double width = 1 / static_cast<double>(parts);
      const QuadratureRule rule = gauss_legendre(points, static_cast<double>(part) * width,
                                                 static_cast<double>(part + 1) * width);
      x.insert(x.end(), rule.nodes.begin(), rule.nodes.end());
      w.insert(w.end(), rule.weights.begin(), rule.weights.end());
    }
    for (std::size_t a = 0; a < x.size(); ++a) {
      for (std::size_t b = 0; b < x.size(); ++b) {
        for (std::size_t c = 0; c < x.size(); ++c) {
          const Vector3 unit(x[a], x[b], x[c]);
          const Vector3 y = cube.lower + cube.size * unit - ball.centre;
          const double rest = 1 - y.squaredNorm() / (ball.radius * ball.radius);
          if (rest <= 0) continue;
          const double weight =
              scale * std::pow(rest, 4) * w[a] * w[b] * w[c] * std::pow(cube.size, 3);
          weights += weight * shape_values(space_.basis(), unit) * y.transpose();
        }
      }
    }
    act(cell, weights);
  };
  space_.octree().for_each_in({ball.centre - reach, ball.centre + reach}, add_cell);
}

std::vector<Vector3> SensorFunctional::gradients(const PotentialVector& complete) const {
  std::vector<double> sums;
  Eigen::VectorXd u(space_.nodes());
  for (const SensorBall& ball : balls_) {
    Vector3 gradient = Vector3::Zero();
    for_each_cell(ball, [&](int cell, const auto& weights) {
      space_.read(cell, complete, u);
      gradient += weights.transpose() * u;
    });
    sums.insert(sums.end(), gradient.begin(), gradient.end());
  }
  dealii::Utilities::MPI::sum(sums, space_.octree().communicator(), sums);
  std::vector<Vector3> result;
  for (std::size_t s = 0; s < balls_.size(); ++s)
    result.emplace_back(sums[3 * s], sums[3 * s + 1], sums[3 * s + 2]);
  return result;
}

PotentialVector SensorFunctional::load(const std::vector<Vector3>& directions) const {
  PotentialVector result = space_.vector();
  for (std::size_t s = 0; s < balls_.size(); ++s)
    for_each_cell(balls_[s], [&](int cell, const auto& weights) {
      space_.add_free(cell, weights * directions[s], result);
    });
  result.compress(dealii::VectorOperation::add);
  return result;
}

}  // namespace ciliaval::fem::potential
