// SPDX-License-Identifier: LGPL-2.1-or-later
// The beam beside given magnets. Oracles: differences, the inextensible limit, in which the laws F
// (two poles) and R (a couple and a force along the magnet) are one, and the force on the poles by
// analytic/forces, which shares no code with the beam.
#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "analytic/forces/wrench.h"
#include "beams.h"
#include "fem/beam/beam.h"
#include "fem/beam/kinematics.h"
#include "fem/beam/system.h"
#include "problem/error.h"
#include "problem/lagrange.h"

namespace ciliaval::fem::beam {
namespace {

using beams::measured;
using Eigen::Index;
using surroundings::Environment;
using surroundings::MagneticEnergy;
using surroundings::magnets::jet;
using surroundings::magnets::Magnet;
using surroundings::magnets::Shape;

/// Sixth-order central difference.
template <class Function>
auto derivative(const Function& f, double step = 1e-2) {
  using Value = decltype(f(step));
  const Value first = f(step) - f(-step);
  const Value second = f(2 * step) - f(-2 * step);
  const Value third = f(3 * step) - f(-3 * step);
  return Value((45.0 * first - 9.0 * second + third) / (60 * step));
}

Vector3 random_vector(std::mt19937& engine) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  return {uniform(engine), uniform(engine), uniform(engine)};
}

/// A beam of three elements in a state that solves nothing, beside a cuboid and a cylinder.
struct Scene {
  System system;
  State state;
  Loads loads;
};

Scene scene(MagneticEnergy law) {
  std::mt19937 engine(7);
  Mesh mesh = beams::uniform_mesh(2, 3, 3, beams::isotropic(1, 0.8, 40, 20));
  mesh.velocities = {0, 1, 0, 0};
  Scene s{System(straight_curve, mesh, {{0}}), {}, {}};
  s.state = s.system.reference_state();
  for (Vector3& r : s.state.position) r += 0.2 * random_vector(engine);
  for (Quaternion& q : s.state.rotation) q = exponential(0.4 * random_vector(engine)) * q;
  for (Vector3& n : s.state.force) n = random_vector(engine);
  for (Vector3& m : s.state.moment) m = random_vector(engine);
  s.loads.magnetic_energy = law;
  s.loads.magnetic_charge = {2, 2, -3};
  s.loads.magnetic_force.assign(3, Vector3(0.3, -0.2, 0.5));
  s.loads.transverse_force.assign(3, Matrix32{{0.2, -0.4}, {0.1, 0.3}, {-0.5, 0.2}});
  s.loads.transverse_charge = {{0.5, -1}, {0.5, 1}, {-1, 0.3}};
  const Quaternion turn(Eigen::AngleAxisd(0.7, Vector3(1, 2, 3).normalized()));
  s.loads.magnets = {{"a", Shape::cuboid, {3, 1, 1}, turn, 0, 0, {1, 2, 1.5}, {2e6, -1e6, 4e6}},
                     {"b", Shape::cylinder, {-2, -1, 2}, turn, 1, 1.5, {0, 0, 0}, {0, 0, 6e6}}};
  return s;
}

State moved(const System& system, const State& state, Index i, double step) {
  State other = state;
  Eigen::VectorXd increment = Eigen::VectorXd::Zero(static_cast<Index>(system.n_unknowns()));
  increment[i] = step;
  system.update(other, increment);
  return other;
}

/// −∫ M A B·dr along the interpolated centreline, J: what two poles are by the law F.
double line_energy(const Scene& s, const State& state) {
  const QuadratureRule rule = gauss_legendre(40, 0, 1);
  const LagrangeBasis basis(s.system.reference_element().nodes);
  double energy = 0;
  for (std::size_t e = 0; e < 3; ++e)
    for (std::size_t g = 0; g < rule.nodes.size(); ++g) {
      const LagrangeValues N(basis, rule.nodes[g]);
      Vector3 r = Vector3::Zero();
      Vector3 t = Vector3::Zero();
      for (std::size_t a = 0; a < basis.size(); ++a) {
        r += N.value[a] * state.position[3 * e + a];
        t += N.derivative[a] * state.position[3 * e + a];
      }
      energy -= rule.weights[g] * s.loads.magnetic_charge[e] * t.dot(jet(s.loads.magnets, r).B);
    }
  return energy;
}

// Measured 3e-13 on entries of order one; margin 10.
TEST(BeamMagnets, ResidualIsTheGradientOfTheEnergy) {
  for (const auto law : {MagneticEnergy::F, MagneticEnergy::R}) {
    const Scene s = scene(law);
    const Eigen::VectorXd residual = s.system.residual(s.state, s.loads);
    const double scale = s.system.force_scale() * s.system.length_scale();
    double error = 0;
    for (Index i = 0; i < residual.size(); ++i) {
      const auto energy = [&](double step) {
        const State state = moved(s.system, s.state, i, step);
        const double poles = law == MagneticEnergy::F ? line_energy(s, state) : 0;
        return (s.system.potential_energy(state, s.loads) + poles) / scale;
      };
      error = std::max(error, std::abs(derivative(energy, 4e-3) - residual[i]));
    }
    EXPECT_LT(measured("gradient", error), 3e-12);
    Loads without = s.loads;
    without.magnets.clear();
    EXPECT_GT((residual - s.system.residual(s.state, without)).norm(), 0.1);
  }
}

// Measured 2e-12 on entries of order one; margin 12.
TEST(BeamMagnets, TangentIsTheDerivativeOfTheResidual) {
  for (const auto law : {MagneticEnergy::F, MagneticEnergy::R}) {
    const Scene s = scene(law);
    const Eigen::MatrixXd tangent = s.system.tangent(s.state, s.loads);
    double error = 0;
    for (Index i = 0; i < tangent.cols(); ++i) {
      const auto residual = [&](double step) {
        return s.system.residual(moved(s.system, s.state, i, step), s.loads);
      };
      error =
          std::max(error, (derivative(residual, 4e-3) - tangent.col(i)).lpNorm<Eigen::Infinity>());
    }
    EXPECT_LT(measured("tangent", error), 2e-11);
    const auto shifted = [&](double step) {
      State state = s.state;
      state.shift += step * s.system.length_scale();
      return s.system.residual(state, s.loads);
    };
    EXPECT_LT(measured("shift", (derivative(shifted) - s.system.shift_derivative(s.state, s.loads))
                                    .lpNorm<Eigen::Infinity>()),
              1e-12);
  }
}

TEST(BeamMagnets, AreSuperposedOnThePath) {
  const Scene s = scene(MagneticEnergy::F);
  Loads other = s.loads;
  other.magnets[0].position.x() += 1;
  const Loads sum = combine(0.25, s.loads, 0.75, other);
  EXPECT_EQ(sum.magnets.size(), 3);
  const Vector3 x(0.1, 0.2, 1);
  EXPECT_LT(
      (jet(sum.magnets, x).B - (0.25 * jet(s.loads.magnets, x).B + 0.75 * jet(other.magnets, x).B))
          .norm(),
      1e-15);
  EXPECT_EQ(combine(0.25, s.loads, 0.75, s.loads).magnets, s.loads.magnets);
  EXPECT_EQ(combine(1, s.loads, 0, other).magnets, s.loads.magnets);
}

Cilium cilium() {
  Segment base{"base", 3e-3, 0.1e6, 0.49, 0};
  base.density = 1000;
  Segment magnet{"magnet", 17e-3, 3e6, 0.49, 75e3};
  magnet.density = 1700;
  return {3e-3, {base, magnet}};
}

Environment beside(MagneticEnergy law) {
  Environment environment;
  environment.magnetic_energy = law;
  environment.magnets = {{"cuboid",
                          Shape::cuboid,
                          {12e-3, 2e-3, 26e-3},
                          Quaternion(Eigen::AngleAxisd(0.4, Vector3(1, 2, 0.5).normalized())),
                          0,
                          0,
                          {6e-3, 4e-3, 5e-3},
                          {6e5, 0, -6e5}}};
  return environment;
}

MechanicsStep solved(const Load& load, const BeamOptions& options) {
  const MechanicsStep step = Beam(options).solve(cilium(), {load}).steps.at(0);
  EXPECT_EQ(step.status, Status::converged) << type(load) << ": " << step.message;
  return step;
}

// Oracle: the other law. Without shear and extension ∂r/∂S = d₃, so that the energies are one; the
// law F has them in two points, the law R along the magnet. Measured 4e-12 of the length, 2e-12 of
// a force of 1 mN; margin 10.
TEST(BeamMagnets, BothLawsAreOneWithoutShearUnderEveryLoad) {
  for (const Load& load : std::vector<Load>{EnvironmentLoad{1, 0}, ContactLoad{1e-3, 16e-3, 0},
                                            FlowLoad{0.3, 0.2}, SectionLoad{2e-3, 10e-3, 0},
                                            DeadLoad{0.2, 0}, ProbeLoad{5e-3, 16e-3, 0}}) {
    const BeamOptions options{.refinement = 2, .shear_rigid = true};
    const MechanicsStep a = solved(with_environment(load, beside(MagneticEnergy::F)), options);
    const MechanicsStep b = solved(with_environment(load, beside(MagneticEnergy::R)), options);
    if (!a.deformation || !b.deformation) continue;
    const Vector3 one = a.deformation->centreline.at(20e-3).position;
    const Vector3 other = b.deformation->centreline.at(20e-3).position;
    EXPECT_LT(measured("tip", (one - other).norm() / 20e-3), 5e-11) << type(load);
    EXPECT_LT(measured("force", std::abs(a.applied_force - b.applied_force) / 1e-3), 3e-11);
    if (load.is<EnvironmentLoad>()) {
      EXPECT_GT((one - Vector3(0, 0, 20e-3)).norm(), 1e-3);
      EXPECT_LT(std::abs(a.applied_force), 1e-12);
    }
  }
}

// Oracle: the force and torque on the poles of the bent line, and statics. Measured 6e-14;
// margin 15.
TEST(BeamMagnets, TheBaseBearsTheForceOnThePoles) {
  const Environment environment = beside(MagneticEnergy::F);
  const MechanicsStep step =
      solved(with_environment(EnvironmentLoad{1, 0}, environment), {.refinement = 2});
  const analytic::rod::RodMagnet rod = analytic::rod::rod_magnet(cilium(), *step.deformation);
  const analytic::forces::Wrench wrench = analytic::forces::wrench(
      analytic::forces::poles_of(rod),
      [&](std::span<const Vector3> points) {
        std::vector<Vector3> B;
        for (const Vector3& x : points) B.push_back(jet(environment.magnets, x).B);
        return B;
      },
      Vector3::Zero());
  const SectionForces base = step.deformation->centreline.at(0, 0).forces;
  EXPECT_LT(measured("force", (base.force - wrench.force).norm() / wrench.force.norm()), 1e-12);
  EXPECT_LT(measured("moment", (base.moment - wrench.torque).norm() / wrench.torque.norm()), 1e-12);
}

TEST(BeamMagnets, RefusesAMagnetThatTouches) {
  Environment environment = beside(MagneticEnergy::F);
  environment.magnets[0].position = {3e-3, 0, 18e-3};
  EXPECT_THROW(Beam().solve(cilium(), {with_environment(EnvironmentLoad{1, 0}, environment)}),
               InputError);
  // A force pushes the cilium into a magnet that is too weak to pull it in.
  environment.magnets[0].position = {7e-3, 0, 20e-3};
  environment.magnets[0].rotation = Quaternion::Identity();
  environment.magnets[0].magnetization = {1, 0, 0};
  const auto beside_it = [&](const Load& load) {
    return Beam().solve(cilium(), {with_environment(load, environment)}).steps.at(0);
  };
  const MechanicsStep pushed = beside_it(SectionLoad{1.2e-3, 20e-3, 0});
  EXPECT_EQ(pushed.status, Status::failed);
  EXPECT_NE(pushed.message.find("touches the magnet"), std::string::npos) << pushed.message;
  // The south pole of a strong magnet draws the tip to itself.
  environment.magnets[0].magnetization = {1e6, 0, 0};
  const MechanicsStep drawn = beside_it(EnvironmentLoad{1, 0});
  EXPECT_EQ(drawn.status, Status::pulled_in);
  EXPECT_NE(drawn.message.find("magnet"), std::string::npos) << drawn.message;
}

}  // namespace
}  // namespace ciliaval::fem::beam
