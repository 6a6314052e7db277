// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

namespace ciliaval::analytic::sources {

/// H_ρ/ρ, which has no pole on the axis, and H_ζ of a disc.
struct DiscField {
  double radial_over_rho;
  double axial;
};

/// Field H of a disc of unit radius with unit magnetic surface charge, at the distance ρ ≥ 0 from
/// its axis and the height ζ above its plane (in radii). With s² = ζ² + (1+ρ)²,
/// kc² = [ζ² + (1−ρ)²]/s², γ = (1−ρ)/(1+ρ):
///   H_ρ = 4ρ C(kc)/(π s³),  C of `complete_elliptic`,
///   H_ζ = sign(ζ)·{½ inside ρ < 1, ¼ on ρ = 1, 0 outside} − ζ cel(kc, γ², 1, γ)/(π(1+ρ)s),
/// the two end faces' share in Derby & Olbert, Am. J. Phys. 78, 229 (2010), Eq. 3–4; beyond three
/// radii, where the two terms of H_ζ cancel, the multipole series, a² = ρ² + ζ², u = ζ/a,
///   H_ρ = ½ (ρ/a) Σ_{k≥1} binom(½, k) P'_{2k−1}(u)/a^{2k},
///   H_ζ = ½ Σ_{k≥1} binom(½, k)(2k−1) P_{2k−1}(u)/a^{2k}.
/// Error: a few ε times |H| (below 40 ε just inside three radii). On the disc ζ = +0 and ζ = −0 are
/// the limits from its two sides. Not finite on the rim.
DiscField charged_disc_field(double rho, double zeta);

/// Derivatives of the same H, in which nothing is singular on the axis.
struct DiscGradient {
  double radial_over_rho;  ///< H_ρ/ρ, the derivative across the meridional plane
  double radial;           ///< ∂H_ρ/∂ρ
  double axial;            ///< ∂H_ζ/∂ζ
  double mixed_over_rho;   ///< (∂H_ρ/∂ζ)/ρ = (∂H_ζ/∂ρ)/ρ
};

/// A disc that moves along its axis leaves a layer of dipoles, the field of a current loop:
/// ∂H/∂ζ = −H(loop of unit current); ∇·H = 0 gives ∂H_ρ/∂ρ = −H_ρ/ρ − ∂H_ζ/∂ζ. Not on the disc.
DiscGradient charged_disc_gradient(double rho, double zeta);

}  // namespace ciliaval::analytic::sources
