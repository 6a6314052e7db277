// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include "problem/joints/joints.h"
#include "problem/types.h"

namespace ciliaval::fem::beam {

/// Elastic law of a cross-section in compliance form, Γ = C_n n and K = C_m m, in the section's own
/// axes d₁, d₂ (in the section) and d₃ (its normal). A zero entry is a rigid mode.
struct Section {
  Vector3 force_compliance;   ///< C_n = (1/kGA₁, 1/kGA₂, 1/EA), 1/N
  Vector3 moment_compliance;  ///< C_m = (1/EI₁, 1/EI₂, 1/GJ), 1/(N·m²)
  double coupling = 0;        ///< b: Γ += b m × e₃, K += b e₃ × n, 1/(N·m)
  /// The entries are of the jumps across an element of any length, also zero: times m. They may be
  /// negative.
  bool is_joint = false;
  joints::BendingLaw beyond{};  ///< small strains; zero: linear

  /// Γ and K, of a joint the jumps.
  Vector3 force_strain(const Vector3& n, const Vector3& m) const {
    return force_compliance.cwiseProduct(n) +
           Vector3(coupling * m[1], -coupling * m[0],
                   beyond.lengthening * m.head<2>().squaredNorm());
  }
  Vector3 moment_strain(const Vector3& n, const Vector3& m) const {
    const double soft = softening(n, m);
    return moment_compliance.cwiseProduct(m) +
           Vector3(soft * m[0] - coupling * n[1], soft * m[1] + coupling * n[0], 0);
  }
  /// The complementary energy per length, of which they are the gradient, of a joint the whole.
  double complementary_energy(const Vector3& n, const Vector3& m) const;
  /// Second derivatives of the energy by (n, m).
  Eigen::Matrix<double, 6, 6> compliance(const Vector3& n, const Vector3& m) const;

 private:
  /// Additional K over m in bending, beyond the linear compliance.
  double softening(const Vector3& n, const Vector3& m) const {
    const double square = m.head<2>().squaredNorm();
    return 2 * beyond.lengthening * n[2] + beyond.softening * square +
           beyond.further_softening * square * square;
  }
};

/// Stiffnesses of a cross-section; infinity is a rigid mode.
struct SectionStiffness {
  double EA = 0;    ///< extension along d₃, N
  double kGA1 = 0;  ///< shear along d₁, N
  double kGA2 = 0;  ///< shear along d₂, N
  double GJ = 0;    ///< torsion about d₃, N·m²
  double EI1 = 0;   ///< bending about d₁, N·m²
  double EI2 = 0;   ///< bending about d₂, N·m²
};

/// Throws InputError if a stiffness is not positive.
Section section(const SectionStiffness& stiffness);

/// Solid circular section of diameter d (m), Young's modulus E (Pa) and Poisson's ratio ν:
/// EA = Eπd²/4, EI = Eπd⁴/64, GJ = Gπd⁴/32, kGA with Cowper's k, G = E/(2(1+ν)).
SectionStiffness circular_section(double diameter, double young_modulus, double poisson_ratio);

/// Tube of outer and inner diameter, as circular_section() but for Cowper's k of the hollow circle,
/// m = inner/outer: k = 6(1+ν)(1+m²)²/((7+6ν)(1+m²)² + (20+12ν)m²) (Cowper 1966, Eq. 35).
SectionStiffness tube_section(double diameter, double inner_diameter, double young_modulus,
                              double poisson_ratio);

/// Rectangle with the sides a along d₁ and b along d₂: EA = Eab, EI₁ = Eab³/12, EI₂ = Ea³b/12, kGA
/// with Cowper's k = 10(1+ν)/(12+11ν), and with s ≤ l the sides Saint-Venant's
///   GJ = G l s³ [1/3 − (64/π⁵)(s/l) Σ_{n odd} tanh(nπl/2s)/n⁵]
/// (Timoshenko & Goodier, Theory of Elasticity, §109). Anticlastic bending is free: a plate much
/// wider than its thickness is stiffer, up to 1/(1−ν²).
SectionStiffness rectangular_section(double a, double b, double young_modulus,
                                     double poisson_ratio);

/// The jumps of a joint.
Section joint_section(const joints::Joint& joint);

/// The same section without shear and extension: C_n = 0, Kirchhoff's inextensible rod.
Section rigid_in_shear(const Section& section);

}  // namespace ciliaval::fem::beam
