// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <Eigen/Dense>
#include <array>
#include <functional>
#include <span>
#include <vector>

#include "fem/potential/magnet.h"
#include "problem/types.h"

namespace ciliaval::fem::potential::plates {

/// A rectangle across the axis `normal` with the charge densities 1, ξ and η, where ξ and η run
/// from −½ to ½ along the next two axes.
struct ChargedRectangle {
  static constexpr int functions = 3;

  int normal = 2;                   ///< its coordinate that is constant
  Vector3 lower = Vector3::Zero();  ///< m
  Vector3 upper = Vector3::Zero();  ///< m; upper[normal] = lower[normal]

  double area() const;
  /// H of each density of 1 A/m, over A/m, by columns; in the rectangle's plane without its normal
  /// part.
  Matrix3 field(const Vector3& x) const;
  /// Potential ψ of the density 1, H = −∇ψ, m.
  double potential(const Vector3& x) const;
  /// Calls visit(x, w, φ) at the points of the product of two n-point Gauss rules: Σ w = 1, φ the
  /// densities there.
  void for_each_point(std::size_t n,
                      const std::function<void(const Vector3& x, double weight,
                                               const Vector3& densities)>& visit) const;
};

/// Permeable boxes in a given field H₀, by the charges σ of their faces:
///
///   σ = 2λ n·(H₀ + H_σ),   λ = (μ₋ − μ₊)/(μ₋ + μ₊),   n from − to +,
///
/// H_σ the mean of both sides. Galerkin's method with σ linear on rectangles that are finer towards
/// edges and points. No body as a whole has a charge: the discrete flux of each charge through its
/// closed surface is made exact, since a defect would be amplified by μ_r
/// (docs/theory/potential.md).
class Charges {
 public:
  /// `step`: size of a rectangle over its distance from the next edge or point. The boxes must not
  /// overlap, but may touch. Throws SolverError if this takes more than `most_rectangles`.
  Charges(std::vector<PermeableBox> boxes, std::span<const Vector3> points, double step);

  static constexpr std::size_t most_rectangles = 3000;

  const std::vector<ChargedRectangle>& rectangles() const { return rectangles_; }
  /// Coefficients of the densities of each rectangle, A/m, in the field H₀(x), A/m.
  Eigen::VectorXd charges(const std::function<Vector3(const Vector3& x)>& H0) const;
  /// H_σ outside of the faces, A/m.
  Vector3 field(const Eigen::VectorXd& charges, const Vector3& x) const;
  /// Its potential from the rectangles' mean densities, A.
  double potential(const Eigen::VectorXd& charges, const Vector3& x) const;

 private:
  void add_face(std::size_t box, int normal, bool upper, std::span<const Vector3> points,
                double step);
  Eigen::VectorXd flux(const Eigen::VectorXd& normal_field) const;
  void balance_flux(const Eigen::VectorXd& wanted, Eigen::Ref<Eigen::VectorXd> normal_field) const;

  std::vector<PermeableBox> boxes_;
  std::vector<int> bodies_;  ///< of each box: boxes of one μ_r that share a face are one body
  std::vector<ChargedRectangle> rectangles_;
  std::vector<double> lambda_;             ///< of each rectangle, n along its axis
  std::vector<std::array<int, 2>> sides_;  ///< bodies on its lower and upper side; −1: air
  /// Areas that each pair of bodies shares, negative, and on the diagonal the whole surfaces, m².
  Eigen::LDLT<Eigen::MatrixXd> surfaces_;
  Eigen::PartialPivLU<Eigen::MatrixXd> factors_;
};

}  // namespace ciliaval::fem::potential::plates
