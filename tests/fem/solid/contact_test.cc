// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "fem/solid/contact/follower.h"
#include "fem/solid/contact/nodal_contact.h"
#include "fem/solid/contact/rigid_surface.h"
#include "meshes/boundary_ids.h"
#include "tests/fem/solid/cilia.h"
#include "tests/fem/solid/cube.h"

namespace ciliaval::fem::solid::contact {
using namespace discretisation;
using namespace surroundings;
namespace {

const Surface waves{SineProfile{0.5e-3, 6e-3}, 0.3, 0.05};
const Vector3 oblique(std::cos(0.4), std::sin(0.4), 0);

RigidSurface waves_at(double height) {
  return {.profile = &waves, .direction = oblique, .height = height, .travel = 0.7e-3};
}

RigidSurface pin_at(double height) {
  return {.pin = 0.8e-3, .direction = oblique, .height = height, .travel = 0.2e-3};
}

/// Oracle: central differences.
void expect_derivatives(const RigidSurface& surface) {
  const Vector3 x(1.1e-3, 0.3e-3, 19.2e-3);
  const SurfacePoint point = surface_point(surface, x);
  const double step = 1e-8;
  for (Eigen::Index k = 0; k < 3; ++k) {
    const SurfacePoint after = surface_point(surface, x + step * Vector3::Unit(k));
    const SurfacePoint before = surface_point(surface, x - step * Vector3::Unit(k));
    const double xi = point.place_gradient[k];
    EXPECT_NEAR((after.place[0] - before.place[0]) / (2 * step), xi, 1e-7);
    EXPECT_NEAR((after.place[1] - before.place[1]) / (2 * step), point.tangents(k, 1), 1e-7);
    EXPECT_NEAR((after.gap - before.gap) / (2 * step), point.gap_gradient[k], 1e-7);
    EXPECT_LT(
        ((after.normal - before.normal) / (2 * step) + point.curvature * xi * point.tangents.col(0))
            .norm(),
        1e-5 * std::abs(point.curvature));
    EXPECT_LT(((after.tangents.col(0) - before.tangents.col(0)) / (2 * step) -
               point.curvature * xi * point.normal)
                  .norm(),
              1e-5 * std::abs(point.curvature));
  }
}

TEST(RigidSurface, HasTheDerivativesOfGapNormalAndTangent) {
  expect_derivatives(waves_at(20e-3));
  expect_derivatives(pin_at(19e-3));
}

/// On the surface itself the gap's gradient is the normal.
TEST(RigidSurface, HasNoGapOnTheSurface) {
  const RigidSurface surface = waves_at(20e-3);
  Vector3 x(1.1e-3, 0.3e-3, 0);
  x.z() = 20e-3 - waves.at(x.dot(oblique) - 0.7e-3).height;
  const SurfacePoint point = surface_point(surface, x);
  EXPECT_NEAR(point.gap, 0, 1e-18);
  EXPECT_LT((point.gap_gradient - point.normal).norm(), 1e-12);
  EXPECT_NEAR(point.normal.norm(), 1, 1e-14);
  EXPECT_NEAR(point.tangents.col(0).dot(point.normal), 0, 1e-14);
}

NodeMemory memory_of(NodeState state) {
  NodeMemory memory;
  memory.multiplier = 2e-3;
  memory.friction = {3e-4, -1e-4};
  memory.place = {0.4e-3, -0.15e-3};
  memory.state = state;
  memory.along = Eigen::Vector2d(-1, 0.3).normalized();
  return memory;
}

/// Oracle: central differences. Sticking, sliding, and sliding in the direction that is kept.
void expect_derivative_of_force(const RigidSurface& surface) {
  const ContactLaw law{0.3, 50};
  const Vector3 x(1.1e-3, 0.3e-3, 20.1e-3);
  NodeMemory kept = memory_of(NodeState::slip);
  kept.along *= -1;
  for (const NodeMemory& memory : {memory_of(NodeState::stick), memory_of(NodeState::slip), kept}) {
    const auto force = [&](const Vector3& at, double normal) {
      return node_force(surface_point(surface, at), memory, law, normal);
    };
    const NodeForce here = force(x, force(x, 0).normal);
    NodeForce expected = here;
    if (memory.state == NodeState::stick) {
      // On a node that sticks the friction remembered stands for the one there.
      NodeMemory there = memory;
      there.friction = here.friction;
      there.place = surface_point(surface, x).place;
      expected = node_force(surface_point(surface, x), there, law, here.normal);
      EXPECT_LT((expected.force - here.force).norm(), 1e-12 * here.force.norm());
    }
    const double step = 1e-8;
    for (Eigen::Index k = 0; k < 3; ++k) {
      const Vector3 difference = (force(x + step * Vector3::Unit(k), 0).force -
                                  force(x - step * Vector3::Unit(k), 0).force) /
                                 (2 * step);
      EXPECT_LT((difference - expected.derivative.col(k)).norm(), 1e-6 * expected.derivative.norm())
          << k << " " << static_cast<int>(memory.state);
    }
  }
}

TEST(NodalContact, HasTheDerivativeOfTheNodesForce) {
  expect_derivative_of_force(waves_at(20e-3));
  expect_derivative_of_force(pin_at(19.5e-3));
}

/// A flat tilted surface on a bent cilium: −∂f/∂u in the matrix, against central differences.
TEST(NodalContact, PutsTheDerivativeIntoTheMatrix) {
  const BentCilium cilium;
  const Surface flat{FlatProfile{}, 0.3, 0.1};
  const RigidSurface surface{.profile = &flat, .direction = oblique, .height = 7.5e-3};
  const auto nodes = contact_nodes(*cilium.space);
  std::vector<NodeMemory> memory(nodes.size());
  int touching = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const SurfacePoint point = surface_point(surface, nodes[i].position(cilium.state.displacement));
    if (point.gap > 0) continue;
    memory[i].state = i % 2 == 0 ? NodeState::stick : NodeState::slip;
    memory[i].place = point.place - Eigen::Vector2d(1e-6, 0);
    memory[i].along = {-1, 0};
    ++touching;
  }
  ASSERT_GT(touching, 10);
  dealii::DynamicSparsityPattern pattern(cilium.space->unknowns());
  dealii::DoFTools::make_sparsity_pattern(cilium.space->dof_handler(), pattern);
  dealii::SparsityPattern sparsity;
  sparsity.copy_from(pattern);
  dealii::SparseMatrix<double> matrix(sparsity);
  const ContactLaw law{0.3, 1e3};
  const dealii::AffineConstraints<double> none;
  AssembledTangent tangent(none, matrix);
  const auto forces_at = [&](const Vector& u, TangentMatrix* to) {
    Vector forces(u.size());
    contact_forces(nodes, memory, surface, law)(u, forces, to);
    return forces;
  };
  forces_at(cilium.state.displacement, &tangent);
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  Vector direction(cilium.space->unknowns());
  // Along the travel and upwards: slip must not turn.
  for (const ContactNode& node : nodes) {
    const Vector3 v = uniform(generator) * oblique + uniform(generator) * Vector3::UnitZ();
    for (unsigned int c = 0; c < 3; ++c) direction[node.shares.front().dofs[c]] = v[c];
  }
  const double step = 1e-9;
  Vector u(cilium.state.displacement);
  u.add(step, direction);
  Vector difference = forces_at(u, nullptr);
  u.add(-2 * step, direction);
  difference -= forces_at(u, nullptr);
  difference /= -2 * step;
  Vector product(direction.size());
  matrix.vmult(product, direction);
  EXPECT_GT(product.l2_norm(), 0);
  difference -= product;
  EXPECT_LT(difference.l2_norm(), 1e-6 * product.l2_norm());
}

/// A block of one material whose upper face touches; `supports` as given.
struct Pressed {
  static constexpr double a = 2e-3;
  static constexpr double young_modulus = 1e6;
  Block block{neo_hooke(young_modulus, 0.45), {2, 2, 2}, Vector3(a, a, a)};
  std::unique_ptr<SolidSpace> space;
  std::unique_ptr<ExtrudedQuadrature> quadrature;
  std::unique_ptr<equilibrium::Newton> newton;
  Surface surface;
  std::unique_ptr<Follower> follower;

