// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/material.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <Eigen/SVD>
#include <random>

namespace ciliaval::fem {
namespace {

const NeoHooke rubber{1.0, 50.0};

Matrix3 random_deformation(unsigned int seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> entry(-0.4, 0.4);
  Matrix3 F = Matrix3::Identity();
  for (int i = 0; i < 9; ++i) F(i) += entry(generator);
  return F.determinant() > 0.1 ? F : Matrix3(Matrix3::Identity());
}

// Oracle: fourth-order central differences of the energy, step 1e-3 (error about 1e-11).
TEST(NeoHooke, StressIsTheDerivativeOfTheEnergy) {
  for (unsigned int seed = 0; seed < 10; ++seed) {
    const Matrix3 F = random_deformation(seed);
    const double p = 0.7;
    const Matrix3 P = first_piola_stress(rubber, F, p);
    for (int i = 0; i < 9; ++i) {
      const auto energy = [&](double step) {
        Matrix3 moved = F;
        moved(i) += step;
        return strain_energy(rubber, moved, p);
      };
      const double h = 1e-3;
      const double derivative =
          (8 * (energy(h) - energy(-h)) - (energy(2 * h) - energy(-2 * h))) / (12 * h);
      EXPECT_NEAR(P(i), derivative, 1e-9);
    }
  }
}

// Oracle: fourth-order central differences of the stress.
TEST(NeoHooke, TangentIsTheDerivativeOfTheStress) {
  for (unsigned int seed = 0; seed < 10; ++seed) {
    const Matrix3 F = random_deformation(seed);
    const double p = -0.4;
    const StressTangent A = stress_tangent(rubber, F, p);
    EXPECT_NEAR((A - A.transpose()).norm(), 0, 1e-12);
    for (int k = 0; k < 3; ++k) {
      for (int l = 0; l < 3; ++l) {
        const auto stress = [&](double step) {
          Matrix3 moved = F;
          moved(k, l) += step;
          return first_piola_stress(rubber, moved, p);
        };
        const double h = 1e-3;
        const Matrix3 derivative =
            (8 * (stress(h) - stress(-h)) - (stress(2 * h) - stress(-2 * h))) / (12 * h);
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j) EXPECT_NEAR(A(3 * i + j, 3 * k + l), derivative(i, j), 1e-8);
      }
    }
  }
}

// Oracle: objectivity, Ψ(QF) = Ψ(F) and σ(QF) = Q σ Qᵀ; σ is symmetric.
TEST(NeoHooke, IsObjective) {
  const Matrix3 F = random_deformation(3);
  const Matrix3 Q = Quaternion(0.3, 0.5, -0.7, 0.2).normalized().toRotationMatrix();
  EXPECT_NEAR(strain_energy(rubber, Q * F, 0.2), strain_energy(rubber, F, 0.2), 1e-14);
  const Matrix3 sigma = cauchy_stress(rubber, F, 0.2);
  EXPECT_NEAR((sigma - sigma.transpose()).norm(), 0, 1e-14);
  EXPECT_NEAR((cauchy_stress(rubber, Q * F, 0.2) - Q * sigma * Q.transpose()).norm(), 0, 1e-14);
}

// Oracle: Hooke's law, σ = λ tr ε 1 + 2μ ε with λ = K − 2μ/3, at strains of 1e-6 (error of the
// order of the strain).
TEST(NeoHooke, IsHookesLawForSmallStrain) {
  Matrix3 strain;
  strain << 1, 0.5, -0.3, 0.5, -0.4, 0.2, -0.3, 0.2, 0.7;
  strain *= 1e-6;
  const Matrix3 F = Matrix3::Identity() + strain;
  const double p = rubber.bulk_modulus * (F.determinant() - 1);
  const double lambda = rubber.bulk_modulus - 2.0 / 3 * rubber.shear_modulus;
  const Matrix3 hooke =
      lambda * strain.trace() * Matrix3::Identity() + 2 * rubber.shear_modulus * strain;
  EXPECT_NEAR((cauchy_stress(rubber, F, p) - hooke).norm() / hooke.norm(), 0, 1e-5);
}

// Oracle: in simple shear γ of an incompressible-by-kinematics neo-Hooke solid, σ_xy = μγ and
// σ_xx − σ_yy = μγ² (Rivlin's universal relation).
TEST(NeoHooke, SatisfiesRivlinsRelationInSimpleShear) {
  const double shear = 0.8;
  Matrix3 F = Matrix3::Identity();
  F(0, 1) = shear;
  const Matrix3 sigma = cauchy_stress(rubber, F, 0);
  EXPECT_NEAR(sigma(0, 1), rubber.shear_modulus * shear, 1e-14);
  EXPECT_NEAR(sigma(0, 0) - sigma(1, 1), rubber.shear_modulus * shear * shear, 1e-14);
}

}  // namespace
}  // namespace ciliaval::fem
