// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/material/hyperelastic.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>
#include <random>
#include <string>

namespace ciliaval::fem::solid {
using namespace material;
namespace {

constexpr double mu = 1.0;
constexpr double K = 50.0;

struct Rubber {
  std::string name;
  Hyperelastic material;
};

/// Every term of W stands in one of them, the last has them all.
const Rubber rubbers[]{
    {"NeoHooke", Hyperelastic::neo_hooke(mu, K)},
    {"MooneyRivlin", Hyperelastic::mooney_rivlin(mu, K, 0.25)},
    {"Yeoh", Hyperelastic::yeoh(mu, K, -0.1, 0.01)},
    {"AllTerms", {.C10 = 0.3, .C01 = 0.2, .C20 = 0.1, .C30 = 0.05, .bulk_modulus = K}}};

class Material : public testing::TestWithParam<Rubber> {
 protected:
  const Hyperelastic& material = GetParam().material;
  /// ∂W/∂Ī₁ and ∂W/∂Ī₂ where Ī₁ − 3 = x, written down again.
  double W1(double x) const {
    return material.C10 + 2 * material.C20 * x + 3 * material.C30 * x * x;
  }
  double W2() const { return material.C01; }
};

Matrix3 random_deformation(unsigned int seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> entry(-0.4, 0.4);
  Matrix3 F = Matrix3::Identity();
  for (int i = 0; i < 9; ++i) F(i) += entry(generator);
  return F.determinant() > 0.3 ? F : random_deformation(seed + 100);
}

/// df/ds at s = 0 by sixth-order central differences.
template <typename Function>
auto derivative(const Function& f) {
  const double h = 2e-3;
  using Value = std::decay_t<decltype(f(h))>;
  return Value((45 * (f(h) - f(-h)) - 9 * (f(2 * h) - f(-2 * h)) + (f(3 * h) - f(-3 * h))) /
               (60 * h));
}

// Oracle: W by the principal stretches λ̄ = J^(−1/3) λ, Ī₁ = Σ λ̄², Ī₂ = Σ λ̄⁻² (as Π λ̄ = 1).
// Measured 3e-15.
TEST_P(Material, EnergyIsThatOfThePrincipalStretches) {
  for (unsigned int seed = 0; seed < 10; ++seed) {
    const Matrix3 F = random_deformation(seed);
    const double J = F.determinant();
    const Eigen::SelfAdjointEigenSolver<Matrix3> solver(F.transpose() * F);
    const Eigen::Array3d squares = solver.eigenvalues().array() / std::cbrt(J * J);  // λ̄²
    const double x = squares.sum() - 3;
    const double y = squares.inverse().sum() - 3;
    const double W = material.C10 * x + material.C01 * y + material.C20 * std::pow(x, 2) +
                     material.C30 * std::pow(x, 3);
    const double p = 0.7;
    EXPECT_NEAR(strain_energy(material, F, p), W + p * (J - 1) - p * p / (2 * K), 3e-14 * (1 + W));
  }
}

// Oracle: differences of the energy. Measured 5e-13 of the stress.
TEST_P(Material, StressIsTheDerivativeOfTheEnergy) {
  for (unsigned int seed = 0; seed < 10; ++seed) {
    const Matrix3 F = random_deformation(seed);
    const double p = 0.7;
    const Matrix3 P = first_piola_stress(material, F, p);
    for (int i = 0; i < 9; ++i) {
      const auto energy = [&](double step) {
        Matrix3 moved = F;
        moved(i) += step;
        return strain_energy(material, moved, p);
      };
      EXPECT_NEAR(P(i), derivative(energy), 1e-11 * P.norm());
    }
  }
}

// Oracle: differences of the stress; a tangent of an energy is symmetric. Measured 1e-12 and
// 1e-16 of the tangent.
TEST_P(Material, TangentIsTheDerivativeOfTheStress) {
  for (unsigned int seed = 0; seed < 10; ++seed) {
    const Matrix3 F = random_deformation(seed);
    const double p = -0.4;
    const StressTangent A = stress_tangent(material, F, p);
    EXPECT_LT((A - A.transpose()).norm(), 2e-15 * A.norm());
    for (int k = 0; k < 3; ++k) {
      for (int l = 0; l < 3; ++l) {
        const auto stress = [&](double step) -> Matrix3 {
          Matrix3 moved = F;
          moved(k, l) += step;
          return first_piola_stress(material, moved, p);
        };
        const Matrix3 expected = derivative(stress);
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j)
            EXPECT_NEAR(A(3 * i + j, 3 * k + l), expected(i, j), 1e-11 * A.norm());
      }
    }
  }
}

// Oracle: objectivity, Ψ(QF) = Ψ(F) and σ(QF) = Q σ Qᵀ; isotropy, σ(FQ) = σ(F); σ is symmetric.
// Measured 2e-15 of the stress.
TEST_P(Material, IsObjectiveAndIsotropic) {
  const Matrix3 F = random_deformation(3);
  const double p = 0.2;
  const Matrix3 Q = Quaternion(0.3, 0.5, -0.7, 0.2).normalized().toRotationMatrix();
  const double energy = strain_energy(material, F, p);
  EXPECT_NEAR(strain_energy(material, Q * F, p), energy, 1e-14);
  EXPECT_NEAR(strain_energy(material, F * Q, p), energy, 1e-14);
  const Matrix3 sigma = cauchy_stress(material, F, p);
  const double tolerance = 2e-14 * sigma.norm();
  EXPECT_LT((sigma - sigma.transpose()).norm(), tolerance);
  EXPECT_LT((cauchy_stress(material, Q * F, p) - Q * sigma * Q.transpose()).norm(), tolerance);
  EXPECT_LT((cauchy_stress(material, F * Q, p) - sigma).norm(), tolerance);
}

// Oracle: Hooke's law, σ = λ tr ε 1 + 2μ ε with λ = K − 2μ/3, at strains of 1e-6 (error of the
// order of the strain; measured 3e-7).
TEST_P(Material, IsHookesLawForSmallStrain) {
  Matrix3 strain;
  strain << 1, 0.5, -0.3, 0.5, -0.4, 0.2, -0.3, 0.2, 0.7;
  strain *= 1e-6;
  const Matrix3 F = Matrix3::Identity() + strain;
  const double p = K * (F.determinant() - 1);
  const double lambda = K - 2.0 / 3 * mu;
  const Matrix3 hooke = lambda * strain.trace() * Matrix3::Identity() + 2 * mu * strain;
  EXPECT_NEAR(material.shear_modulus(), mu, 1e-15);
  EXPECT_NEAR((cauchy_stress(material, F, p) - hooke).norm() / hooke.norm(), 0, 3e-6);
}

// Oracle: uniaxial stretch λ of an incompressible solid (Rivlin 1948), p from free sides:
//   σ = 2 (λ² − 1/λ)(W₁ + W₂/λ). Measured 2e-15.
TEST_P(Material, StretchesUniaxiallyAsRivlinsSolution) {
  for (const double stretch : {0.5, 0.8, 1.3, 2.0, 3.0}) {
    const Matrix3 F = Vector3(stretch, 1 / std::sqrt(stretch), 1 / std::sqrt(stretch)).asDiagonal();
    const double p = -cauchy_stress(material, F, 0)(1, 1);
    const Matrix3 sigma = cauchy_stress(material, F, p);
    const double x = stretch * stretch + 2 / stretch - 3;
    const double expected = 2 * (stretch * stretch - 1 / stretch) * (W1(x) + W2() / stretch);
    EXPECT_NEAR(sigma(0, 0), expected, 2e-14 * std::abs(expected)) << stretch;
    EXPECT_NEAR(sigma(2, 2), 0, 2e-14 * std::abs(expected)) << stretch;
  }
}

// Oracle: equibiaxial stretch, p from the free face: σ = 2 (λ² − 1/λ⁴)(W₁ + λ² W₂).
// Measured 6e-16.
TEST_P(Material, StretchesEquibiaxiallyAsRivlinsSolution) {
  for (const double stretch : {0.6, 0.9, 1.2, 1.8}) {
    const Matrix3 F = Vector3(stretch, stretch, 1 / (stretch * stretch)).asDiagonal();
    const double p = -cauchy_stress(material, F, 0)(2, 2);
    const Matrix3 sigma = cauchy_stress(material, F, p);
    const double x = 2 * stretch * stretch + std::pow(stretch, -4) - 3;
    const double expected =
        2 * (stretch * stretch - std::pow(stretch, -4)) * (W1(x) + stretch * stretch * W2());
    EXPECT_NEAR(sigma(0, 0), expected, 2e-14 * std::abs(expected)) << stretch;
    EXPECT_NEAR(sigma(1, 1), expected, 2e-14 * std::abs(expected)) << stretch;
  }
}

// Oracle: simple shear γ: σ_xy = 2 (W₁ + W₂) γ, σ_xx − σ_yy = γ σ_xy (Rivlin's universal relation),
// σ_xx − σ_zz = 2 W₁ γ², σ_yy − σ_zz = −2 W₂ γ², where Ī₁ − 3 = γ². Measured 2e-16.
TEST_P(Material, ShearsAsRivlinsSolution) {
  for (const double shear : {0.1, 0.8, 2.0}) {
    Matrix3 F = Matrix3::Identity();
    F(0, 1) = shear;
    const Matrix3 sigma = cauchy_stress(material, F, 0);
    const double first = W1(shear * shear);
    const double tolerance = 3e-15 * sigma.norm();
    EXPECT_NEAR(sigma(0, 1), 2 * (first + W2()) * shear, tolerance);
    EXPECT_NEAR(sigma(0, 0) - sigma(1, 1), sigma(0, 1) * shear, tolerance);
    EXPECT_NEAR(sigma(0, 0) - sigma(2, 2), 2 * first * shear * shear, tolerance);
    EXPECT_NEAR(sigma(1, 1) - sigma(2, 2), -2 * W2() * shear * shear, tolerance);
  }
}

INSTANTIATE_TEST_SUITE_P(Solid, Material, testing::ValuesIn(rubbers),
                         [](const auto& rubber) { return rubber.param.name; });

/// True if P_xy, the derivative of W by the shear, falls anywhere up to a shear of 30.
bool shear_stress_falls(const Hyperelastic& material) {
  double last = 0;
  double shear = 0.01;
  for (; shear < 30; shear *= 1.002) {
    Matrix3 F = Matrix3::Identity();
    F(0, 1) = shear;
    const double stress = first_piola_stress(material, F, 0)(0, 1);
    if (stress < last) return true;
    last = stress;
  }
  return false;
}

// Oracle: the shear stress itself, followed up to a shear of 30, for ratios 1 % on both sides of
// the bound C₂₀² = 5/3 C₁₀ C₃₀.
TEST(Yeoh, IsStableAsLongAsTheShearStressRises) {
  for (const double ratio_2 : {-1.0, -0.1, -0.01}) {
    const double bound = 0.6 * ratio_2 * ratio_2;
    for (const double factor : {0.99, 1.01}) {
      const double ratio_3 = factor * bound;
      const bool stable = yeoh_is_stable(ratio_2, ratio_3);
      EXPECT_EQ(stable, factor > 1);
      EXPECT_EQ(shear_stress_falls(Hyperelastic::yeoh(mu, K, ratio_2, ratio_3)), !stable)
          << ratio_2 << ' ' << ratio_3;
    }
  }
  EXPECT_TRUE(yeoh_is_stable(0, 0));  // neo-Hooke
  EXPECT_TRUE(yeoh_is_stable(0.3, 0));
  EXPECT_FALSE(yeoh_is_stable(0.3, -1e-3));
  EXPECT_TRUE(shear_stress_falls(Hyperelastic::yeoh(mu, K, 0.3, -1e-3)));
}

}  // namespace
}  // namespace ciliaval::fem::solid