  Pressed(const Surface& on_top, const std::vector<DirichletCondition>& supports)
      : surface(on_top) {
    for (const auto& cell : block.triangulation.active_cell_iterators())
      for (const unsigned int f : cell->face_indices())
        if (cell->at_boundary(f))
          cell->face(f)->set_boundary_id(f == 5 ? meshes::tip_id
                                                : static_cast<dealii::types::boundary_id>(10 + f));
    space = std::make_unique<SolidSpace>(block.triangulation, block.mapping, block.materials);
    quadrature = std::make_unique<ExtrudedQuadrature>(*space);
    newton = std::make_unique<equilibrium::Newton>(*space, increment_constraints(*space, supports),
                                                   solvers::SolverKind::automatic, MPI_COMM_SELF);
    FollowerOptions options;
    options.young_modulus = young_modulus;
    options.diameter = options.length = a;
    options.tip_stiffness = young_modulus * a;
    const RigidSurface rigid{.profile = &surface, .friction = surface.friction, .height = a};
    follower = std::make_unique<Follower>(*space, *quadrature, *newton, rigid, options);
    follower->start({-1e-6, 0, 0});
  }
};

/// Force on a unit cube of stretch λ with free sides, of W = μ/2 (J^(−2/3) I₁ − 3) + K/2 (J − 1)²:
/// the least energy over the lateral stretch, differentiated.
double uniaxial_stress(double young_modulus, double nu, double stretch) {
  const double mu = young_modulus / (2 * (1 + nu));
  const double K = young_modulus / (3 * (1 - 2 * nu));
  const auto energy = [&](double along, double across) {
    const double J = along * across * across;
    return mu / 2 * (std::pow(J, -2.0 / 3) * (along * along + 2 * across * across) - 3) +
           K / 2 * (J - 1) * (J - 1);
  };
  double low = 0.5;
  double high = 2;
  for (int i = 0; i < 200; ++i) {
    const double middle = (low + high) / 2;
    const double h = 1e-6;
    (energy(stretch, middle + h) < energy(stretch, middle - h) ? low : high) = middle;
  }
  const double h = 1e-6;
  return (energy(stretch + h, low) - energy(stretch - h, low)) / (2 * h);
}

/// A block on a smooth floor under a smooth flat surface is in uniaxial stress.
TEST(Follower, CompressesABlockEvenly) {
  Pressed pressed({FlatProfile{}, 0, 0}, {{.boundary = 10, .components = {true, false, false}},
                                          {.boundary = 12, .components = {false, true, false}},
                                          {.boundary = 14, .components = {false, false, true}}});
  const double a = Pressed::a;
  const FollowerOutcome outcome = pressed.follower->go({0.2 * a, 0, 0});
  ASSERT_TRUE(outcome.converged);
  const ContactState& state = pressed.follower->current();
  const double stress = uniaxial_stress(Pressed::young_modulus, 0.45, 0.8);
  EXPECT_NEAR(state.force.z(), stress * a * a, 1e-6 * std::abs(stress) * a * a);
  EXPECT_NEAR(state.force.x(), 0, 1e-12);
  EXPECT_GE(smallest_gap(pressed.follower->nodes(), pressed.follower->surface_at(state.place),
                         state.solid.displacement),
            -1e-6 * a);
  for (const NodeForce& force : state.forces) EXPECT_GE(force.normal, 0);
  // The surface's work is the energy.
  EXPECT_NEAR(outcome.surface_work, state.energy, 3e-3 * state.energy);
}

/// Ridges that stand between the nodes (0.5 mm apart) are seen, if not felt.
TEST(Follower, TellsThePenetrationBetweenTheNodes) {
  const std::vector<DirichletCondition> clamped{{.boundary = 14}};
  Pressed flat({FlatProfile{}, 0.3, 0}, clamped);
  ASSERT_TRUE(flat.follower->go({0.02e-3, 0, 0}).converged);
  EXPECT_LT(flat.follower->penetration(), 1e-6 * Pressed::a);
  Pressed ridges({SineProfile{0.05e-3, 0.5e-3}, 0.3, 0}, clamped);
  ASSERT_TRUE(ridges.follower->go({0.02e-3, 0, 0}).converged);
  EXPECT_NEAR(ridges.follower->penetration(), 0.05e-3, 0.005e-3);
}

/// NAFEMS CGS-4: a block on a slope slides at F/G = (tan α + μ)/(1 − μ tan α). The surface moves
/// along its slope until all nodes have slid far enough to pull that way.
TEST(Follower, SlidesOnASlopeWithCoulombsFriction) {
  Pressed pressed({FlatProfile{}, 0.3, -std::atan(0.1)}, {{.boundary = 14}});
  const auto ratio = [&pressed] {
    const Vector3& force = pressed.follower->current().force;
    return force.x() / -force.z();
  };
  ASSERT_TRUE(pressed.follower->go({0.25e-3, 0, 0}).converged);
  EXPECT_LT(ratio(), 0.3);
  ASSERT_TRUE(pressed.follower->go({0.05e-3, 2e-3, 0}).converged);
  for (const NodeForce& force : pressed.follower->current().forces)
    EXPECT_TRUE(force.normal == 0 || force.slides);
  EXPECT_NEAR(ratio(), 0.412371, 0.412371e-3);
}

}  // namespace
}  // namespace ciliaval::fem::solid::contact
