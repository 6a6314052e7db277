// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>

#include <cmath>

#include "bodies.h"
#include "fem/parallel.h"
#include "fem/potential/block_cut.h"
#include "fem/potential/functional.h"
#include "fem/potential/operator.h"

namespace ciliaval::fem::potential {
namespace {

/// A cube from −1 to 1 m in leaves of 2⁻ˡᵉᵛᵉˡ⁺¹, with one octant, or two, a level finer.
class Graded : public Octree {
 public:
  explicit Graded(int level, bool two_octants = false);
};

Graded::Graded(int level, bool two_octants) : Octree(Vector3::Zero(), 1) {
  const double size = std::ldexp(2.0, -level);
  while (refine([&](const Cube& cube) {
    return cube.size >
           1.5 * ((two_octants ? cube.centre().head<2>().minCoeff() : cube.centre().minCoeff()) > 0
                      ? size / 2
                      : size);
  })) {
  }
}

struct Function {
  std::function<double(const Vector3&)> value;
  std::function<Vector3(const Vector3&)> gradient;
  std::function<double(const Vector3&)> load{};  ///< −Δψ; empty: zero
};

struct Solved {
  PotentialVector psi;
  unsigned int iterations = 0;
};

/// −Δψ = load with the function's values on the boundary.
Solved solve_for(const Function& f, const PotentialSpace& space, double tolerance = 1e-12) {
  const Octree& octree = space.octree();
  const CutCells none(octree, space.degree());
  const PotentialOperator A(space, none);
  const PotentialMultigrid::Coarse coarse(octree, none);
  const PotentialMultigrid multigrid(A, coarse);
  PotentialVector psi = space.boundary_values(f.value);
  PotentialVector load = A.apply_complete(psi);
  load *= -1;
  const QuadratureRule rule = gauss_legendre(space.degree() + 3, 0, 1);
  for (int c = 0; f.load && c < static_cast<int>(octree.cells().size()); ++c) {
    const Cube& cube = octree.cubes()[static_cast<std::size_t>(c)];
    Eigen::VectorXd r = Eigen::VectorXd::Zero(space.nodes());
    for (std::size_t i = 0; i < rule.nodes.size(); ++i)
      for (std::size_t j = 0; j < rule.nodes.size(); ++j)
        for (std::size_t k = 0; k < rule.nodes.size(); ++k) {
          const Vector3 unit(rule.nodes[i], rule.nodes[j], rule.nodes[k]);
          const double w = rule.weights[i] * rule.weights[j] * rule.weights[k];
          r += w * std::pow(cube.size, 3) * f.load(cube.lower + cube.size * unit) *
               shape_values(space.basis(), unit);
        }
    space.add_free(c, r, load);
  }
  load.compress(dealii::VectorOperation::add);
  PotentialVector x = space.vector();
  Solved result;
  result.iterations = solve(A, multigrid, load, tolerance, x);
  psi.zero_out_ghost_values();
  psi += x;
  space.complete(psi);
  result.psi = psi;
  return result;
}

struct Errors {
  double L2 = 0;
  double H1 = 0;
};

Errors errors(const Function& f, const PotentialSpace& space, const PotentialVector& psi) {
  Errors sum;
  const QuadratureRule rule = gauss_legendre(space.degree() + 3, 0, 1);
  Eigen::VectorXd u(space.nodes());
  for (int c = 0; c < static_cast<int>(space.octree().cells().size()); ++c) {
    const Cube& cube = space.octree().cubes()[static_cast<std::size_t>(c)];
    space.read(c, psi, u);
    for (std::size_t i = 0; i < rule.nodes.size(); ++i)
      for (std::size_t j = 0; j < rule.nodes.size(); ++j)
        for (std::size_t k = 0; k < rule.nodes.size(); ++k) {
          const Vector3 unit(rule.nodes[i], rule.nodes[j], rule.nodes[k]);
          const Vector3 x = cube.lower + cube.size * unit;
          const double w =
              rule.weights[i] * rule.weights[j] * rule.weights[k] * std::pow(cube.size, 3);
          const Vector3 gradient = shape_gradients(space.basis(), unit).transpose() * u / cube.size;
          sum.L2 += w * std::pow(shape_values(space.basis(), unit).dot(u) - f.value(x), 2);
          sum.H1 += w * (gradient - f.gradient(x)).squaredNorm();
        }
  }
  return {std::sqrt(sum.L2), std::sqrt(sum.H1)};
}

Function manufactured() {
  return {[](const Vector3& x) {
            return std::cos(2.3 * x[0] + 0.4) * std::sin(2.1 * x[1] + 0.7) * std::exp(0.9 * x[2]);
          },
          [](const Vector3& x) {
            const double c = std::cos(2.3 * x[0] + 0.4);
            const double s = std::sin(2.1 * x[1] + 0.7);
            return Vector3(std::exp(0.9 * x[2]) * Vector3(-2.3 * std::sin(2.3 * x[0] + 0.4) * s,
                                                          2.1 * c * std::cos(2.1 * x[1] + 0.7),
                                                          0.9 * c * s));
          },
          [](const Vector3& x) {
            return (2.3 * 2.3 + 2.1 * 2.1 - 0.9 * 0.9) * std::cos(2.3 * x[0] + 0.4) *
                   std::sin(2.1 * x[1] + 0.7) * std::exp(0.9 * x[2]);
          }};
}

// Oracle: the function that made the load. Orders p+1 in L2 and p in H1 on graded meshes with
// hanging nodes. Measured from the last halving: see the printed figures; margin 0.15.
TEST(ManufacturedSolution, ConvergesAtTheExpectedOrders) {
  start_mpi();
  const Function f = manufactured();
  for (const unsigned int degree : {1U, 2U, 3U}) {
    std::vector<Errors> all;
    for (const int level : {2, 3}) {
      const Graded octree(level);
      const PotentialSpace space(octree, degree);
      all.push_back(errors(f, space, solve_for(f, space).psi));
    }
    const double L2 = std::log2(all[0].L2 / all[1].L2);
    const double H1 = std::log2(all[0].H1 / all[1].H1);
    std::printf("degree %u: order %.2f in L2, %.2f in H1 (errors %.1e, %.1e)\n", degree, L2, H1,
                all[1].L2, all[1].H1);
    EXPECT_NEAR(L2, degree + 1, 0.15);
    EXPECT_NEAR(H1, degree, 0.15);
  }
}

// Oracle: a harmonic polynomial of degree 3 lies in the space of cubic elements, hanging nodes or
// not. Measured 1e-12.
TEST(ManufacturedSolution, ACubicIsReproducedAcrossHangingNodes) {
  start_mpi();
  const Function f{
      [](const Vector3& x) { return x[0] * (x[0] * x[0] - 3 * x[1] * x[1]) + x[1] * x[2] - 2; },
      [](const Vector3& x) {
        return Vector3(3 * x[0] * x[0] - 3 * x[1] * x[1], -6 * x[0] * x[1] + x[2], x[1]);
      },
      [](const Vector3&) { return 0.0; }};
  const Graded octree(2);
  const PotentialSpace space(octree, 3);
  const Solved solved = solve_for(f, space, 1e-13);
  EXPECT_LT(errors(f, space, solved.psi).H1, 1e-10);
  // The mean over a ball gives the gradient of each harmonic polynomial at its centre; what is left
  // is the quadrature of the weight: measured 3e-8.
  const Vector3 centre(0.1, -0.2, 0.15);
  const Vector3 gradient = SensorFunctional(space, {{centre, 0.5}}).gradients(solved.psi).front();
  EXPECT_LT((gradient - f.gradient(centre)).norm() / f.gradient(centre).norm(), 1e-6);
}

// Bounded iterations at the size that the model is made for, and the right solution: a harmonic
// function in Q2, whose L2 error falls with the third power of the leaves' size.
TEST(MultigridSlow, SolvesSixMillionUnknownsInAsManyIterations) {
  start_mpi();
  const Function f{[](const Vector3& x) { return std::exp(x[0]) * std::sin(x[1] + 0.3); },
                   [](const Vector3& x) {
                     return Vector3(std::exp(x[0]) * std::sin(x[1] + 0.3),
                                    std::exp(x[0]) * std::cos(x[1] + 0.3), 0);
                   }};
  const Graded octree(6, true);
  const PotentialSpace space(octree, 2);
  EXPECT_GT(space.unknowns(), 5000000U);
  const Solved solved = solve_for(f, space, 1e-8);
  const double error = errors(f, space, solved.psi).L2;
  std::printf("%zu unknowns, %u iterations, L2 error %.1e\n", space.unknowns(), solved.iterations,
              error);
  EXPECT_LE(solved.iterations, 10U);
  EXPECT_LT(error, 1e-6);
}

// Bounded iterations: they do not grow from 1,400 to 68,000 unknowns (Q2) and 220,000 (Q3).
TEST(Multigrid, IterationsDoNotGrowWithTheMesh) {
  start_mpi();
  const Function f = manufactured();
  for (const unsigned int degree : {2U, 3U}) {
    std::vector<unsigned int> iterations;
    for (const int level : {2, 3, 4}) {
      const Graded octree(level);
      const PotentialSpace space(octree, degree);
      iterations.push_back(solve_for(f, space, 1e-8).iterations);
      std::printf("degree %u: %zu unknowns, %u iterations\n", degree, space.unknowns(),
                  iterations.back());
    }
    EXPECT_LE(iterations.back(), iterations.front() + 3);
    EXPECT_LE(iterations.back(), 15U);
  }
}

// Oracle: the plain sums Σ m·∇φ and Σ w ∇φ·∇φ over the magnet's own samples, which the Gauss
// weights of a leaf replace. Measured 1e-14.
TEST(CutCells, GaussWeightsGiveTheSumsOverTheSamples) {
  start_mpi();
  const Magnet magnet(test::paper_cilium(), test::arc(60), MagnetPushForward::F);
  Octree octree(Vector3(1e-3, 0, 9e-3), 0.1);  // one leaf, so large that no block is cut
  CutCells bodies(octree, 3);
  const Sampling sampling{3, 2};
  bodies.add(magnet, 1.4, sampling);
  const PotentialSpace space(octree, 3);
  const BlockCut cut(sampling.block_points, sampling.piece_points);
  std::vector<MagnetSample> samples;
  for (const Magnet::Block& block : magnet.blocks()) {
    std::vector<MagnetSample> gauss;
    magnet.sample(block, sampling.block_points, gauss);
    cut.cut(gauss, {octree.root().lower, octree.root().size}, samples);
  }
  ASSERT_EQ(bodies.samples(), samples.size());
  Eigen::VectorXd source = Eigen::VectorXd::Zero(64);
  Eigen::MatrixXd stiffness = Eigen::MatrixXd::Zero(64, 64);
  const Cube& cube = octree.cubes().front();
  for (const MagnetSample& s : samples) {
    const auto gradients =
        (shape_gradients(space.basis(), (s.position - cube.lower) / cube.size) / cube.size).eval();
    source += gradients * s.moment;
    stiffness += 0.4 * s.volume * gradients * gradients.transpose();
  }
  EXPECT_LT((bodies.source(0, space.basis()) - source).norm() / source.norm(), 1e-12);
  EXPECT_LT((bodies.stiffness(0, space.basis()) - stiffness).norm() / stiffness.norm(), 1e-12);
}

// Oracle: a leaf wholly inside of the straight magnet has its μ_r, whatever the blocks that its
// faces cut. Measured 3.5e-3 of μ_r − 1 in the mean square over 88 leaves; Gauss points of whole
// blocks give 0.1.
TEST(CutCells, LeavesInsideOfTheMagnetAreFull) {
  start_mpi();
  const Magnet magnet(test::paper_cilium(), test::arc(0), MagnetPushForward::F);
  Octree octree(Vector3(0.13e-3, 0.07e-3, 11.3e-3), 12e-3);
  const Eigen::AlignedBox3d around(Vector3(-1.5e-3, -1.5e-3, 3e-3), Vector3(1.5e-3, 1.5e-3, 20e-3));
  while (octree.refine(
      [&](const Cube& cube) { return cube.size > 0.8e-3 && cube.box().intersects(around); })) {
  }
  CutCells bodies(octree, 3);
  bodies.add(magnet, 1.4);
  int inside = 0;
  double sum = 0;
  for (const int cell : bodies.cells()) {
    const Eigen::AlignedBox3d box = octree.cubes()[static_cast<std::size_t>(cell)].box();
    const double rim =
        box.min().head<2>().cwiseAbs().cwiseMax(box.max().head<2>().cwiseAbs()).norm();
    if (rim > 1.5e-3 || box.min()[2] < 3e-3 || box.max()[2] > 20e-3) continue;
    const double error = (bodies.mean_permeability(cell) - 1.4) / 0.4;
    EXPECT_LT(std::abs(error), 1e-2);
    sum += error * error;
    ++inside;
  }
  ASSERT_GT(inside, 20);
  std::printf("%d leaves inside, mean square error of mu_r - 1: %.1e of it\n", inside,
              std::sqrt(sum / inside));
}

}  // namespace
}  // namespace ciliaval::fem::potential
