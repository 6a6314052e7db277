// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/sparse_matrix.h>
#include <deal.II/lac/vector.h>

#include <Eigen/Core>
#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "fem/solid/discretisation/space.h"

namespace ciliaval::fem {

/// Fibres of an extruded mesh: the material lines X, Y = const, which run along the cells' third
/// local coordinate ζ. A force per current height is an integral along fibres,
///
///   ∫ g(z) F_zz e dV = ∫ dA ∫ g(z) (∂z/∂ζ) dζ e,   F_zz = ∂z/∂Z,
///
/// so that ∫ g dz over a whole fibre comes out exactly, however the fibre bends.

/// Gauss points of the cross-section of a cell.
inline constexpr int section_points_1d = 4;
inline constexpr int section_points = section_points_1d * section_points_1d;

/// What the fibres need of one cell.
struct FibreCell {
  std::array<double, section_points> area;  ///< |∂(X,Y)/∂(ξ,η)| w_q, m²
  std::array<double, section_points> X;     ///< at the section points, m
  std::array<double, section_points> Y;     ///< at the section points, m
  double bottom = 0;                        ///< Z at ζ = 0, m
  double top = 0;                           ///< Z at ζ = 1, m
};

/// Quadratic Lagrange polynomials on 0, ½, 1: the element's along a fibre.
Eigen::Vector3d quadratic_basis(double zeta);
/// Their derivatives.
Eigen::Vector3d quadratic_derivative(double zeta);

/// Whether the mesh is the whole body or the half Y ≥ 0 of one that its plane Y = 0 mirrors.
enum class Extent { whole, half };

/// The fibres of all cells of an extruded mesh.
class Fibres {
 public:
  /// Throws InputError if a cell's ζ-lines are not parallel to Z to 1e-9 of its size.
  explicit Fibres(const SolidSpace& space, Extent extent = Extent::whole);

  const std::vector<FibreCell>& cells() const { return cells_; }
  Extent extent() const { return extent_; }
  /// A of the body's whole section by the mesh's own quadrature, m².
  double area() const { return area_; }
  double height() const { return height_; }  ///< Z of the uppermost plane, m
  /// N_a(ξ, η) at section point q in the plane of the nodes a = 0…8: row a, column q.
  const Eigen::Matrix<double, 9, section_points>& section_values() const { return values_; }
  /// (ξ, η) of the section points: row q.
  const Eigen::Matrix<double, section_points, 2>& section_coordinates() const { return points_; }

 private:
  std::vector<FibreCell> cells_;
  Eigen::Matrix<double, 9, section_points> values_;
  Eigen::Matrix<double, section_points, 2> points_;
  Extent extent_;
  double area_ = 0;
  double height_ = 0;
};

/// A horizontal force per reference area and current height: g(z), its derivative, and the interval
/// outside which it vanishes (at whose ends g must vanish).
struct HeightDensity {
  std::function<double(double z)> value;       ///< g, Pa/m
  std::function<double(double z)> derivative;  ///< dg/dz
  std::optional<std::array<double, 2>> support;
};

/// (F/A) k(z − h), k(s) = (1 + cos(πs/w))/(2w) for |s| < w.
HeightDensity contact_density(double force, double area, double height, double half_width);

/// q/A everywhere.
HeightDensity flow_density(double force_per_height, double area);

/// A load spread over the solid: b = (per_volume + g(z) F_zz) e per reference volume.
struct SpreadLoad {
  std::optional<HeightDensity> per_height;
  double per_volume = 0;  ///< N/m³
  Vector3 direction = Vector3::UnitX();
};

/// Calls add(ζ, f) at quadrature points of the part from ≤ ζ ≤ to of a fibre, f the force per
/// reference area there (Pa), along e, weight included. `z` holds the current heights of the fibre
/// at ζ = 0, ½, 1, `length` its reference length.
void integrate_load(const SpreadLoad& load, const Eigen::Vector3d& z, double length, double from,
                    double to, const std::function<void(double zeta, double force)>& add);

/// Calls visit(ζ, weight) at the points of a ten-point Gauss rule on each part of a fibre inside
/// the support, dζ in the weight. `z` as above.
void integrate_in_support(const Eigen::Vector3d& z, const HeightDensity& density,
                          const std::function<void(double zeta, double weight)>& visit);

/// From the first to the last ζ of the fibre inside the support; empty if none of it is.
std::optional<std::array<double, 2>> loaded_part(const Eigen::Vector3d& z,
                                                 const HeightDensity& density);

/// Adds the nodal forces of g(z) F_zz e to `forces` and, where `matrix` is not null, minus their
/// derivative:
///   ∂f_a/∂u_z,b = ∫ dA ∫ [g'(z) z_ζ N_b + g(z) ∂N_b/∂ζ] N_a dζ e,
/// unsymmetric: rows x, y, columns z. A ten-point Gauss rule on the part of each fibre inside the
/// support; its moving ends contribute nothing, because g vanishes there.
void add_fibre_forces(const SolidSpace& space, const Fibres& fibres, const HeightDensity& density,
                      const Vector3& direction, const dealii::Vector<double>& displacement,
                      dealii::Vector<double>& forces,
                      const dealii::AffineConstraints<double>& constraints,
                      dealii::SparseMatrix<double>* matrix);

/// Force on the whole body, N, from the resultant on the mesh: on a half the mirror image adds as
/// much, and y cancels.
Vector3 whole_force(const Fibres& fibres, const Vector3& force_on_mesh);

/// Nodal forces of (F/A) e, dead, evenly over the plane Z = S. Throws InputError if the mesh has no
/// plane there.
dealii::Vector<double> section_force(const SolidSpace& space, const Fibres& fibres, double force,
                                     double arclength, const Vector3& direction);

}  // namespace ciliaval::fem
