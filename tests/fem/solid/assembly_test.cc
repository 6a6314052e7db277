// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/discretisation/assembly.h"

#include <deal.II/base/multithread_info.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <random>

#include "tests/fem/solid/cube.h"

namespace ciliaval::fem::solid {
using namespace material;
using namespace discretisation;
using namespace loads;
using namespace equilibrium;
using namespace solvers;
namespace {

/// A distorted block at a random displacement and pressure.
struct RandomBlock {
  Block block;
  SolidSpace space;
  SolidState state;

  RandomBlock()
      : block(Hyperelastic::mooney_rivlin(1, 50, 0.25), {4, 4, 4}, Vector3::Ones(), 0.2),
        space(block.triangulation, block.mapping, block.materials),
        state(space.undeformed()) {
    std::mt19937 generator(3);
    std::uniform_real_distribution<double> noise(-5e-3, 5e-3);
    for (double& u : state.displacement) u = noise(generator);
    project_pressure(space, state);
  }
};

/// Forces and stiffness of a block, assembled by so many threads.
struct Assembled {
  Vector condensed;
  std::vector<double> stiffness;

  Assembled(const RandomBlock& body, unsigned int threads) {
    dealii::MultithreadInfo::set_thread_limit(threads);
    EXPECT_EQ(dealii::MultithreadInfo::n_threads(), threads);
    const auto internal = internal_forces(body.space, body.state);
    condensed = internal.value().condensed;
    dealii::DynamicSparsityPattern pattern(body.space.unknowns());
    dealii::DoFTools::make_sparsity_pattern(body.space.dof_handler(), pattern);
    dealii::SparsityPattern sparsity;
    sparsity.copy_from(pattern);
    dealii::SparseMatrix<double> matrix(sparsity);
    const dealii::AffineConstraints<double> none;
    AssembledTangent tangent(none, matrix);
    add_stiffness(body.space, body.state, *internal, tangent);
    for (const auto& entry : matrix) stiffness.push_back(entry.value());
  }
};

// Oracle: one thread. Sums are taken in the order of the cells, so that not a bit may differ.
TEST(SolidAssembly, DoesNotDependOnTheNumberOfThreads) {
  // deal.II takes the variable as an upper bound.
  unsetenv("DEAL_II_NUM_THREADS");
  const unsigned int before = dealii::MultithreadInfo::n_threads();
  const RandomBlock body;
  const Assembled serial(body, 1);
  const Assembled parallel(body, 4);
  dealii::MultithreadInfo::set_thread_limit(before);
  EXPECT_TRUE(std::ranges::equal(parallel.condensed, serial.condensed));
  EXPECT_EQ(parallel.stiffness, serial.stiffness);
}

// Oracle: the tangent of an energy is symmetric; half of it is computed, so that it is so to the
// last bit. Rigid translations do no work: measured 1e-16 of the matrix.
TEST(SolidAssembly, ElementStiffnessIsSymmetricAndBlindToTranslations) {
  const RandomBlock body;
  const auto internal = internal_forces(body.space, body.state);
  ASSERT_TRUE(internal);
  dealii::FullMatrix<double> matrix(element_dofs, element_dofs);
  element_stiffness(body.space.elements()[5], body.state, 5, internal->pressure[5], matrix);
  const double norm = matrix.frobenius_norm();
  EXPECT_GT(norm, 0);
  for (unsigned int i = 0; i < element_dofs; ++i) {
    for (unsigned int j = 0; j < i; ++j) EXPECT_EQ(matrix(i, j), matrix(j, i));
    for (unsigned int c = 0; c < 3; ++c) {
      double force = 0;
      for (unsigned int a = 0; a < element_nodes; ++a) force += matrix(i, element_nodes * c + a);
      EXPECT_NEAR(force, 0, 1e-14 * norm);
    }
  }
}

TEST(SolidAssembly, RefusesAStateTurnedInsideOut) {
  RandomBlock body;
  for (const auto dof : body.space.elements()[7].dofs) body.state.displacement[dof] *= 100;
  EXPECT_FALSE(internal_forces(body.space, body.state).has_value());
}

}  // namespace
}  // namespace ciliaval::fem::solid
