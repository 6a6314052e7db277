// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/material/hyperelastic.h"

#include <Eigen/LU>
#include <cmath>

namespace ciliaval::fem::solid::material {
namespace {

/// Terms that stress and tangent share.
struct Kinematics {
  double J;
  Matrix3 H;        ///< F⁻ᵀ
  double I1;        ///< tr C
  double j;         ///< J^(−2/3)
  double W1;        ///< ∂W/∂Ī₁, Pa
  double W11;       ///< ∂²W/∂Ī₁², Pa
  Matrix3 C;        ///< FᵀF; not set without C₀₁
  double I2 = 0;    ///< not set without C₀₁
  bool has_second;  ///< whether W depends on Ī₂

  Kinematics(const Hyperelastic& material, const Matrix3& F)
      : J(F.determinant()), I1(F.squaredNorm()), has_second(material.C01 != 0) {
    const double root = std::cbrt(J);
    j = 1 / (root * root);
    H.row(0) = F.row(1).cross(F.row(2)) / J;
    H.row(1) = F.row(2).cross(F.row(0)) / J;
    H.row(2) = F.row(0).cross(F.row(1)) / J;
    const double x = j * I1 - 3;
    W1 = material.C10 + x * (2 * material.C20 + x * 3 * material.C30);
    W11 = 2 * material.C20 + x * 6 * material.C30;
    if (!has_second) return;
    C.noalias() = F.transpose() * F;
    I2 = (I1 * I1 - C.squaredNorm()) / 2;
  }
};

}  // namespace

Hyperelastic Hyperelastic::neo_hooke(double shear_modulus, double bulk_modulus) {
  return {.C10 = shear_modulus / 2, .bulk_modulus = bulk_modulus};
}

Hyperelastic Hyperelastic::mooney_rivlin(double shear_modulus, double bulk_modulus, double ratio) {
  const double C10 = shear_modulus / (2 * (1 + ratio));
  return {.C10 = C10, .C01 = ratio * C10, .bulk_modulus = bulk_modulus};
}

Hyperelastic Hyperelastic::yeoh(double shear_modulus, double bulk_modulus, double ratio_2,
                                double ratio_3) {
  const double C10 = shear_modulus / 2;
  return {.C10 = C10, .C20 = ratio_2 * C10, .C30 = ratio_3 * C10, .bulk_modulus = bulk_modulus};
}

double strain_energy(const Hyperelastic& material, const Matrix3& F, double p) {
  const double J = F.determinant();
  const Matrix3 C = F.transpose() * F;
  const double I1 = C.trace();
  const double I2 = (I1 * I1 - C.squaredNorm()) / 2;
  const double x = std::pow(J, -2.0 / 3) * I1 - 3;
  const double y = std::pow(J, -4.0 / 3) * I2 - 3;
  return x * (material.C10 + x * (material.C20 + x * material.C30)) + material.C01 * y +
         p * (J - 1) - p * p / (2 * material.bulk_modulus);
}

Matrix3 first_piola_stress(const Hyperelastic& material, const Matrix3& F, double p) {
  const Kinematics k(material, F);
  const double first = 2 * k.W1 * k.j;
  if (!k.has_second) return first * F + (p * k.J - first * k.I1 / 3) * k.H;
  const double second = 2 * material.C01 * k.j * k.j;
  return (first + second * k.I1) * F - second * (F * k.C) +
         (p * k.J - first * k.I1 / 3 - second * 2 / 3 * k.I2) * k.H;
}

Matrix3 cauchy_stress(const Hyperelastic& material, const Matrix3& F, double p) {
  return first_piola_stress(material, F, p) * F.transpose() / F.determinant();
}

StressTangent stress_tangent(const Hyperelastic& material, const Matrix3& F, double p) {
  const Kinematics k(material, F);
  const double first = 2 * k.W1 * k.j;
  const double second = 2 * material.C01 * k.j * k.j;
  const double hardening = 4 * k.W11 * k.j * k.j;
  // Coefficients of δ_ik δ_JL, F⊗F, F⊗H + H⊗F, H⊗H and H_iL H_kJ.
  double one = first;
  double FF = hardening;
  double FH = -2.0 / 3 * first - hardening * k.I1 / 3;
  double HH = 2.0 / 9 * first * k.I1 + hardening * k.I1 * k.I1 / 9 + p * k.J;
  double swapped = first * k.I1 / 3 - p * k.J;
  // F⊗V + H⊗U: the terms of F⊗F, F⊗H, H⊗F, H⊗H and H⊗D.
  Matrix3 U;
  Matrix3 D;
  Matrix3 B;
  if (k.has_second) {
    one += second * k.I1;
    FF += 2 * second;
    FH -= 4.0 / 3 * second * k.I1;
    HH += 8.0 / 9 * second * k.I2;
    swapped += 2.0 / 3 * second * k.I2;
    D.noalias() = 4.0 / 3 * second * F * k.C;
    B.noalias() = F * F.transpose();
  }
  const Matrix3 V = FF * F + FH * k.H;
  U = FH * F + HH * k.H;
  if (k.has_second) U += D;

  StressTangent A;
  for (int i = 0; i < 3; ++i) {
    for (int l = i; l < 3; ++l) {
      Matrix3 block = F.row(i).transpose() * V.row(l) + k.H.row(i).transpose() * U.row(l) +
                      swapped * k.H.row(l).transpose() * k.H.row(i);
      if (i == l) block.diagonal().array() += one;
      if (k.has_second) {
        block += D.row(i).transpose() * k.H.row(l) - second * F.row(l).transpose() * F.row(i);
        block.diagonal().array() -= second * B(i, l);
        if (i == l) block -= second * k.C;
      }
      A.block<3, 3>(3 * i, 3 * l) = block;
      if (i != l) A.block<3, 3>(3 * l, 3 * i) = block.transpose();
    }
  }
  return A;
}

}  // namespace ciliaval::fem::solid::material
