// SPDX-License-Identifier: LGPL-2.1-or-later
// The loads of the cilium: exact totals, consistent linearisation.
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "fem/solid/discretisation/assembly.h"
#include "fem/solid/equilibrium/load_path.h"
#include "fem/solid/loads/dead_forces.h"
#include "fem/solid/loads/environment_forces.h"
#include "fem/solid/loads/height_loads.h"
#include "fem/solid/postprocessing/centreline.h"
#include "problem/error.h"
#include "tests/fem/solid/cilia.h"
#include "tests/fem/solid/cube.h"

namespace ciliaval::fem::solid {
using namespace material;
using namespace discretisation;
using namespace loads;
using namespace equilibrium;
using namespace solvers;
using namespace postprocessing;
namespace {

const std::vector<Load>& all_loads() {
  static const std::vector<Load> loads{ContactLoad{2e-3, 5.3e-3, 0.4}, FlowLoad{0.3, 0.4},
                                       SectionLoad{2e-3, 5e-3, 0.4}, DeadLoad{0.3, 0.4}};
  return loads;
}

/// The same and the environment alone, by both laws.
std::vector<Load> all_loads_and_environments() {
  std::vector<Load> loads = all_loads();
  for (const auto law : {surroundings::MagneticEnergy::F, surroundings::MagneticEnergy::R})
    loads.push_back(
        with_environment(EnvironmentLoad{0.7, 0.4}, {.gravity = {1, 2, -9.81},
                                                     .fluid_density = 998,
                                                     .uniform_field = {0.02, -0.03, 0.01},
                                                     .magnetic_energy = law}));
  return loads;
}

// Oracle: what the loads mean. Contact, section: F. Dead: q L. Flow: q times the mean height of the
// tip's end face, which the centreline's end knows.
TEST(CiliumLoads, ApplyExactlyTheForceAsked) {
  const BentCilium cilium;
  for (const Load& load : all_loads()) {
    const Vector3 total = resultant(*cilium.space, cilium.forces(load, cilium.state.displacement));
    double expected = magnitude(load);
    if (type(load) == "dead") expected *= 8e-3;
    if (type(load) == "flow") {
      // ∫ z dA/A over the end face by the section points.
      double height = 0;
      for (std::size_t e = 0; e < cilium.space->elements().size(); ++e) {
        const ExtrudedCell& cell = cilium.quadrature->cells()[e];
        if (cell.top < 8e-3 * (1 - 1e-9)) continue;
        const auto u = nodal_displacements(cilium.space->elements()[e], cilium.state.displacement);
        for (int q = 0; q < section_points; ++q)
          height += cell.area[static_cast<std::size_t>(q)] / cilium.quadrature->area() *
                    (8e-3 + u.col(2).tail<9>().dot(cilium.quadrature->section_values().col(q)));
      }
      double base = 0;
      for (std::size_t e = 0; e < cilium.space->elements().size(); ++e) {
        const ExtrudedCell& cell = cilium.quadrature->cells()[e];
        if (cell.bottom > 1e-9) continue;
        const auto u = nodal_displacements(cilium.space->elements()[e], cilium.state.displacement);
        for (int q = 0; q < section_points; ++q)
          base += cell.area[static_cast<std::size_t>(q)] / cilium.quadrature->area() *
                  u.col(2).head<9>().dot(cilium.quadrature->section_values().col(q));
      }
      expected *= height - base;
    }
    EXPECT_NEAR((total - expected * direction(load)).norm() / expected, 0, 1e-9) << type(load);
  }
}

// Oracles: (ρ − ρ_f) g V, and for the field none; its moment about the origin is m × B₀ with the
// moment m of the deformed magnet: M times the difference of its end faces' centres times A (law
// F).
TEST(CiliumLoads, WeightAndFieldHaveTheirResultants) {
  const BentCilium bent;
  const SolidSpace& space = *bent.space;
  const Vector& u = bent.state.displacement;
  const surroundings::Environment weight{.gravity = {1, 2, -9.81}, .fluid_density = 998};
  const Vector3 expected =
      bent.quadrature->area() * (3e-3 * (1000 - 998) + 5e-3 * (1700 - 998)) * weight.gravity;
  const Vector3 total =
      resultant(space, bent.forces(with_environment(EnvironmentLoad{}, weight), u));
  EXPECT_LT((total - expected).norm(), 1e-12 * expected.norm());
  EXPECT_LT((weight_of(space, bent.cilium, weight) - expected).norm(), 1e-12 * expected.norm());

  const Vector3 field(0.02, -0.03, 0.01);
  for (const auto law : {surroundings::MagneticEnergy::F, surroundings::MagneticEnergy::R}) {
    const Load load =
        with_environment(EnvironmentLoad{}, {.uniform_field = field, .magnetic_energy = law});
    const Vector forces = bent.forces(load, u);
    const double scale = 75e3 * bent.quadrature->area() * field.norm();
    EXPECT_LT(resultant(space, forces).norm(), 1e-12 * scale);
    Vector3 moment = Vector3::Zero();
    std::vector<bool> seen(space.unknowns(), false);
    for (const SolidElement& element : space.elements()) {
      const auto displacement = nodal_displacements(element, u);
      for (Eigen::Index a = 0; a < element_nodes; ++a) {
        const auto node = static_cast<std::size_t>(a);
        if (seen[element.dofs[node]]) continue;
        seen[element.dofs[node]] = true;
        const Vector3 x = (element.nodes.row(a) + displacement.row(a)).transpose();
        moment +=
            x.cross(Vector3(forces[element.dofs[node]], forces[element.dofs[element_nodes + node]],
                            forces[element.dofs[2 * element_nodes + node]]));
      }
    }
    const Centreline line = centreline(space, *bent.quadrature, bent.state);
    const Vector3 m =
        75e3 * bent.quadrature->area() * (line.at(8e-3).position - line.at(3e-3).position);
    const double allowed = law == surroundings::MagneticEnergy::F ? 1e-11 : 0.02;
    EXPECT_LT((moment - m.cross(field)).norm(), allowed * m.norm() * field.norm());
  }
}

// Oracle: central differences of e = B·R M in F.
TEST(CiliumLoads, TurnedMagnetsDerivatives) {
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  Matrix3 F = Matrix3::Identity();
  for (double& f : F.reshaped()) f += 0.4 * uniform(generator);
  const Vector3 M(0.3, -0.5, 1.2);
  const Vector3 B(0.7, 0.2, -0.4);
  const TurnedMagnet at = turned_magnet(F, M, B);
  const double h = 1e-5;
  for (Eigen::Index k = 0; k < 9; ++k) {
    Matrix3 plus = F;
    Matrix3 minus = F;
    plus.reshaped()[k] += h;
    minus.reshaped()[k] -= h;
    const TurnedMagnet a = turned_magnet(plus, M, B);
    const TurnedMagnet b = turned_magnet(minus, M, B);
    EXPECT_NEAR(at.first.reshaped()[k], (a.energy - b.energy) / (2 * h), 1e-9);
    EXPECT_LT((at.second.col(k) - (a.first - b.first).reshaped() / (2 * h)).norm(), 1e-8);
  }
  EXPECT_LT((at.second - at.second.transpose()).norm(), 1e-14);
  // A rotation: e = B·Q M.
  const Matrix3 Q = Eigen::AngleAxisd(1.1, Vector3(1, 2, 3).normalized()).toRotationMatrix();
  EXPECT_NEAR(turned_magnet(Q, M, B).energy, B.dot(Q * M), 1e-15);
}

// Oracle: central differences of the residual internal(u, p) − external(u) along a random
// direction, p held and p condensed. The contact rule's moving quadrature leaves 1e-9 of the load;
// differences leave 1e-8.
TEST(CiliumLoads, TangentIsTheDerivativeOfTheResidual) {
  const BentCilium cilium;
  const SolidSpace& space = *cilium.space;
  const dealii::AffineConstraints<double> none;
  dealii::DynamicSparsityPattern pattern(space.unknowns());
  dealii::DoFTools::make_sparsity_pattern(space.dof_handler(), pattern);
  dealii::SparsityPattern sparsity;
  sparsity.copy_from(pattern);

  std::mt19937 generator(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  Vector direction(space.unknowns());
  for (double& d : direction) d = uniform(generator);

  const auto moved = [&](double step) {
    Vector u(cilium.state.displacement);
    u.add(step, direction);
    return u;
  };
  for (const Load& load : all_loads_and_environments()) {
    dealii::SparseMatrix<double> matrix(sparsity);
    AssembledTangent tangent(none, matrix);
    Vector unused(space.unknowns());
    external_forces(space, *cilium.quadrature, cilium.cilium, load, 0.5e-3)(
        cilium.state.displacement, unused, &tangent);
    Vector product(space.unknowns());
    matrix.vmult(product, direction);
    const double h = 1e-8;
    Vector difference = cilium.forces(load, moved(-h));
    difference -= cilium.forces(load, moved(h));
    difference /= 2 * h;
    product -= difference;
    const bool turns = load.environment().magnetic_energy == surroundings::MagneticEnergy::R;
    const bool follows = type(load) == "contact" || type(load) == "flow" || turns;
    if (follows) {
      EXPECT_GT(difference.l2_norm(), 0) << type(load);
      EXPECT_LT(product.l2_norm(), 1e-6 * difference.l2_norm()) << type(load);
    } else {
      EXPECT_EQ(product.l2_norm(), 0) << type(load);
    }
  }

  // Internal forces: with p = K π(J − 1) the condensed stiffness is the derivative of forces(u,
  // p(u)).
  const auto internal = internal_forces(space, cilium.state);
  ASSERT_TRUE(internal);
  dealii::SparseMatrix<double> matrix(sparsity);
  AssembledTangent tangent(none, matrix);
  add_stiffness(space, cilium.state, *internal, tangent);
  Vector product(space.unknowns());
  matrix.vmult(product, direction);
  const auto forces = [&](double step) {
    SolidState state = cilium.state;
    state.displacement = moved(step);
    project_pressure(space, state);
    return internal_forces(space, state)->forces;
  };
  const double h = 1e-9;
  Vector difference = forces(h);
  difference -= forces(-h);
  difference /= 2 * h;
  product -= difference;
  EXPECT_LT(product.l2_norm(), 1e-6 * difference.l2_norm());
}

// Oracle: where the kernel reaches beyond the end of the extrusion lines, the missing part of its
// integral, ∫ k from s₀ to w = ½ − s₀/(2w) − sin(πs₀/w)/(2π), is not applied.
TEST(CiliumLoads, ContactForceFallsShortWhereTheExtrusionLinesEnd) {
  const BentCilium cilium;
  const Vector straight(cilium.space->unknowns());
  const double w = 0.5e-3;
  const double end = 0.2e-3;  // of the extrusion lines above h
  const Vector3 total =
      resultant(*cilium.space, cilium.forces(ContactLoad{1e-3, 8e-3 - end, 0}, straight));
  const double missing =
      0.5 - end / (2 * w) - std::sin(std::numbers::pi * end / w) / (2 * std::numbers::pi);
  EXPECT_NEAR(total.x() / 1e-3, 1 - missing, 1e-9);
}

// A kernel that reaches into a layer by a rounding error, or by a hair, does not make pieces of no
// length there.
TEST(CiliumLoads, KernelMayEndAtAPlaneOfTheMesh) {
  const BentCilium cilium;
  const SolidState straight = cilium.space->undeformed();
  for (const double overlap : {0.0, 1e-19, 1e-15, 1e-9, 1e-7}) {
    const Load load = ContactLoad{1e-3, 5e-3 + 0.5e-3 - overlap, 0};
    const Centreline line =
        centreline(*cilium.space, *cilium.quadrature, straight,
                   spread_load(cilium.cilium, load, cilium.quadrature->area(), 0.5e-3));
    EXPECT_EQ(line.length(), 8e-3);
    EXPECT_NEAR(line.at(4.99e-3).position.z(), 4.99e-3, 1e-12);
  }
}

TEST(CiliumLoads, RejectAMeshThatIsNotExtruded) {
  const Block block(neo_hooke(1, 0.3), {2, 2, 2}, Vector3::Ones(), 0.2);
  const SolidSpace space(block.triangulation, block.mapping, block.materials);
  EXPECT_THROW(ExtrudedQuadrature{space}, InputError);
}

TEST(CiliumLoads, RejectASectionWithoutAPlane) {
  const BentCilium cilium;
  EXPECT_THROW(section_force(*cilium.space, *cilium.quadrature, 1, 5.1e-3, Vector3::UnitX()),
               InputError);
}

}  // namespace
}  // namespace ciliaval::fem::solid
