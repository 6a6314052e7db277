// SPDX-License-Identifier: LGPL-2.1-or-later
// The hand-derived formulae against differences of what they are derivatives of, at a random state
// far from equilibrium.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <random>

#include "beams.h"
#include "fem/beam/kinematics.h"

namespace {

using namespace beams;
using namespace ciliaval::fem::beam;
using ciliaval::Quaternion;
using ciliaval::Vector3;
using ciliaval::surroundings::MagneticEnergy;
using Eigen::Index;

/// Sixth-order central difference: with steps of 1e-2 and derivatives of order one, 1e-12.
template <class Function>
auto derivative(const Function& f, double step = 1e-2) {
  using Value = decltype(f(step));  // a number or a vector, never an expression of temporaries
  const Value first = f(step) - f(-step);
  const Value second = f(2 * step) - f(-2 * step);
  const Value third = f(3 * step) - f(-3 * step);
  return Value((45.0 * first - 9.0 * second + third) / (60 * step));
}

Vector3 random_vector(std::mt19937& engine) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  return {uniform(engine), uniform(engine), uniform(engine)};
}

/// A beam of three elements, curved or with a joint between two, in a state that solves nothing.
struct Scene {
  System system;
  State state;
  Loads conservative;
  Loads height;
};

/// Straight, with a joint for its second element.
System jointed(const Section& law) {
  Mesh mesh = uniform_mesh(2, 3, 3, law);
  mesh.vertices = {0, 0.8, 0.8, 2};
  mesh.sections[1] = joint_section({.rotation = -0.3,
                                    .coupling = -0.2,
                                    .displacement = -0.1,
                                    .extension = 0.05,
                                    .beyond = {0.07, -0.04, 0.02}});
  return {straight_curve, mesh, {{0}}};
}

Scene scene(bool has_joint = false) {
  std::mt19937 engine(7);
  Section law = section({.EA = 40, .kGA1 = 20, .kGA2 = 30, .GJ = 0.8, .EI1 = 1, .EI2 = 2});
  law.beyond = {0.05, 0.3, 0.1};
  Scene s{has_joint
              ? jointed(law)
              : System([](double S) { return arc(1.5, S); }, uniform_mesh(2, 3, 3, law), {{0}}),
          {},
          {},
          {}};
  s.state = s.system.reference_state();
  for (Vector3& r : s.state.position) r += 0.2 * random_vector(engine);
  for (Quaternion& q : s.state.rotation) q = exponential(0.4 * random_vector(engine)) * q;
  for (Vector3& n : s.state.force) n = random_vector(engine);
  for (Vector3& m : s.state.moment) m = random_vector(engine);
  s.conservative = end_load(3, random_vector(engine), Vector3::Zero());
  for (int e = 0; e < 3; ++e) s.conservative.force_per_length.push_back(random_vector(engine));
  s.height.force_per_height = random_vector(engine);
  return s;
}

State moved(const System& system, const State& state, Index i, double step) {
  State other = state;
  Eigen::VectorXd increment = Eigen::VectorXd::Zero(static_cast<Index>(system.n_unknowns()));
  increment[i] = step;
  system.update(other, increment);
  return other;
}

TEST(BeamDerivatives, StrainsAreThoseOfTheRotation) {
  // Oracle: Λ as a matrix; γ = Λᵀ t and [κ]× = Λᵀ dΛ/dξ, the latter by differences along p + ξ s.
  std::mt19937 engine(3);
  const Vector4 p(0.3, -0.4, 0.9, 0.5);
  const Vector4 s(0.7, 0.2, -0.6, 0.3);
  const Vector3 t = random_vector(engine);
  const auto rotation = [&](double xi) {
    Quaternion q;
    q.coeffs() = (p + xi * s).normalized();
    return Eigen::VectorXd(q.toRotationMatrix().reshaped());
  };
  const Eigen::Matrix3d Lambda = rotation(0).reshaped(3, 3);
  const Eigen::Matrix3d W = Lambda.transpose() * derivative(rotation, 1e-3).reshaped(3, 3);
  const Strain e = strain(p, s, t);
  EXPECT_LT((e.gamma - Lambda.transpose() * t).norm(), 1e-15);
  EXPECT_LT((e.kappa - Vector3(W(2, 1), W(0, 2), W(1, 0))).norm(), 1e-11);
}

