// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

namespace ciliaval::joints {

/// Cowper's shear coefficient of a circle, k = 6(1+ν)/(7+6ν), of mean displacements (G. R. Cowper,
/// The shear coefficient in Timoshenko's beam theory, J. Appl. Mech. 33, 1966, Eq. 34).
constexpr double cowper_shear_coefficient(double nu) {
  return 6 * (1 + nu) / (7 + 6 * nu);
}

/// Shear coefficient by the strain energy in Saint-Venant's flexure of a circle, of displacements
/// weighted by the shear stress: k_e = 6(1+ν)²/(7+14ν+8ν²) (J. D. Renton, Generalized beam theory
/// applied to shear stiffness, Int. J. Solids Structures 27, 1991).
constexpr double energy_shear_coefficient(double nu) {
  return 6 * (1 + nu) * (1 + nu) / (7 + 14 * nu + 8 * nu * nu);
}

}  // namespace ciliaval::joints
