// SPDX-License-Identifier: LGPL-2.1-or-later
// The linear solvers of the solid against each other and against what theory says of them.
#include "fem/solid/solvers/linear_solver.h"

#include <deal.II/dofs/dof_tools.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <random>
#include <vector>

#include "cube.h"
#include "fem/solid/solid.h"
#include "fem/solid/solvers/multigrid.h"
#include "fem/solid/solvers/symmetric_inverse.h"
#include "problem/error.h"
#include "problem/types.h"
#include "tests/bench/mesh_family.h"

namespace ciliaval::fem::solid {
using namespace material;
using namespace discretisation;
using namespace loads;
using namespace equilibrium;
using namespace solvers;
namespace {

/// The tangent of an undeformed block, clamped on −x, and the nodal forces of a body force.
struct System {
  Block block;
  SolidSpace space;
  dealii::AffineConstraints<double> constraints;
  dealii::SparsityPattern pattern;
  dealii::SparseMatrix<double> matrix;
  Vector forces;

  explicit System(double poisson_ratio, double height = 1)
      : block(neo_hooke(1, poisson_ratio), {6, 2, 2}, {3, 1, height}, 0.2),
        space(block.triangulation, block.mapping, block.materials),
        constraints(increment_constraints(space, std::vector<DirichletCondition>{{.boundary = 0}})),
        forces(body_force(space, [](const Vector3&) -> Vector3 {
          return {0, 0.001, 0.002};
        })) {
    dealii::DynamicSparsityPattern dynamic(space.unknowns());
    dealii::DoFTools::make_sparsity_pattern(space.dof_handler(), dynamic, constraints, true);
    pattern.copy_from(dynamic);
    matrix.reinit(pattern);
    AssembledTangent tangent(constraints, matrix);
    assemble(tangent);
    constraints.set_zero(forces);
  }

