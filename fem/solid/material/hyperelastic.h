// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <Eigen/Core>

#include "problem/types.h"

namespace ciliaval::fem::solid::material {

/// Nearly incompressible hyperelastic solid with the pressure-like unknown p beside the deformation
/// gradient F (perturbed Lagrangian form; Bonet & Wood, Nonlinear Continuum Mechanics for Finite
/// Element Analysis, 2nd ed., Sections 6.5 and 8.6):
///
///   Ψ(F, p) = W(Ī₁, Ī₂) + p (J − 1) − p²/(2K),   J = det F,
///   Ī₁ = J^(−2/3) I₁,  I₁ = tr C,   Ī₂ = J^(−4/3) I₂,  I₂ = ((tr C)² − tr C²)/2,   C = FᵀF,
///   W = C₁₀(Ī₁ − 3) + C₀₁(Ī₂ − 3) + C₂₀(Ī₁ − 3)² + C₃₀(Ī₁ − 3)³.
///
/// Eliminating p = K(J − 1) gives back Ψ(F) = W + K/2 (J − 1)². p is positive in tension. W holds
/// three rubbers (Bergström, Mechanics of Solid Polymers, Sections 5.3.2 to 5.3.5): C₁₀ alone is
/// neo-Hooke's, with C₀₁ Mooney–Rivlin's, with C₂₀ and C₃₀ Yeoh's.
struct Hyperelastic {
  double C10 = 0;           ///< Pa
  double C01 = 0;           ///< Pa
  double C20 = 0;           ///< Pa
  double C30 = 0;           ///< Pa
  double bulk_modulus = 0;  ///< K, Pa

  /// W = μ/2 (Ī₁ − 3).
  static Hyperelastic neo_hooke(double shear_modulus, double bulk_modulus);
  /// C₁₀ + C₀₁ = μ/2 with C₀₁/C₁₀ = `ratio`, which must not be −1.
  static Hyperelastic mooney_rivlin(double shear_modulus, double bulk_modulus, double ratio);
  /// C₁₀ = μ/2 with C₂₀/C₁₀ = `ratio_2`, C₃₀/C₁₀ = `ratio_3`.
  static Hyperelastic yeoh(double shear_modulus, double bulk_modulus, double ratio_2,
                           double ratio_3);

  /// Shear modulus of the undeformed solid, μ = 2 (∂W/∂Ī₁ + ∂W/∂Ī₂), Pa.
  double shear_modulus() const { return 2 * (C10 + C01); }
};

/// True if the shear stress 2 W'(γ²) γ of Yeoh's solid rises with the shear γ, however large: 1 + 6
/// r₂ x + 15 r₃ x² > 0 for all x = γ² ≥ 0, with r₂ = C₂₀/C₁₀, r₃ = C₃₀/C₁₀. For an incompressible
/// W(I₁) this is strong ellipticity (Zee & Sternberg, Arch. Rational Mech. Anal. 83, 53, 1983):
/// beyond, the solution would localise in bands and depend on the mesh.
constexpr bool yeoh_is_stable(double ratio_2, double ratio_3) {
  return ratio_3 >= 0 && (ratio_2 >= 0 || 3 * ratio_2 * ratio_2 < 5 * ratio_3);
}

/// ∂P_iJ/∂F_kL at row 3i + J and column 3k + L, Pa. Symmetric.
using StressTangent = Eigen::Matrix<double, 9, 9>;

/// Ψ(F, p), J/m³ of the reference volume.
double strain_energy(const Hyperelastic& material, const Matrix3& F, double p);

/// First Piola–Kirchhoff stress P = ∂Ψ/∂F, Pa, with W₁ = ∂W/∂Ī₁:
///   P = 2 W₁ J^(−2/3) (F − I₁/3 F⁻ᵀ) + 2 C₀₁ J^(−4/3) (I₁F − FC − 2/3 I₂ F⁻ᵀ) + p J F⁻ᵀ.
Matrix3 first_piola_stress(const Hyperelastic& material, const Matrix3& F, double p);

/// Cauchy stress σ = P Fᵀ / J, Pa.
Matrix3 cauchy_stress(const Hyperelastic& material, const Matrix3& F, double p);

/// ∂P/∂F at fixed p. With H = F⁻ᵀ, D = FC, B = FFᵀ, W₁₁ = ∂²W/∂Ī₁², (A ⊗ B)_iJkL = A_iJ B_kL:
///   2 W₁ J^(−2/3) [ δ_ik δ_JL − 2/3 (F⊗H + H⊗F) + 2/9 I₁ H⊗H + I₁/3 H_iL H_kJ ]
///   + 4 W₁₁ J^(−4/3) (F − I₁/3 H) ⊗ (F − I₁/3 H)
///   + 2 C₀₁ J^(−4/3) [ I₁ δ_ik δ_JL + 2 F⊗F − δ_ik C_JL − F_iL F_kJ − B_ik δ_JL
///                      − 4/3 ((I₁F − D)⊗H + H⊗(I₁F − D)) + 8/9 I₂ H⊗H + 2/3 I₂ H_iL H_kJ ]
///   + p J [ H⊗H − H_iL H_kJ ].
StressTangent stress_tangent(const Hyperelastic& material, const Matrix3& F, double p);

}  // namespace ciliaval::fem::solid::material
