// SPDX-License-Identifier: LGPL-2.1-or-later
#include "problem/lagrange.h"

#include <cmath>
#include <numbers>
#include <utility>

#include "problem/error.h"

namespace ciliaval {

LagrangeBasis::LagrangeBasis(std::vector<double> nodes)
    : nodes_(std::move(nodes)), weights_(nodes_.size(), 1.0) {
  if (nodes_.empty()) throw InputError("an interpolation needs at least one node");
  // Differences are scaled by the interval's capacity (length/4), so that the products neither
  // overflow nor underflow.
  const double capacity = nodes_.size() > 1 ? (nodes_.back() - nodes_.front()) / 4 : 1.0;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    for (std::size_t j = 0; j < nodes_.size(); ++j) {
      if (j == i) continue;
      if (nodes_[i] == nodes_[j]) throw InputError("two interpolation nodes coincide");
      weights_[i] *= capacity / (nodes_[i] - nodes_[j]);
    }
  }
  const std::size_t n = size();
  differentiation_.assign(n * n, 0.0);
  for (std::size_t j = 0; j < n; ++j) {
    for (std::size_t i = 0; i < n; ++i) {
      if (i == j) continue;
      differentiation_[j * n + i] = weights_[i] / weights_[j] / (nodes_[j] - nodes_[i]);
      differentiation_[j * n + j] -= differentiation_[j * n + i];  // constants have no derivative
    }
  }
}

void LagrangeBasis::values(double x, std::span<double> values) const {
  double sum = 0;
  for (std::size_t i = 0; i < size(); ++i) {
    const double distance = x - nodes_[i];
    if (distance == 0) {
      for (double& value : values) value = 0;
      values[i] = 1;
      return;
    }
    values[i] = weights_[i] / distance;
    sum += values[i];
  }
  for (std::size_t i = 0; i < size(); ++i) values[i] /= sum;
}

void LagrangeBasis::values_and_derivatives(double x, std::span<double> values,
                                           std::span<double> derivatives) const {
  this->values(x, values);
  // p' is a polynomial too: ℓ_i'(x) = Σ_j ℓ_j(x) ℓ_i'(x_j).
  const std::size_t n = size();
  for (std::size_t i = 0; i < n; ++i) derivatives[i] = 0;
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t i = 0; i < n; ++i) derivatives[i] += values[j] * differentiation_[j * n + i];
}

LagrangeValues::LagrangeValues(const LagrangeBasis& basis, double x) : value{}, derivative{} {
  const std::size_t n = basis.size();
  if (n > value.size()) throw InputError("an interpolation has at most 16 nodes here");
  basis.values_and_derivatives(x, std::span(value).first(n), std::span(derivative).first(n));
}

std::vector<double> chebyshev_points(std::size_t n, double a, double b) {
  if (n < 2) throw InputError("Chebyshev points of the second kind: at least two");
  std::vector<double> points(n);
  for (std::size_t i = 0; i < n; ++i) {
    // sin of the angle from the middle is symmetric to the last bit, unlike cos.
    const double angle = std::numbers::pi *
                         (2.0 * static_cast<double>(i) - static_cast<double>(n - 1)) /
                         (2.0 * static_cast<double>(n - 1));
    points[i] = (a + b) / 2 + (b - a) / 2 * std::sin(angle);
  }
  points.front() = a;
  points.back() = b;
  return points;
}

QuadratureRule gauss_legendre(std::size_t n, double a, double b) {
  if (n < 1) throw InputError("a quadrature rule needs at least one point");
  QuadratureRule rule{std::vector<double>(n), std::vector<double>(n)};
  const auto degree = static_cast<double>(n);
  for (std::size_t i = 0; i < (n + 1) / 2; ++i) {
    double x = std::cos(std::numbers::pi * (static_cast<double>(i) + 0.75) / (degree + 0.5));
    double derivative = 0;
    for (int iteration = 0; iteration < 100; ++iteration) {
      double p = 1;
      double previous = 0;
      for (std::size_t k = 1; k <= n; ++k) {
        const auto order = static_cast<double>(k);
        const double next = ((2 * order - 1) * x * p - (order - 1) * previous) / order;
        previous = p;
        p = next;
      }
      derivative = degree * (x * p - previous) / (x * x - 1);
      const double step = p / derivative;
      x -= step;
      if (std::abs(step) < 1e-15) break;
    }
    if (n % 2 == 1 && i == n / 2) x = 0;
    const double weight = 2 / ((1 - x * x) * derivative * derivative);
    rule.nodes[i] = (a + b) / 2 - (b - a) / 2 * x;
    rule.nodes[n - 1 - i] = (a + b) / 2 + (b - a) / 2 * x;
    rule.weights[i] = rule.weights[n - 1 - i] = (b - a) / 2 * weight;
  }
  return rule;
}

}  // namespace ciliaval
