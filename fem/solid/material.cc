// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/material.h"

#include <Eigen/LU>
#include <cmath>

namespace ciliaval::fem {

double strain_energy(const NeoHooke& material, const Matrix3& F, double p) {
  const double J = F.determinant();
  const double I1_iso = std::pow(J, -2.0 / 3) * F.squaredNorm();
  return material.shear_modulus / 2 * (I1_iso - 3) + p * (J - 1) -
         p * p / (2 * material.bulk_modulus);
}

Matrix3 first_piola_stress(const NeoHooke& material, const Matrix3& F, double p) {
  const double J = F.determinant();
  const Matrix3 F_inverse_T = F.inverse().transpose();
  const double mu = material.shear_modulus * std::pow(J, -2.0 / 3);
  return mu * (F - F.squaredNorm() / 3 * F_inverse_T) + p * J * F_inverse_T;
}

Matrix3 cauchy_stress(const NeoHooke& material, const Matrix3& F, double p) {
  return first_piola_stress(material, F, p) * F.transpose() / F.determinant();
}

StressTangent stress_tangent(const NeoHooke& material, const Matrix3& F, double p) {
  const double J = F.determinant();
  const Matrix3 G = F.inverse();
  const double I1 = F.squaredNorm();
  const double mu = material.shear_modulus * std::pow(J, -2.0 / 3);
  const double pJ = p * J;
  StressTangent A;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      for (int k = 0; k < 3; ++k) {
        for (int l = 0; l < 3; ++l) {
          const double identity = i == k && j == l ? 1.0 : 0.0;
          A(3 * i + j, 3 * k + l) =
              mu * (identity - 2.0 / 3 * (F(i, j) * G(l, k) + G(j, i) * F(k, l)) +
                    2.0 / 9 * I1 * G(j, i) * G(l, k) + I1 / 3 * G(j, k) * G(l, i)) +
              pJ * (G(j, i) * G(l, k) - G(j, k) * G(l, i));
        }
      }
    }
  }
  return A;
}

}  // namespace ciliaval::fem
