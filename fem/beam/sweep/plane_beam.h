// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

#include "fem/beam/system.h"

/// The beam whose tip a rigid surface presses, in the plane of the travel. Without units: lengths
/// in L, forces in P = System::force_scale(), moments in P L, energies in P L. Plane vectors are
/// (x, z), x along the travel; angles turn from z to x.
namespace ciliaval::fem::beam::sweep {

using Eigen::Vector2d;

/// Directors of a section turned by `angle`: its normal d₃, and d₁ in the plane of the section.
inline Vector2d d3(double angle) {
  return {std::sin(angle), std::cos(angle)};
}
inline Vector2d d1(double angle) {
  return {std::cos(angle), -std::sin(angle)};
}

/// Kelvin–Voigt bending over an implicit Euler step: m = (κ + a (κ − κ₀))/(h C_m), a the
/// retardation time over the step. Empty κ₀: elastic.
struct Viscosity {
  double ratio = 0;                ///< a
  Eigen::VectorXd last_curvature;  ///< κ₀ at the Gauss points, rad
};

/// The beam that nothing but a dead tip force F loads, as a function of its nodal angles.
struct Response {
  double energy = 0;             ///< elastic, of bending, shear and extension
  Eigen::VectorXd gradient;      ///< ∂G/∂θ_a: the tip's is the moment on it, the others vanish
  Eigen::MatrixXd hessian;       ///< ∂²G/∂θ_a∂θ_b
  Vector2d tip;                  ///< r_L = −∂G/∂F
  Eigen::Matrix2Xd tip_turning;  ///< ∂r_L/∂θ_a
  Eigen::Matrix2d compliance;    ///< ∂r_L/∂F
};

/// The plane Simo–Reissner beam of a System (its mesh, section and interpolation), where only the
/// tip is loaded. Then the equilibrium in r makes Λn = F at every Gauss point, and the strain
/// equations give dr/dξ = h Λ(e₃ + C_n n) and m = κ/(h C_m). So r, n and m are eliminated exactly,
/// and of the Hellinger–Reissner energy (docs/theory/beam.md) is left
///
///     G(θ, F) = Σ_g w_g [κ²/(2 h C_m) − h F·d₃ − ½ h Σ_i C_ni (F·d_i)²],
///
/// with φ = 2 arg p and κ = dφ/dξ of the interpolated p = Σ N_a exp(iθ_a/2).
class PlaneBeam {
 public:
  /// The system must be straight and of sections that are alike in all directions.
  explicit PlaneBeam(const System& system);

  Eigen::Index n_angles() const { return static_cast<Eigen::Index>(nodes_ - 1); }
  const std::vector<double>& arclengths() const { return arclengths_; }  ///< S/L, of all nodes
  Response respond(const Eigen::VectorXd& angles, const Vector2d& force,
                   const Viscosity& viscosity = {}) const;
  /// κ at the Gauss points, rad per element.
  Eigen::VectorXd curvature(const Eigen::VectorXd& angles) const;
  /// Viscous work of a step, Σ w a (κ − κ₀)²/(h C_m).
  double dissipation(const Eigen::VectorXd& angles, const Viscosity& viscosity) const;
  /// Nodal angles of the slender cantilever under a small horizontal tip force.
  Eigen::VectorXd pulled_aside(double force) const;
  /// The beam's full state in the vertical plane of an azimuth.
  State state(const Eigen::VectorXd& angles, const Vector2d& force, double azimuth) const;

 private:
  struct Element {
    double length;              ///< h/L
    double bending_compliance;  ///< C_m P L²
    double shear_compliance;    ///< C_n1 P
    double axial_compliance;    ///< C_n3 P
  };
  struct GaussPoint;
  GaussPoint gauss_point(const Eigen::VectorXd& angles, std::size_t element, std::size_t g) const;
  double angle(const Eigen::VectorXd& angles, std::size_t node) const {
    return node == 0 ? 0.0 : angles[static_cast<Eigen::Index>(node) - 1];
  }

  const System& system_;
  const ReferenceElement& reference_;
  std::size_t degree_;
  std::size_t nodes_;
  std::vector<Element> elements_;
  std::vector<double> arclengths_;
};

}  // namespace ciliaval::fem::beam::sweep