/// The loads with the field's energy by a law.
Loads in_field(Loads loads, std::size_t elements, MagneticEnergy law) {
  std::mt19937 engine(11);
  for (std::size_t e = 0; e < elements; ++e) loads.magnetic_force.push_back(random_vector(engine));
  loads.magnetic_energy = law;
  return loads;
}

/// Largest difference of the residual from the gradient of the energy, without units.
double gradient_error(const Scene& s, const Loads& loads) {
  const Eigen::VectorXd residual = s.system.residual(s.state, loads);
  const double scale = s.system.force_scale() * s.system.length_scale();
  double error = 0;
  for (Index i = 0; i < residual.size(); ++i) {
    const auto energy = [&](double step) {
      return s.system.potential_energy(moved(s.system, s.state, i, step), loads) / scale;
    };
    error = std::max(error, std::abs(derivative(energy) - residual[i]));
  }
  return error;
}

TEST(BeamDerivatives, ResidualIsTheGradientOfTheEnergy) {
  // Measured 2e-12 on entries of order one.
  for (const bool has_joint : {false, true}) {
    const Scene s = scene(has_joint);
    EXPECT_LT(measured("dead", gradient_error(s, s.conservative)), 2e-11);
    for (const auto law : {MagneticEnergy::F, MagneticEnergy::R})
      EXPECT_LT(measured("field", gradient_error(s, in_field(s.conservative, 3, law))), 2e-11);
  }
}

double tangent_error(const Scene& s, const Loads& loads) {
  const Eigen::MatrixXd tangent = s.system.tangent(s.state, loads);
  double error = 0;
  for (Index i = 0; i < tangent.cols(); ++i) {
    const auto residual = [&](double step) {
      return s.system.residual(moved(s.system, s.state, i, step), loads);
    };
    error = std::max(error, (derivative(residual) - tangent.col(i)).lpNorm<Eigen::Infinity>());
  }
  return error;
}

TEST(BeamDerivatives, TangentIsTheDerivativeOfTheResidual) {
  for (const bool has_joint : {false, true}) {
    const Scene s = scene(has_joint);
    EXPECT_LT(measured("conservative", tangent_error(s, s.conservative)), 2e-11);
    EXPECT_LT(measured("flow", tangent_error(s, s.height)), 2e-11);
    for (const auto law : {MagneticEnergy::F, MagneticEnergy::R})
      EXPECT_LT(measured("field", tangent_error(s, in_field(s.conservative, 3, law))), 2e-11);
  }
}

// Oracle: Eigen's dense LU of the rows and columns that no support holds. One element, whose band
// is the whole matrix, one of length zero, the degrees of contact and default, each kind of
// support.
TEST(BeamDerivatives, FactorsAreThoseOfTheTangent) {
  const Section law = section({.EA = 40, .kGA1 = 20, .kGA2 = 30, .GJ = 0.8, .EI1 = 1, .EI2 = 2});
  const std::vector<std::vector<Support>> fixtures{
      {{0}}, {{0}, {3}}, {{0, true, false}, {3, true, true}}};
  for (const unsigned int degree : {1U, 2U, 6U}) {
    for (const std::vector<double>& vertices :
         {std::vector<double>{0, 2}, std::vector<double>{0, 0.5, 0.5, 2}}) {
      for (std::vector<Support> supports : fixtures) {
        Mesh mesh;
        mesh.degree = degree;
        mesh.vertices = vertices;
        mesh.sections.assign(vertices.size() - 1, law);
        for (Support& support : supports)
          support.vertex = std::min(support.vertex, mesh.n_elements());
        System system(straight_curve, mesh, supports);
        std::mt19937 engine(7);
        State state = system.reference_state();
        for (Vector3& r : state.position) r += 0.02 * random_vector(engine);
        for (Quaternion& q : state.rotation) q = exponential(0.1 * random_vector(engine)) * q;
        const Loads loads = end_load(mesh.n_elements(), Vector3(1, 2, 3), Vector3(3, 1, 2));
        Eigen::MatrixXd K = system.tangent(state, loads);
        Eigen::VectorXd R = system.residual(state, loads);
        system.factorize(state, loads);
        const Eigen::VectorXd solution = system.solve(R);
        for (Index i = 0; i < K.rows(); ++i) {
          if (!system.supported()[static_cast<std::size_t>(i)]) continue;
          K.row(i).setZero();
          K.col(i).setZero();
          K(i, i) = 1;
          R[i] = 0;
        }
        const Eigen::VectorXd exact = K.fullPivLu().solve(R);
        EXPECT_LT(measured("solution", (solution - exact).norm() / exact.norm()), 1e-11)
            << degree << " " << vertices.size() << " " << supports.size();
      }
    }
  }
}

