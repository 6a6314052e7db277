// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <map>

#include "fem/potential/magnet.h"
#include "fem/potential/octree.h"
#include "fem/potential/space.h"

namespace ciliaval::fem::potential {

/// Density of the samples of the magnet.
struct Sampling {
  std::size_t block_points = 4;  ///< points of a block in each direction, by which it is known
  std::size_t piece_points = 2;  ///< Gauss points of its pieces between the faces of leaves
};

/// The bodies' integrals over the leaves of an octree,
///
///     ∫ m·∇φ_i dv   and   ∫ (μ_r − 1) ∇φ_i·∇φ_j dv
///
/// as sums over the bodies' own quadrature points x_q. The integrands are polynomials in each leaf,
/// so that a Gauss rule with the weights Σ_q w_q L_g(x_q), L_g its Lagrange polynomials, gives the
/// same sums to rounding error, at a cost that does not depend on the number of points.
class CutCells {
 public:
  /// For elements of a degree up to `max_degree`.
  CutCells(const Octree& octree, unsigned int max_degree);

  /// Every sample of the magnet, m and μ_r − 1. Collective. Throws InputError if a sample lies
  /// outside of the octree.
  void add(const Magnet& magnet, double relative_permeability, const Sampling& sampling = {});

  /// ∫ m·∇φ_i of a leaf, A·m; empty if there is none.
  Eigen::VectorXd source(int cell, const LagrangeBasis& basis) const;
  /// ∫ (μ_r − 1) ∇φ_i·∇φ_j of a leaf, m; empty if there is none.
  Eigen::MatrixXd stiffness(int cell, const LagrangeBasis& basis) const;
  /// Means over a leaf of m = B_r/μ₀ (A/m) and of μ_r.
  Vector3 mean_magnetization(int cell) const;
  double mean_permeability(int cell) const;
  /// This rank's leaves that any body meets.
  std::vector<int> cells() const;
  bool has_permeability(int cell) const;
  /// χ² f (1 − f) of a leaf: f is the part of it that a permeable body fills and χ = |μ_r − 1| over
  /// the larger of μ_r and 1. Measures how far ∇ψ jumps inside of the leaf.
  double interface_indicator(int cell) const;

  /// Calls the function with x (m), (μ_r − 1) dv (m³) and ∇ψ (A/m) at each Gauss point of each own
  /// leaf with a permeability.
  void for_each_permeable_point(
      const PotentialSpace& space, const PotentialVector& complete,
      const std::function<void(const Vector3&, double, const Vector3&)>& act) const;

  std::size_t samples() const { return samples_; }  ///< of this rank

 private:
  struct Moments {
    Eigen::VectorXd permeability;                     ///< weights on permeability_rule_³
    double susceptibility = 0;                        ///< μ_r − 1 of the body
    Eigen::Matrix<double, 3, Eigen::Dynamic> source;  ///< moments on source_rule_³
  };
  void add_permeability(int cell, const Vector3& unit, double susceptibility, double volume);
  void add_source(int cell, const Vector3& unit, const Vector3& moment);

  const Octree& octree_;
  LagrangeBasis permeability_rule_;
  LagrangeBasis source_rule_;
  std::map<int, Moments> moments_;
  std::size_t samples_ = 0;
};

}  // namespace ciliaval::fem::potential
