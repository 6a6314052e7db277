// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <Eigen/Core>

#include "problem/types.h"

namespace ciliaval::fem {

/// Nearly incompressible neo-Hooke solid with the pressure-like unknown p beside the deformation
/// gradient F (perturbed Lagrangian form; Bonet & Wood, Nonlinear Continuum Mechanics for Finite
/// Element Analysis, 2nd ed., Sections 6.5 and 8.6):
///
///   Ψ(F, p) = μ/2 (Ī₁ − 3) + p (J − 1) − p²/(2K),   Ī₁ = J^(−2/3) F:F,   J = det F.
///
/// Eliminating p = K(J − 1) gives back Ψ(F) = μ/2 (Ī₁ − 3) + K/2 (J − 1)². p is positive in
/// tension.
struct NeoHooke {
  double shear_modulus = 0;  ///< μ, Pa
  double bulk_modulus = 0;   ///< K, Pa
};

/// ∂P_iJ/∂F_kL at row 3i + J and column 3k + L, Pa.
using StressTangent = Eigen::Matrix<double, 9, 9>;

/// Ψ(F, p), J/m³ of the reference volume.
double strain_energy(const NeoHooke& material, const Matrix3& F, double p);

/// First Piola–Kirchhoff stress, Pa:
///   P = ∂Ψ/∂F = μ J^(−2/3) (F − I₁/3 F⁻ᵀ) + p J F⁻ᵀ,   I₁ = F:F.
Matrix3 first_piola_stress(const NeoHooke& material, const Matrix3& F, double p);

/// Cauchy stress σ = P Fᵀ / J, Pa.
Matrix3 cauchy_stress(const NeoHooke& material, const Matrix3& F, double p);

/// ∂P/∂F at fixed p:
///   μ J^(−2/3) [ δ_ik δ_JL − 2/3 (F_iJ F⁻¹_Lk + F⁻¹_Ji F_kL) + 2/9 I₁ F⁻¹_Ji F⁻¹_Lk
///                + I₁/3 F⁻¹_Jk F⁻¹_Li ]
///   + p J [ F⁻¹_Ji F⁻¹_Lk − F⁻¹_Jk F⁻¹_Li ].
StressTangent stress_tangent(const NeoHooke& material, const Matrix3& F, double p);

}  // namespace ciliaval::fem