TEST(BeamDerivatives, TangentIsSymmetricButForTheMomentsOutOfBalance) {
  // Off equilibrium the derivative by spins has the skew part ½ ε_ijk R_k at each node and no
  // other; with a load per height it has more.
  const Scene s = scene();
  const Eigen::VectorXd R = s.system.residual(s.state, s.conservative);
  Eigen::MatrixXd K = s.system.tangent(s.state, s.conservative);
  for (std::size_t j = 0; j < s.state.position.size(); ++j) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto a = static_cast<Index>(s.system.node_unknown(j, 3 + (k + 1) % 3));
      const auto b = static_cast<Index>(s.system.node_unknown(j, 3 + (k + 2) % 3));
      const double moment = R[static_cast<Index>(s.system.node_unknown(j, 3 + k))];
      K(a, b) -= moment / 2;
      K(b, a) += moment / 2;
    }
  }
  EXPECT_LT(measured("skew", (K - K.transpose()).lpNorm<Eigen::Infinity>()), 1e-13);
  const Eigen::MatrixXd flow = s.system.tangent(s.state, s.height);
  EXPECT_GT((flow - flow.transpose()).lpNorm<Eigen::Infinity>(), 0.05);
}

TEST(BeamDerivatives, TangentIsSymmetricInEquilibrium) {
  Scene s = scene();
  s.state = s.system.reference_state();
  const PathReport report = advance(s.system, s.state, {}, s.conservative, {});
  ASSERT_TRUE(report.converged) << report.message;
  Eigen::MatrixXd K = s.system.tangent(s.state, s.conservative);
  // The supports' rows hold reactions, so their moments are out of balance.
  for (std::size_t i = 0; i < s.system.n_unknowns(); ++i)
    if (s.system.supported()[i]) K.row(static_cast<Index>(i)).setZero();
  for (std::size_t i = 0; i < s.system.n_unknowns(); ++i)
    if (s.system.supported()[i]) K.col(static_cast<Index>(i)).setZero();
  EXPECT_LT(measured("skew", (K - K.transpose()).lpNorm<Eigen::Infinity>()), 1e-12);
}

class MovingVertex : public testing::TestWithParam<MagneticEnergy> {};

TEST_P(MovingVertex, AndLoadFactor) {
  // A straight beam whose vertex 1 moves between vertices 0 and 2: the columns that border the
  // tangent in the contact and slip-off problems, for a conservative and a distributed load, and a
  // field.
  Mesh mesh = uniform_mesh(2, 3, 3, isotropic(1, 0.8, 40, 20));
  mesh.velocities = {0, 1, 0, 0};
  Scene s{System(straight_curve, mesh, {{0}}), {}, {}, {}};
  const Scene other = scene();
  s.state = other.state;
  const Loads loads = in_field(combine(1, other.conservative, 1, other.height), 3, GetParam());
  const double L = s.system.length_scale();
  const auto shifted = [&](double step) {
    State state = s.state;
    state.shift += step * L;
    return s.system.residual(state, loads);
  };
  const Eigen::VectorXd exact = s.system.shift_derivative(s.state, loads);
  EXPECT_GT(exact.norm(), 0.1);
  EXPECT_LT(measured("shift", (derivative(shifted) - exact).lpNorm<Eigen::Infinity>()), 2e-12);
  const auto factored = [&](double step) {
    State state = s.state;
    state.load_factor += step;
    return s.system.residual(state, loads);
  };
  EXPECT_LT(
      measured(
          "factor",
          (derivative(factored) - s.system.point_load_derivative(loads)).lpNorm<Eigen::Infinity>()),
      2e-12);
}

INSTANTIATE_TEST_SUITE_P(BeamDerivatives, MovingVertex,
                         testing::Values(MagneticEnergy::F, MagneticEnergy::R));

}  // namespace
