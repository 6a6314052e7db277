// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "fem/solid/discretisation/extruded_quadrature.h"
#include "fem/solid/discretisation/space.h"
#include "fem/solid/discretisation/tangent_matrix.h"
#include "problem/surroundings/magnets/magnet.h"

namespace ciliaval::fem::solid::loads {

/// A horizontal force per reference area and current height: g(z), its derivative, and the interval
/// outside of which and at whose ends it vanishes.
struct HeightDensity {
  std::function<double(double z)> value;       ///< g, Pa/m
  std::function<double(double z)> derivative;  ///< dg/dz
  std::optional<std::array<double, 2>> support;
};

/// (F/A) k(z − h), k(s) = (1 + cos(πs/w))/(2w) for |s| < w.
HeightDensity contact_density(double force, double area, double height, double half_width);

/// q/A everywhere.
HeightDensity flow_density(double force_per_height, double area);

/// A load spread over the solid: b = (per_volume + g(z) F_zz) e per reference volume, and what the
/// environment does to each segment.
struct SpreadLoad {
  std::optional<HeightDensity> per_height;
  double per_volume = 0;  ///< N/m³
  Vector3 direction = Vector3::UnitX();
  std::vector<Vector3> weight{};  ///< of each segment, N/m³; empty: none
  /// M B₀ of each segment, Pa: force per area of its end faces (law F); empty: none.
  std::vector<Vector3> poles{};
  /// Data of the force M B(x) that the magnets add to it: M of each segment, A/m, and the magnets
  /// beside the cilium.
  std::vector<double> magnetization{};
  std::vector<surroundings::magnets::Magnet> magnets{};
  /// M across the axis of each segment, A/m, in B₀ (T) and the magnets; empty: none.
  std::vector<Vector3> transverse_magnetization{};
  Vector3 uniform_field = Vector3::Zero();

  /// Force per area of a segment's end face at x, Pa.
  Vector3 pole(std::size_t segment, const Vector3& x) const;
};

/// Calls add(ζ, f) at quadrature points of the part from ≤ ζ ≤ to of an extrusion line, f the force
/// per reference area (Pa) along e, weight included. `z` holds the line's current heights at
/// ζ = 0, ½, 1, `length` is its reference length.
void integrate_load(const SpreadLoad& load, const Eigen::Vector3d& z, double length, double from,
                    double to, const std::function<void(double zeta, double force)>& add);

/// Calls visit(ζ, weight) at the points of a ten-point Gauss rule on each part of a line inside
/// the support, dζ in the weight. `z` as above.
void integrate_in_support(const Eigen::Vector3d& z, const HeightDensity& density,
                          const std::function<void(double zeta, double weight)>& visit);

/// From the first to the last ζ of the line inside the support; empty if none of it is.
std::optional<std::array<double, 2>> loaded_part(const Eigen::Vector3d& z,
                                                 const HeightDensity& density);

/// Adds the nodal forces of g(z) F_zz e to `forces` and, where `tangent` is not null, minus their
/// derivative:
///   ∂f_a/∂u_z,b = ∫ dA ∫ [g'(z) z_ζ N_b + g(z) ∂N_b/∂ζ] N_a dζ e,
/// unsymmetric: rows x, y, columns z. A ten-point Gauss rule on the part of each line inside the
/// support; its moving ends contribute nothing, because g vanishes there.
void add_height_forces(const discretisation::SolidSpace& space,
                       const discretisation::ExtrudedQuadrature& quadrature,
                       const HeightDensity& density, const Vector3& direction,
                       const discretisation::Vector& displacement, discretisation::Vector& forces,
                       discretisation::TangentMatrix* tangent);

/// Nodal forces of (F/A) e, dead, evenly over the plane Z = S. Throws InputError if the mesh has no
/// plane there.
discretisation::Vector section_force(const discretisation::SolidSpace& space,
                                     const discretisation::ExtrudedQuadrature& quadrature,
                                     double force, double arclength, const Vector3& direction);

}  // namespace ciliaval::fem::solid::loads
