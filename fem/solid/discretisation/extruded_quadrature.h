// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "fem/solid/discretisation/space.h"

namespace ciliaval::fem::solid::discretisation {

/// Quadrature of an extruded mesh: Gauss points of the cross-section, and through each of them the
/// extrusion line X, Y = const, which runs along the cell's third local coordinate ζ. A force per
/// current height is an integral along these lines,
///
///   ∫ g(z) F_zz e dV = ∫ dA ∫ g(z) (∂z/∂ζ) dζ e,   F_zz = ∂z/∂Z,
///
/// so that ∫ g dz over a whole line comes out exactly, however the line bends.

/// Gauss points of the cross-section of a cell.
inline constexpr int section_points_1d = 4;
inline constexpr int section_points = section_points_1d * section_points_1d;

/// The cross-section's Gauss points in one cell.
struct ExtrudedCell {
  std::array<double, section_points> area;  ///< |∂(X,Y)/∂(ξ,η)| w_q, m²
  std::array<double, section_points> X;     ///< at the section points, m
  std::array<double, section_points> Y;     ///< at the section points, m
  double bottom = 0;                        ///< Z at ζ = 0, m
  double top = 0;                           ///< Z at ζ = 1, m
};

/// Quadratic Lagrange polynomials on 0, ½, 1 and their derivatives: the element's along a line.
Eigen::Vector3d quadratic_basis(double zeta);
Eigen::Vector3d quadratic_derivative(double zeta);

/// Products of three functions of ξ and three of η, in the order of an element's plane of nodes.
inline Eigen::Matrix<double, 9, 1> plane_product(const Eigen::Vector3d& of_xi,
                                                 const Eigen::Vector3d& of_eta) {
  return (of_xi * of_eta.transpose()).reshaped();
}

/// Extent of the mesh: the whole body, or the half Y ≥ 0 of one that its plane Y = 0 mirrors.
enum class Extent { whole, half };

/// The extruded quadrature of the rank's cells of a mesh.
class ExtrudedQuadrature {
 public:
  /// Collective. Throws InputError if a cell's ζ-lines are not parallel to Z to 1e-9 of its size.
  explicit ExtrudedQuadrature(const SolidSpace& space, Extent extent = Extent::whole);

  const std::vector<ExtrudedCell>& cells() const { return cells_; }  ///< of SolidSpace::elements()
  Extent extent() const { return extent_; }
  /// A of the body's whole section by the mesh's own quadrature, m².
  double area() const { return area_; }
  double height() const { return height_; }  ///< Z of the uppermost plane, m
  /// N_a(ξ, η) at section point q in the plane of the nodes a = 0…8: row a, column q.
  const Eigen::Matrix<double, 9, section_points>& section_values() const { return values_; }

 private:
  std::vector<ExtrudedCell> cells_;
  Eigen::Matrix<double, 9, section_points> values_;
  Extent extent_;
  double area_ = 0;
  double height_ = 0;
};

/// Force on the whole body, N, from the resultant on the mesh: on a half the mirror image adds as
/// much, and y cancels.
Vector3 whole_force(const ExtrudedQuadrature& quadrature, const Vector3& force_on_mesh);

}  // namespace ciliaval::fem::solid::discretisation
