// SPDX-License-Identifier: LGPL-2.1-or-later
// The solid beside given magnets. Oracles: differences, the force on the charged faces of the body
// by analytic/forces, and the beam; none shares code with the solid.
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "analytic/forces/wrench.h"
#include "fem/beam/beam.h"
#include "fem/solid/loads/environment_forces.h"
#include "fem/solid/solid.h"
#include "problem/error.h"
#include "tests/analytic/oracles/bent_rods.h"
#include "tests/fem/solid/cilia.h"

namespace ciliaval::fem::solid {
namespace {

using discretisation::Vector;
using loads::magnet_in_field;
using loads::MagnetInField;
using oracle::record;
using surroundings::Environment;
using surroundings::MagneticEnergy;
using surroundings::magnets::jet;
using surroundings::magnets::Magnet;
using surroundings::magnets::Shape;

Magnet cuboid(const Vector3& position) {
  return {"cuboid",
          Shape::cuboid,
          position,
          Quaternion(Eigen::AngleAxisd(0.4, Vector3(1, 2, 0.5).normalized())),
          0,
          0,
          {6e-3, 4e-3, 5e-3},
          {6e5, 0, -6e5}};
}

// Oracle: central differences in F and x, in units of the magnet's size. Measured 1e-8 of
// second order; margin 10.
TEST(SolidMagnets, DerivativesOfTheWorkInAField) {
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  Matrix3 F = Matrix3::Identity();
  for (double& f : F.reshaped()) f += 0.3 * uniform(generator);
  const Vector3 M(0.3, -0.5, 1.2);
  Magnet magnet = cuboid({5, 3, 2});
  magnet.edges = {2, 3, 2};
  const Vector3 x(0.2, -0.3, 1);
  for (const MagneticEnergy law : laws) {
    const auto at = [&](const Matrix3& f, const Vector3& y) {
      return magnet_in_field(f, M, jet(magnet, y), law);
    };
    const MagnetInField value = at(F, x);
    const double h = 1e-4;
    double error = 0;
    for (Eigen::Index k = 0; k < 9; ++k) {
      Matrix3 dF = Matrix3::Zero();
      dF.reshaped()[k] = h;
      const MagnetInField plus = at(F + dF, x);
      const MagnetInField minus = at(F - dF, x);
      error =
          std::max(error, std::abs((plus.work - minus.work) / (2 * h) - value.by_F.reshaped()[k]));
      error =
          std::max(error, ((plus.by_F - minus.by_F).reshaped() / (2 * h) - value.FF.col(k)).norm());
      for (Eigen::Index j = 0; j < 3; ++j)
        error = std::max(error, std::abs((plus.by_x - minus.by_x)[j] / (2 * h) -
                                         value.Fx[static_cast<std::size_t>(j)].reshaped()[k]));
    }
    for (Eigen::Index k = 0; k < 3; ++k) {
      const MagnetInField plus = at(F, x + h * Vector3::Unit(k));
      const MagnetInField minus = at(F, x - h * Vector3::Unit(k));
      error = std::max(error, std::abs((plus.work - minus.work) / (2 * h) - value.by_x[k]));
      error = std::max(error, ((plus.by_x - minus.by_x) / (2 * h) - value.xx.col(k)).norm());
    }
    record("derivatives of the work in a field", error / value.by_F.norm());
    EXPECT_LT(error, 1e-7 * value.by_F.norm());
  }
}

// Oracle: differences of the nodal forces along a random displacement.
TEST(SolidMagnets, TangentIsTheDerivativeOfTheForces) {
  const BentCilium bent;
  dealii::DynamicSparsityPattern pattern(bent.space->unknowns());
  dealii::DoFTools::make_sparsity_pattern(bent.space->dof_handler(), pattern);
  dealii::SparsityPattern sparsity;
  sparsity.copy_from(pattern);
  std::mt19937 generator(5);
  std::uniform_real_distribution<double> uniform(-1e-4, 1e-4);
  Vector direction(bent.space->unknowns());
  for (double& value : direction) value = uniform(generator);
  for (const MagneticEnergy law : laws) {
    Environment environment{.uniform_field = {0.02, -0.03, 0.01}, .magnetic_energy = law};
    environment.magnets = {cuboid({8e-3, 2e-3, 12e-3})};
    dealii::SparseMatrix<double> matrix(sparsity);
    Vector unused(bent.space->unknowns());
    dealii::AffineConstraints<double> none;
    none.close();
    discretisation::AssembledTangent tangent(none, matrix);
    loads::environment_forces(*bent.space, bent.cilium, environment)(bent.state.displacement,
                                                                     unused, &tangent);
    Vector exact(bent.space->unknowns());
    matrix.vmult(exact, direction);
    const auto forces = [&](double t) {
      Vector u = bent.state.displacement;
      u.add(t, direction);
      return bent.forces(in(environment), u);
    };
    const double h = 0.02;
    Vector slope = forces(h);
    slope -= forces(-h);
    slope *= -1 / (2 * h);  // the matrix has −∂f/∂u
    slope -= exact;
    record("tangent against differences, relative", slope.l2_norm() / exact.l2_norm());
    EXPECT_LT(slope.l2_norm(), 1e-4 * exact.l2_norm());
    Vector fine = forces(h / 4);
    fine -= forces(-h / 4);
    fine *= -1 / (2 * h / 4);
    fine -= exact;
    // The error is of second order: nothing but the differences' own error is left.
    EXPECT_NEAR(slope.l2_norm() / fine.l2_norm(), 16, 1);
  }
}

MechanicsStep solved_beside(const MechanicsModel& model, const Environment& environment) {
  const MechanicsStep step = model.solve(stub_and_magnet(), {in(environment)}).steps.at(0);
  EXPECT_EQ(step.status, Status::converged) << step.message;
  return step;
}

// Oracles: the force on the body's charged faces, which the clamped base bears: measured 1.5e-7,
// and 5.7e-7 of the moment, margin 10. The beam, whose stubby base is softer: 3 % of the
// deflection, margin 2.
TEST(SolidMagnets, BendTheSolidLikeTheBeamAndItsBaseBearsTheForce) {
  for (const MagneticEnergy law : laws) {
    Environment environment{.magnetic_energy = law};
    environment.magnets = {cuboid({12e-3, 2e-3, 26e-3})};
    const MechanicsStep solid = solved_beside(Solid({.refinement = 0}), environment);
    const MechanicsStep beam = solved_beside(beam::Beam(), environment);
    const double deflection = (tip(beam) - Vector3(0, 0, 20e-3)).norm();
    record("solid against beam, over the deflection", (tip(solid) - tip(beam)).norm() / deflection);
    EXPECT_GT(deflection, 1e-3);
    EXPECT_LT((tip(solid) - tip(beam)).norm(), 0.06 * deflection);
    EXPECT_LT(std::abs(solid.applied_force), 1e-9);
    if (law == MagneticEnergy::R) continue;
    const auto wrench = analytic::forces::wrench_on_cilium(stub_and_magnet(), *solid.deformation,
                                                           environment.magnets);
    const SectionForces base = solid.deformation->centreline.at(0, 0).forces;
    record("force on the base against the faces', relative",
           (base.force - wrench.force).norm() / wrench.force.norm());
    record("moment on the base against the faces', relative",
           (base.moment - wrench.torque).norm() / wrench.torque.norm());
    EXPECT_LT((base.force - wrench.force).norm(), 1.5e-6 * wrench.force.norm());
    EXPECT_LT((base.moment - wrench.torque).norm(), 5e-6 * wrench.torque.norm());
  }
}

TEST(SolidMagnets, HalfMeshIsThatOfTheWhole) {
  Environment environment;
  Magnet cylinder;
  cylinder.shape = Shape::cylinder;
  cylinder.position = {10e-3, 0, 25e-3};
  cylinder.rotation = Eigen::AngleAxisd(0.6, Vector3::UnitY());
  cylinder.diameter = 4e-3;
  cylinder.length = 6e-3;
  cylinder.magnetization = {0, 0, 8e5};
  environment.magnets = {cylinder};
  const MechanicsStep half = solved_beside(Solid({.refinement = 0}), environment);
  const MechanicsStep whole =
      solved_beside(Solid({.refinement = 0, .symmetry = false}), environment);
  EXPECT_LT(half.unknowns, whole.unknowns);
  EXPECT_LT((tip(half) - tip(whole)).norm(), 1e-8 * 20e-3);
  EXPECT_GT((tip(half) - Vector3(0, 0, 20e-3)).norm(), 1e-4);
}

}  // namespace
}  // namespace ciliaval::fem::solid