  void assemble(TangentMatrix& tangent) const {
    const SolidState state = space.undeformed();
    add_stiffness(space, state, *internal_forces(space, state), tangent);
  }
  /// Solver with its tangent.
  std::unique_ptr<LinearSolver> solver(SolverKind kind) const {
    auto result = std::make_unique<LinearSolver>(space, constraints, kind, MPI_COMM_SELF);
    assemble(result->new_tangent());
    result->prepare();
    return result;
  }
  CellNodes cells() const { return element_cell_nodes(space); }
  /// The rows in blocks.
  std::unique_ptr<BlockCsr> blocks() const {
    auto result = std::make_unique<BlockCsr>(cells(), constrained_unknowns(space, constraints));
    result->clear();
    assemble(*result);
    return result;
  }
};

double relative_residual(const System& system, const Vector& solution) {
  Vector residual(solution.size());
  system.matrix.vmult(residual, solution);
  residual -= system.forces;
  return residual.l2_norm() / system.forces.l2_norm();
}

// Oracle: the definition of the residual. Measured 1e-11, the rounding errors of a tangent with
// K/μ = 50, with the direct solver: ten times that is allowed. With the iterative one: the
// reduction asked.
TEST(SolidLinearSolver, SolvesToTheReductionAskedFor) {
  const System system(0.49);
  for (const SolverKind kind : {SolverKind::direct, SolverKind::iterative}) {
    const auto solver = system.solver(kind);
    Vector solution;
    solver->solve(system.forces, solution, 1e-8);
    EXPECT_LE(relative_residual(system, solution), kind == SolverKind::direct ? 1e-10 : 1e-8);
    // The same preparation serves other right-hand sides.
    Vector twice(system.forces);
    twice *= 2;
    Vector other;
    solver->solve(twice, other, 1e-8);
    other.add(-2, solution);
    EXPECT_LE(other.linfty_norm(), 1e-6 * solution.linfty_norm());
  }
}

// Oracle: the definition of the inverse, whose rounding errors are the condition times epsilon;
// matrices smaller and larger than the blocks of the algorithm, positive definite and not. Measured
// up to 0.75 of that; Schur complements by explicit inverses reach 4e5 of it.
TEST(SolidLinearSolver, SymmetricInverseIsAccurateToTheCondition) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  for (const Eigen::Index size : {1, 5, 33, 49, 81, 150, 257})
    for (const double condition : {1e1, 1e10})
      for (const bool is_positive : {true, false}) {
        const Eigen::MatrixXd columns =
            Eigen::MatrixXd::NullaryExpr(size, size, [&] { return normal(random); });
        const Eigen::MatrixXd Q = Eigen::HouseholderQR<Eigen::MatrixXd>(columns).householderQ();
        Eigen::VectorXd eigenvalues(size);
        for (Eigen::Index i = 0; i < size; ++i)
          eigenvalues[i] = std::pow(condition, static_cast<double>(i) / static_cast<double>(size));
        if (!is_positive) eigenvalues[0] *= -1;
        const Eigen::MatrixXd A = Q * eigenvalues.asDiagonal() * Q.transpose();
        const Eigen::MatrixXd lower = symmetric_inverse(0.5 * (A + A.transpose()));
        const Eigen::MatrixXd inverse = lower.selfadjointView<Eigen::Lower>();
        const Eigen::MatrixXd expected =
            Q * eigenvalues.cwiseInverse().asDiagonal() * Q.transpose();
        EXPECT_LE((inverse - expected).norm(), 2 * condition * epsilon * expected.norm())
            << size << ' ' << condition << ' ' << is_positive;
      }
}

double largest_eigenvalue_with_patches(const System& system) {
  const auto blocks = system.blocks();
  VertexPatchSchwarz patches(system.space, system.cells(), *blocks,
                             static_cast<Node>(blocks->nodes()));
  patches.update(*blocks);
  Vector x(system.space.unknowns());
  std::iota(x.begin(), x.end(), 1.0);
  system.constraints.set_zero(x);
  Vector y(x.size());
  double eigenvalue = 0;
  for (int i = 0; i < 40; ++i) {
    x /= x.l2_norm();
    system.matrix.vmult(y, x);
    patches.vmult(x, y);
    eigenvalue = x.l2_norm();
  }
  return eigenvalue;
}

// Oracle: Schwarz theory. A cell meets eight patches, so that λ_max ≤ 8; on a mesh with cells that
// have eight free patches it comes near. In two layers of thin cells the vertices of
// a line share a patch, so that a cell meets four. Power iteration, from below.
TEST(SolidLinearSolver, VertexPatchesHaveNoEigenvalueBeyondEight) {
  const double thick = largest_eigenvalue_with_patches(System(0.49));
  EXPECT_LE(thick, VertexPatchSchwarz::largest_eigenvalue * (1 + 1e-5));  // single precision
  EXPECT_GE(thick, 0.5 * VertexPatchSchwarz::largest_eigenvalue);
  EXPECT_LE(largest_eigenvalue_with_patches(System(0.49, 0.2)), 4 * (1 + 1e-5));
}

// Oracle: deal.II's product. Sums in another order.
TEST(SolidLinearSolver, RowsInBlocksMultiplyAsTheMatrix) {
  const System system(0.49);
  const Row size = system.space.unknowns();
  Vector x(size);
  std::iota(x.begin(), x.end(), -0.5 * size);
  system.constraints.set_zero(x);
  Vector expected(size);
  system.matrix.vmult(expected, x);
  Vector product(size);
  system.blocks()->vmult(product, x);
  for (Row row = 0; row < size; ++row)
    if (!system.constraints.is_constrained(row)) {
      EXPECT_NEAR(product[row], expected[row], 1e-13 * expected.linfty_norm());
    }
}

// Oracle: the purpose of the vertex patches. A point or cell smoother would need √(K/μ) times as
// many iterations: five times at ν = 0.49 against 0.3.
TEST(SolidLinearSolver, IterationsGrowLittleWithTheBulkModulus) {
  const auto iterations = [](double poisson_ratio) {
    const System system(poisson_ratio);
    Vector solution;
    return system.solver(SolverKind::iterative)->solve(system.forces, solution, 1e-6);
  };
  const int compressible = iterations(0.3);
  EXPECT_LE(iterations(0.49), 3 * compressible);
}

/// GMRES's iterations to 1e-6.
int iterations_of(const Discretised& problem) {
  LinearSolver solver(*problem.space, problem.constraints, SolverKind::iterative, MPI_COMM_SELF);
  problem.assemble(solver);
  solver.prepare();
  Vector solution;
  return solver.solve(problem.forces, solution, 1e-6);
}

// Oracle: the purpose of patches of several vertices. Measured 15 and 18; with patches of one
// vertex three more rings took the iterations from 18 to 77 (docs/measurements.md).
TEST(SolidLinearSolver, IterationsHardlyGrowInThinRings) {
  const int thick = iterations_of({mesh_options(4, 1, 1, 0.11, 0.4), 0.49});
  const int thin = iterations_of({mesh_options(4, 5, 0.5, 0.11, 0.4), 0.49});
  RecordProperty("thick", thick);
  RecordProperty("thin", thin);
  EXPECT_LE(thin, 2 * thick);
}

// Oracle: the purpose of the vertex patches: a point smoother would take √(K/μ), ten times as many
// iterations at ν = 0.4999 as at 0.49. Half of that is allowed; measured 14 and 38. Where the
// patches' matrices are inverted by Schur complements, GMRES does not converge on this graded mesh.
TEST(SolidLinearSolver, ConvergesNearlyIncompressibleOnAGradedMesh) {
  const int usual = iterations_of({cylinder_mesh_options(0), 0.49});
  const int incompressible = iterations_of({cylinder_mesh_options(0), 0.4999});
  RecordProperty("usual", usual);
  RecordProperty("incompressible", incompressible);
  EXPECT_LE(incompressible, 5 * usual);
}

// Oracle: the aim: at most twice the iterations from 20,000 to 1,000,000 unknowns, in 16 GB.
// Measured 15 and 20.
TEST(SolidLinearSolverSlow, AMillionUnknownsTakeNoMoreThanTwiceTheIterations) {
  const int few = iterations_of({mesh_family.front(), 0.49});
  const Discretised large(mesh_family[million], 0.49);
  EXPECT_GT(large.space->unknowns(), 950000U);
  const int many = iterations_of(large);
  RecordProperty("few", few);
  RecordProperty("many", many);
  EXPECT_LE(many, 2 * few);
  EXPECT_LT(gigabytes(), 16);
}

// The patches of the straight cilium for the tangent of a far bent one: GMRES gives them up, and
// goes on with new ones. Oracle: the definition of the residual.
TEST(SolidLinearSolver, GivesUpPatchesThatDoNotServe) {
  const Discretised problem(mesh_family.front(), 0.49);
  LinearSolver solver(*problem.space, problem.constraints, SolverKind::iterative, MPI_COMM_SELF);
  problem.assemble(solver);
  solver.prepare();
  Vector solution;
  const int usual = solver.solve(problem.forces, solution, 1e-6);
  constexpr double curvature = 40;  // 1/m: the tip turns by 46°
  SolidState bent = problem.space->undeformed();
  for (const SolidElement& element : problem.space->elements())
    for (std::size_t a = 0; a < element_nodes; ++a) {
      const Vector3 X = element.nodes.row(static_cast<Eigen::Index>(a));
      const double angle = curvature * X.z();
      bent.displacement[element.dofs[a]] =
          (1 - std::cos(angle)) / curvature + X.x() * (std::cos(angle) - 1);
      bent.displacement[element.dofs[2 * element_nodes + a]] =
          std::sin(angle) / curvature - X.z() - X.x() * std::sin(angle);
    }
  const auto assemble = [&](TangentMatrix& tangent) {
    add_stiffness(*problem.space, bent, *internal_forces(*problem.space, bent), tangent);
  };
  assemble(solver.new_tangent());
  solver.prepare_near_last();
  EXPECT_GT(solver.solve(problem.forces, solution, 1e-6), usual + 10);
  BlockCsr matrix(element_cell_nodes(*problem.space),
                  constrained_unknowns(*problem.space, problem.constraints));
  matrix.clear();
  assemble(matrix);
  Vector residual = problem.space->vector();
  matrix.vmult(residual, solution);
  residual -= problem.forces;
  EXPECT_LE(residual.l2_norm(), 1e-6 * problem.forces.l2_norm());
}

// Oracle: linear algebra; nothing can be solved with a matrix of zeros. The next matrix can.
TEST(SolidLinearSolver, RefusesASingularMatrix) {
  const System system(0.3);
  LinearSolver solver(system.space, system.constraints, SolverKind::direct, MPI_COMM_SELF);
  Vector solution;
  EXPECT_THROW(
      {
        solver.new_tangent();
        solver.prepare();
        solver.solve(system.forces, solution, 1e-6);
      },
      SolverError);
  system.assemble(solver.new_tangent());
  solver.prepare();
  solver.solve(system.forces, solution, 1e-6);
  EXPECT_LE(relative_residual(system, solution), 1e-10);
}

// Oracle: the direct solver, which shares only the assembly. Both end with an estimated error of
// 1e-9 of the displacement; the bound is that of MPI and of the solvers together.
TEST(SolidLinearSolver, DirectAndIterativeGiveTheSameCilium) {
  const Cilium cilium{
      3e-3,
      {{.name = "base", .length = 3e-3, .young_modulus = 1e5, .poisson_ratio = 0.49},
       {.name = "magnet", .length = 17e-3, .young_modulus = 3e6, .poisson_ratio = 0.49}}};
  const auto tip = [&](SolverKind kind) {
    SolidOptions options;
    options.refinement = 0;
    options.solver = kind;
    const LoadPath path{ContactLoad{.force = 1e-3, .height = 16e-3, .azimuth = 0.5}};
    const MechanicsStep step = Solid(options).solve(cilium, path).steps.front();
    if (!step.deformation) throw SolverError(step.message);
    return step.deformation->centreline.at(cilium.length()).position;
  };
  const Vector3 direct = tip(SolverKind::direct);
  const Vector3 iterative = tip(SolverKind::iterative);
  EXPECT_LE((direct - iterative).norm(), 1e-9 * direct.head<2>().norm());
}

}  // namespace
}  // namespace ciliaval::fem::solid
