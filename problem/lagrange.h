// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <array>
#include <span>
#include <vector>

namespace ciliaval {

/// Values and derivatives of the Lagrange polynomials on given nodes, by barycentric weights
/// (Berrut & Trefethen, SIAM Review 46, 2004, Eq. 4.2 and 9.4). Stable for any number of Chebyshev
/// or Gauss–Lobatto nodes.
class LagrangeBasis {
 public:
  LagrangeBasis() = default;
  /// Nodes in increasing order, at least one. Throws InputError if two coincide.
  explicit LagrangeBasis(std::vector<double> nodes);

  std::size_t size() const { return nodes_.size(); }
  const std::vector<double>& nodes() const { return nodes_; }
  /// Barycentric weights: ℓ_i(x) = w_i/(x − x_i) / Σ_j w_j/(x − x_j).
  const std::vector<double>& weights() const { return weights_; }
  /// ℓ_i'(x_j).
  double slope(std::size_t i, std::size_t j) const { return differentiation_[j * size() + i]; }

  /// ℓ_i(x), i < size(), into `values`.
  void values(double x, std::span<double> values) const;
  /// ℓ_i(x) and ℓ_i'(x), i < size().
  void values_and_derivatives(double x, std::span<double> values,
                              std::span<double> derivatives) const;

 private:
  std::vector<double> nodes_;
  std::vector<double> weights_;
  std::vector<double> differentiation_;  ///< D_ji = ℓ_i'(x_j), row j
};

/// Values and derivatives of the polynomials at one point, on the stack: at most 16 nodes.
struct LagrangeValues {
  std::array<double, 16> value;
  std::array<double, 16> derivative;
  /// Throws InputError if there are more nodes.
  LagrangeValues(const LagrangeBasis& basis, double x);
};

/// n ≥ 2 Chebyshev points of the second kind on [a, b], increasing, both ends included exactly.
std::vector<double> chebyshev_points(std::size_t n, double a, double b);

/// Nodes and weights of a quadrature rule on an interval.
struct QuadratureRule {
  std::vector<double> nodes;
  std::vector<double> weights;
};

/// n-point Gauss–Legendre rule on [a, b], exact for degree 2n−1, to rounding error (Newton on
/// Legendre's recurrence).
QuadratureRule gauss_legendre(std::size_t n, double a = -1, double b = 1);

}  // namespace ciliaval
