// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <span>
#include <vector>

#include "fem/beam/section.h"
#include "problem/surroundings/environment.h"
#include "problem/types.h"

namespace ciliaval::fem::beam {

/// Lagrange polynomials of degree p on the p+1 nodes of [0, 1], tabulated at the p Gauss points.
struct ReferenceElement {
  std::vector<double> nodes;    ///< ξ_a, increasing, p+1 of them
  std::vector<double> points;   ///< Gauss points ξ_g, increasing, p of them
  std::vector<double> weights;  ///< w_g
  Eigen::MatrixXd values;       ///< N_a(ξ_g), row g, column a
  Eigen::MatrixXd derivatives;  ///< dN_a/dξ(ξ_g)

  double N(std::size_t g, std::size_t a) const {
    return values(static_cast<Eigen::Index>(g), static_cast<Eigen::Index>(a));
  }
  double D(std::size_t g, std::size_t a) const {
    return derivatives(static_cast<Eigen::Index>(g), static_cast<Eigen::Index>(a));
  }
  std::size_t n_nodes() const { return nodes.size(); }
  std::size_t n_points() const { return points.size(); }
  /// Unknowns of an element: (r, θ) at each node, then (n, m) at each Gauss point.
  Eigen::Index n_unknowns() const {
    return static_cast<Eigen::Index>(6 * (n_nodes() + n_points()));
  }
};

/// A vector for each of d₁ and d₂.
using Matrix32 = Eigen::Matrix<double, 3, 2>;

/// The constants of an element.
struct ElementData {
  double length = 0;  ///< h, reference arc length, m; 0 is allowed
  Section section;
  /// Length by which the compliances are multiplied: h, m; 1 for a joint.
  double compliant_length() const { return section.is_joint ? 1 : length; }
  std::vector<Vector3> gamma0;  ///< hΓ₀ = Λ₀ᵀ dr₀/dξ at the Gauss points, m
  std::vector<Vector3> kappa0;  ///< hK₀ at the Gauss points, rad
  Vector3 force_per_length = Vector3::Zero();  ///< dead load per reference length, N/m
  Vector3 force_per_height = Vector3::Zero();  ///< load per unit of current height z, N/m
  /// c = M A B₀, N: energy −∫ c·∂r/∂S dS by the law F, −∫ c·d₃ dS by the law R.
  Vector3 magnetic_force = Vector3::Zero();
  surroundings::MagneticEnergy magnetic_energy = surroundings::MagneticEnergy::F;
  /// C = A B₀ ⊗ (M₁, M₂), N: energy −∫ (C₁·d₁ + C₂·d₂) dS by both laws.
  Matrix32 transverse_force = Matrix32::Zero();
  /// M A, A·m, and the magnets beside the beam, whose energy by the law R, −∫ M A B(r)·d₃ dS, the
  /// element has; by the law F it is that of poles (System).
  double magnetic_charge = 0;
  /// A (M₁, M₂), A·m: energy −∫ A (M₁ d₁ + M₂ d₂)·B(r) dS in their field by both laws.
  Eigen::Vector2d transverse_charge = Eigen::Vector2d::Zero();
  std::span<const surroundings::magnets::Magnet> magnets{};
};

/// Views of an element's part of the state.
struct ElementState {
  std::span<const Vector3> position;     ///< r_a at the nodes, m
  std::span<const Quaternion> rotation;  ///< q_a at the nodes, neighbours of one sign
  std::span<const Vector3> force;        ///< n at the Gauss points, material components, N
  std::span<const Vector3> moment;       ///< m at the Gauss points, material components, N·m
};

/// Strains hΓ₀ and hK₀ of the reference configuration by the interpolation of the element.
void set_reference_strains(const ReferenceElement& reference, std::span<const Vector3> position,
                           std::span<const Quaternion> rotation, ElementData& data);

/// Hellinger–Reissner energy of the element less the work of its dead load,
///   Π = Σ_g w_g [n·(γ − hΓ₀) + m·(κ − hK₀) − ½h (n·Γ + m·K) − h q·r − c·a],   J,
/// with the section's law Γ(n, m), K(n, m), which a joint has without h,
/// and a = ∂r/∂ξ (law F) or h d₃ (law R), to which B(r) of magnets adds −h M A B·d₃, and M across
/// the axis −h (C₁ + A M₁ B)·d₁ − h (C₂ + A M₂ B)·d₂.
/// force_per_height has no potential and is left out.
double element_energy(const ReferenceElement& reference, const ElementData& data,
                      const ElementState& state);

/// Residual R (the gradient of the energy by (r, θ, n, m), θ the spatial spin, plus the work of
/// force_per_height) in the units N, N·m, m, rad; and its tangent, if one is asked for.
void element_residual(const ReferenceElement& reference, const ElementData& data,
                      const ElementState& state, Eigen::VectorXd& residual,
                      Eigen::MatrixXd* tangent);

/// ∂R/∂h at fixed nodal state for an element that is straight and adapted in the reference
/// configuration (Γ₀ = e₃, K₀ = 0).
Eigen::VectorXd element_length_derivative(const ReferenceElement& reference,
                                          const ElementData& data, const ElementState& state);

}  // namespace ciliaval::fem::beam
