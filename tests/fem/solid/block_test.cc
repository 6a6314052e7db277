// SPDX-License-Identifier: LGPL-2.1-or-later
// The core on blocks: patch test, homogeneous deformations, manufactured solution, locking.
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "problem/error.h"
#include "tests/fem/solid/cube.h"

namespace ciliaval::fem::solid {
using namespace material;
using namespace discretisation;
using namespace loads;
using namespace equilibrium;
using namespace solvers;
namespace {

std::vector<DirichletCondition> on_all_faces(const std::function<Vector3(const Vector3&)>& u) {
  std::vector<DirichletCondition> conditions;
  for (unsigned int face = 0; face < 6; ++face) conditions.push_back({face, {true, true, true}, u});
  return conditions;
}

// Faces −x, −y, −z slide on their planes; +x is displaced by `displacement` along x.
std::vector<DirichletCondition> stretched_along_x(double displacement) {
  return {{0, {true, false, false}, {}},
          {2, {false, true, false}, {}},
          {4, {false, false, true}, {}},
          {1, {true, false, false}, [=](const Vector3&) { return Vector3(displacement, 0, 0); }}};
}

// Oracle: an affine displacement is the solution, whatever the mesh (patch test), at ν = 0.3 and
// nearly incompressible. Measured 3e-15 and 2e-13.
TEST(SolidBlock, PassesThePatchTestOnADistortedMesh) {
  Matrix3 A;
  A << 0.10, 0.30, -0.10, -0.15, 0.05, 0.20, 0.05, -0.10, -0.12;
  const auto affine = [A](const Vector3& X) -> Vector3 { return A * X; };
  for (const double nu : {0.3, 0.4999}) {
    const Block block(neo_hooke(1, nu), {3, 3, 3}, Vector3::Ones(), 0.25);
    const SolidSpace space(block.triangulation, block.mapping, block.materials);
    const SolidState state =
        find_equilibrium(space, on_all_faces(affine), Vector(space.unknowns()), 1, nullptr, affine);
    EXPECT_LT(nodal_error(space, state, affine), 1e-10) << "nu " << nu;
  }
}

// Oracle: stretch λ with free sides. The lateral stretch μ follows from its scalar equation
// P_yy(diag(λ, μ, μ)) = 0 by bisection of the energy's own derivative, written out here:
//   P_yy = G J^(−2/3) (μ − I₁/(3μ)) + K (J − 1) J/μ,  J = λμ²,  I₁ = λ² + 2μ².
// Measured: stretch 1e-12, force 1e-12.
TEST(SolidBlock, StretchesAsTheClosedForm) {
  const Hyperelastic material = neo_hooke(1, 0.45);
  const double G = material.shear_modulus();
  const double K = material.bulk_modulus;
  const double stretch = 2;
  const auto lateral_stress = [&](double mu) {
    const double J = stretch * mu * mu;
    const double I1 = stretch * stretch + 2 * mu * mu;
    return G * std::pow(J, -2.0 / 3) * (mu - I1 / (3 * mu)) + K * (J - 1) * J / mu;
  };
  double low = 0.5;
  double high = 1;
  for (int i = 0; i < 60; ++i)
    (lateral_stress((low + high) / 2) < 0 ? low : high) = (low + high) / 2;
  const double J = stretch * low * low;
  const double I1 = stretch * stretch + 2 * low * low;
  const double P_xx =
      G * std::pow(J, -2.0 / 3) * (stretch - I1 / (3 * stretch)) + K * (J - 1) * J / stretch;

  const Block block(material, {2, 2, 2}, {1, 1, 1}, 0.2);
  const SolidSpace space(block.triangulation, block.mapping, block.materials);
  NewtonResult last;
  const SolidState state =
      find_equilibrium(space, stretched_along_x(stretch - 1), Vector(space.unknowns()), 2, &last);
  const auto exact = [&](const Vector3& X) -> Vector3 {
    return {(stretch - 1) * X[0], (low - 1) * X[1], (low - 1) * X[2]};
  };
  EXPECT_LT(nodal_error(space, state, exact), 1e-10);
  double force = 0;
  const auto loaded = increment_constraints(space, std::array{stretched_along_x(1).back()});
  for (const auto& line : loaded.get_lines()) force += last.reactions[line.index];
  EXPECT_NEAR(force, P_xx, 1e-9 * P_xx);
}

// Oracle: simple shear is isochoric, so that p = 0 and the reaction along the shear is μγ on the
// unit face, at right angles to it −μγ²/3 (from σ = dev b μ of Ψ_iso, T = P e_y).
TEST(SolidBlock, ShearsAsTheClosedForm) {
  const double shear = 0.7;
  const Hyperelastic material = neo_hooke(1, 0.49);
  const auto simple_shear = [=](const Vector3& X) -> Vector3 { return {shear * X[1], 0, 0}; };
  const Block block(material, {2, 2, 2}, {1, 1, 1}, 0.2);
  const SolidSpace space(block.triangulation, block.mapping, block.materials);
  NewtonResult last;
  const SolidState state =
      find_equilibrium(space, on_all_faces(simple_shear), Vector(space.unknowns()), 8, &last);
  EXPECT_LT(nodal_error(space, state, simple_shear), 1e-11);
  for (const PressureVector& p : state.pressure) EXPECT_LT(p.norm(), 1e-9);
  for (const SolidElement& element : space.elements()) {
    const auto u = nodal_displacements(element, state.displacement);
    const Matrix3 F =
        Matrix3::Identity() + u.transpose() * element.gauss_points().gradients().leftCols<3>();
    const Matrix3 sigma = cauchy_stress(material, F, 0);
    EXPECT_NEAR(sigma(0, 1), material.shear_modulus() * shear, 1e-9);
  }
}

// A smooth displacement and the body force that holds it: b = −Div P(F(X)), the divergence by
// sixth-order differences of the stress of the compressible energy, P with p = K(J − 1).
struct Manufactured {
  Hyperelastic material;
  static Vector3 displacement(const Vector3& X) {
    using std::numbers::pi;
    return 0.1 * Vector3(std::sin(pi * X[1]) * X[0], std::cos(pi * X[2]) * X[1] * X[0],
                         std::sin(pi * X[0] + X[1]));
  }
  static Matrix3 deformation_gradient(const Vector3& X) {
    using std::numbers::pi;
    Matrix3 H;
    H << std::sin(pi * X[1]), pi * std::cos(pi * X[1]) * X[0], 0,  //
        std::cos(pi * X[2]) * X[1], std::cos(pi * X[2]) * X[0],
        -pi * std::sin(pi * X[2]) * X[1] * X[0],  //
        pi * std::cos(pi * X[0] + X[1]), std::cos(pi * X[0] + X[1]), 0;
    return Matrix3::Identity() + 0.1 * H;
  }
  Matrix3 stress(const Vector3& X) const {
    const Matrix3 F = deformation_gradient(X);
    return first_piola_stress(material, F, material.bulk_modulus * (F.determinant() - 1));
  }
  Vector3 body_force(const Vector3& X) const {
    Vector3 divergence = Vector3::Zero();
    const double h = 1e-2;
    for (int J = 0; J < 3; ++J) {
      const Vector3 e = h * Vector3::Unit(J);
      const Matrix3 derivative =
          (45 * (stress(X + e) - stress(X - e)) - 9 * (stress(X + 2 * e) - stress(X - 2 * e)) +
           (stress(X + 3 * e) - stress(X - 3 * e))) /
          (60 * h);
      divergence += derivative.col(J);
    }
    return -divergence;
  }
};

/// L2 norms of the errors of displacement and gradient.
std::array<double, 2> errors(const SolidSpace& space, const SolidState& state) {
  const dealii::QGauss<3> gauss(5);
  dealii::FEValues<3> values(space.mapping(), space.scalar_element(), gauss,
                             dealii::update_values | dealii::update_gradients |
                                 dealii::update_JxW_values | dealii::update_quadrature_points);
  std::array<double, 2> square{};
  for (const SolidElement& element : space.elements()) {
    values.reinit(element.cell);
    const auto u = nodal_displacements(element, state.displacement);
    for (unsigned int q = 0; q < gauss.size(); ++q) {
      const auto point = values.quadrature_point(q);
      const Vector3 X(point[0], point[1], point[2]);
      Vector3 error = -Manufactured::displacement(X);
      Matrix3 gradient = Matrix3::Identity() - Manufactured::deformation_gradient(X);
      for (unsigned int a = 0; a < element_nodes; ++a) {
        const Vector3 u_a = u.row(space.lexicographic()[a]).transpose();
        const auto grad = values.shape_grad(a, q);
        error += values.shape_value(a, q) * u_a;
        gradient += u_a * Vector3(grad[0], grad[1], grad[2]).transpose();
      }
      square[0] += values.JxW(q) * error.squaredNorm();
      square[1] += values.JxW(q) * gradient.squaredNorm();
    }
  }
  return {std::sqrt(square[0]), std::sqrt(square[1])};
}

// Oracle: manufactured solution; Q2 converges with h³ in L2 and h² in H1 from h = 1/3 to 1/6, for
// ν = 0.3. At ν = 0.49 the coarser mesh is not asymptotic yet and the orders are higher, 3.6
// and 2.3.
TEST(SolidBlock, ConvergesToAManufacturedSolutionWithTheOrdersOfQ2) {
  for (const double nu : {0.3, 0.49}) {
    const Manufactured manufactured{neo_hooke(1, nu)};
    std::array<std::array<double, 2>, 2> error{};
    for (unsigned int level = 0; level < 2; ++level) {
      const unsigned int n = level == 0 ? 3 : 6;
      const Block block(manufactured.material, {n, n, n});
      const SolidSpace space(block.triangulation, block.mapping, block.materials);
      const auto forces =
          body_force(space, [&](const Vector3& X) { return manufactured.body_force(X); });
      const SolidState state = find_equilibrium(space, on_all_faces(Manufactured::displacement),
                                                forces, 1, nullptr, Manufactured::displacement);
      error[level] = errors(space, state);
    }
    const double L2 = std::log2(error[0][0] / error[1][0]);
    const double H1 = std::log2(error[0][1] / error[1][1]);
    EXPECT_GT(L2, 2.8) << "nu " << nu;
    EXPECT_GT(H1, 1.85) << "nu " << nu;
    if (nu == 0.3) {
      EXPECT_LT(L2, 3.25);
      EXPECT_LT(H1, 2.2);
    }
  }
}

// Oracle: the convergence theory of Newton's method, ‖Δ_k+1‖ ~ ‖Δ_k‖²: ratio of logarithms of
// successive reductions is 2. Tractions by the reference area on a clamped block.
TEST(SolidBlock, NewtonConvergesQuadratically) {
  const Block block(neo_hooke(1, 0.49), {4, 1, 1}, {4, 1, 1});
  const SolidSpace space(block.triangulation, block.mapping, block.materials);
  NewtonResult last;
  find_equilibrium(
      space, {{0, {true, true, true}, {}}},
      traction(space, 1, [](const Vector3&, const Vector3&) { return Vector3(0, 0, 0.004); }), 1,
      &last);
  const auto& d = last.increments;
  ASSERT_GE(d.size(), 4U);
  const std::size_t n = d.size() - 1;
  const double order = std::log(d[n] / d[n - 1]) / std::log(d[n - 1] / d[n - 2]);
  EXPECT_GT(order, 1.8) << d[n - 2] << " " << d[n - 1] << " " << d[n];
}

// A loose tolerance of the displacement lets nothing pass that is out of balance, however short the
// last tangent's step is: such a step is tried at residuals up to 1e-2. Some of the starts here,
// the solution with its displacement shortened, come by residuals between tolerance and 1e-2 and
// would end there by the length of the step alone.
TEST(SolidBlock, NothingConvergesOutOfBalance) {
  const Block block(neo_hooke(1, 0.499), {4, 1, 1}, {4, 1, 1});
  const SolidSpace space(block.triangulation, block.mapping, block.materials);
  const std::vector<DirichletCondition> clamped{{0, {true, true, true}, {}}};
  const auto forces =
      traction(space, 1, [](const Vector3&, const Vector3&) { return Vector3(0, 0, 0.004); });
  const SolidState exact = find_equilibrium(space, clamped, forces, 1);
  Newton newton(space, increment_constraints(space, clamped), SolverKind::automatic, MPI_COMM_SELF);
  const double tolerance = 1e-3;
  int tried = 0;
  for (int start = 0; start < 15; ++start) {
    const double part = 1e-3 * std::pow(1.5, start);
    SolidState state = exact;
    state.displacement *= 1 - part;
    const NewtonResult result = newton.solve(dead_forces(forces), state, {.tolerance = tolerance});
    ASSERT_TRUE(result.converged) << result.reason;
    EXPECT_LE(result.residuals.back(), tolerance) << part;
    tried += std::any_of(result.residuals.begin() + 2, result.residuals.end(),
                         [&](double r) { return r > tolerance && r < 1e-2; });
    state.displacement -= exact.displacement;
    EXPECT_LT(state.displacement.linfty_norm(), 1e-6 * exact.displacement.linfty_norm()) << part;
  }
  EXPECT_GE(tried, 2);
}

// Oracle: Lamé's hollow sphere under internal pressure, small strain:
//   u_r = p a³/(b³ − a³) [ r (1 − 2ν)/E + (1 + ν) b³/(2E r²) ],
// exact for every ν. An octant with a/b = ½; the inner radius' displacement at 2 × 3 × 4 cells must
// be as good at ν = 0.4999 as at 0.3 (no volumetric locking). A plain Q1 or Q2 displacement element
// at ν = 0.4999 loses most of the displacement here.
TEST(SolidBlock, DoesNotLockInLamesHollowSphere) {
  const double a = 1;
  const double b = 2;
  const double pressure = 1e-4;
  dealii::Triangulation<3> shell;
  dealii::GridGenerator::quarter_hyper_shell(shell, dealii::Point<3>(), a, b, 3, true);
  shell.refine_global(1);
  const dealii::MappingQ<3> mapping(element_degree);
  const std::vector<DirichletCondition> symmetry{
      {2, {true, false, false}, {}}, {3, {false, true, false}, {}}, {4, {false, false, true}, {}}};
  for (const double nu : {0.3, 0.49, 0.4999}) {
    const Hyperelastic material = neo_hooke(1, nu);
    const SolidSpace space(shell, mapping, std::array{material});
    const SolidState state = find_equilibrium(
        space, symmetry,
        traction(space, 0,
                 [&](const Vector3&, const Vector3& N) -> Vector3 { return -pressure * N; }),
        1);
    const auto lame = [&](const Vector3& X) -> Vector3 {
      const double r = X.norm();
      const double u_r = pressure * a * a * a / (b * b * b - a * a * a) *
                         (r * (1 - 2 * nu) + (1 + nu) * b * b * b / (2 * r * r));
      return u_r * X / r;
    };
    EXPECT_LT(nodal_error(space, state, lame) / lame({a, 0, 0}).norm(), 5e-3) << "nu " << nu;
  }
}

TEST(SolidBlock, RejectsAMeshWithoutMaterial) {
  Block block(neo_hooke(1, 0.3), {1, 1, 1});
  block.triangulation.begin_active()->set_material_id(1);
  EXPECT_THROW(SolidSpace(block.triangulation, block.mapping, block.materials), InputError);
}

}  // namespace
}  // namespace ciliaval::fem::solid
