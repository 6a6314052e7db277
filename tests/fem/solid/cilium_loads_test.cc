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
#include "fem/solid/loads/height_loads.h"
#include "fem/solid/postprocessing/centreline.h"
#include "problem/error.h"
#include "tests/fem/solid/bent_cilium.h"
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
  dealii::Vector<double> direction(space.unknowns());
  for (double& d : direction) d = uniform(generator);

  const auto moved = [&](double step) {
    dealii::Vector<double> u(cilium.state.displacement);
    u.add(step, direction);
    return u;
  };
  for (const Load& load : all_loads()) {
    dealii::SparseMatrix<double> matrix(sparsity);
    dealii::Vector<double> unused(space.unknowns());
    external_forces(space, *cilium.quadrature, load, 0.5e-3)(cilium.state.displacement, unused,
                                                             none, &matrix);
    dealii::Vector<double> product(space.unknowns());
    matrix.vmult(product, direction);
    const double h = 1e-8;
    dealii::Vector<double> difference = cilium.forces(load, moved(-h));
    difference -= cilium.forces(load, moved(h));
    difference /= 2 * h;
    product -= difference;
    const bool follows = type(load) == "contact" || type(load) == "flow";
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
  add_stiffness(space, cilium.state, *internal, none, matrix);
  dealii::Vector<double> product(space.unknowns());
  matrix.vmult(product, direction);
  const auto forces = [&](double step) {
    SolidState state = cilium.state;
    state.displacement = moved(step);
    project_pressure(space, state);
    return internal_forces(space, state)->forces;
  };
  const double h = 1e-9;
  dealii::Vector<double> difference = forces(h);
  difference -= forces(-h);
  difference /= 2 * h;
  product -= difference;
  EXPECT_LT(product.l2_norm(), 1e-6 * difference.l2_norm());
}

// Oracle: where the kernel reaches beyond the end of the extrusion lines, the missing part of its
// integral, ∫ k from s₀ to w = ½ − s₀/(2w) − sin(πs₀/w)/(2π), is not applied.
TEST(CiliumLoads, ContactForceFallsShortWhereTheExtrusionLinesEnd) {
  const BentCilium cilium;
  const dealii::Vector<double> straight(cilium.space->unknowns());
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
    const Centreline line = centreline(*cilium.space, *cilium.quadrature, straight,
                                       spread_load(load, cilium.quadrature->area(), 0.5e-3));
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
