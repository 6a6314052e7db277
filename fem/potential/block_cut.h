// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "fem/potential/magnet.h"
#include "problem/lagrange.h"

namespace ciliaval::fem::potential {

/// The planes x_i = origin_i + k·spacing, i = 1, 2, 3, for all integers k.
struct PlaneGrid {
  Vector3 origin = Vector3::Zero();  ///< m
  double spacing = 0;                ///< m
};

/// Quadrature over blocks of the magnet, piece by piece between the planes that cut them, so that a
/// sum over the points on one side of a plane is the integral over that side.
///
/// Position, volume and moment per unit of the block's coordinates (a, b, c) are taken for the
/// polynomials through their values at n³ Gauss points, which have the same integrals over the
/// block. Then a is cut wherever a plane meets one of the four edges along a; for each Gauss point
/// a of the pieces b is cut wherever a plane meets one of the two edges along b of that section;
/// and for each b the line along c is cut by the planes. Between cuts the integrals over what is
/// inside are smooth functions of a and b, polynomials of degrees 2 and 1 if the block is a
/// parallelepiped: two points for each piece do. A plane that meets a face of the block, but none
/// of its edges, is missed.
class BlockCut {
 public:
  static constexpr std::size_t most_points = 6;

  /// For blocks given by n³ points, n ≤ 6, with `points` Gauss points in each direction of a piece.
  BlockCut(std::size_t n, std::size_t points);

  /// Appends the points of the block's pieces; `gauss` as from Magnet::sample.
  void cut(const std::vector<MagnetSample>& gauss, const PlaneGrid& planes,
           std::vector<MagnetSample>& pieces) const;

 private:
  static constexpr Eigen::Index components = 7;  ///< of x, dv and m dv
  static constexpr auto most = static_cast<Eigen::Index>(most_points);
  using Shape = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, most>;
  using Line = Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, most>;
  void cut(const double* values, int depth, double weight, const PlaneGrid& planes,
           std::vector<MagnetSample>& pieces) const;
  std::vector<double> cuts(const double* values, int depth, const PlaneGrid& planes) const;
  void add_crossings(const Line& line, const PlaneGrid& planes, std::vector<double>& cuts) const;
  Shape shape(double t) const;

  LagrangeBasis nodes_;
  std::vector<double> weights_;  ///< of the Gauss rule on the nodes
  QuadratureRule piece_;         ///< on [0, 1]
  Shape lower_;                  ///< values of the basis at 0
  Shape upper_;                  ///< at 1
};

}  // namespace ciliaval::fem::potential
