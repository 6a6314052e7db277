// SPDX-License-Identifier: LGPL-2.1-or-later
// Objectivity, path independence and the behaviour of Newton's method.
#include <gtest/gtest.h>

#include <cmath>

#include "beams.h"
#include "fem/beam/kinematics.h"

namespace {

using namespace beams;
using namespace ciliaval::fem::beam;
using ciliaval::Quaternion;
using ciliaval::Vector3;

const Quaternion Q = Quaternion(0.2, 0.8, -0.5, 0.4).normalized();

Mesh mesh() {
  return uniform_mesh(2, 4, 4,
                      section({.EA = 400, .kGA1 = 90, .kGA2 = 120, .GJ = 0.8, .EI1 = 1, .EI2 = 2}));
}

System turned_system(const Quaternion& rotation) {
  return System(
      [rotation](double S) {
        const Pose pose = arc(1.5, S);
        return Pose{rotation * pose.position, rotation * pose.rotation};
      },
      mesh(), {{0}});
}

Loads turned_loads(const Quaternion& rotation) {
  Loads loads = end_load(4, rotation * Vector3(0.6, 1.1, -0.9), rotation * Vector3(0.2, -0.1, 0.3));
  loads.force_per_length.assign(4, rotation * Vector3(-0.2, 0.3, 0.1));
  return loads;
}

State solve(System& system, const Loads& from, const Loads& to, State state) {
  const PathReport report = advance(system, state, from, to, {});
  EXPECT_TRUE(report.converged) << report.message;
  return state;
}

double distance(const State& a, const State& b, const Quaternion& turn = Quaternion::Identity()) {
  double distance = 0;
  for (std::size_t j = 0; j < a.position.size(); ++j) {
    distance = std::max(distance, (turn * a.position[j] - b.position[j]).norm());
    distance = std::max(distance, (turn * a.rotation[j]).angularDistance(b.rotation[j]));
  }
  for (std::size_t k = 0; k < a.force.size(); ++k) {
    distance = std::max(distance, (a.force[k] - b.force[k]).norm());
    distance = std::max(distance, (a.moment[k] - b.moment[k]).norm());
  }
  return distance;
}

TEST(BeamObjectivity, SuperposedRotationLeavesTheStrainsAlone) {
  // Oracle: frame indifference. The energy, and the strain equations in material components, do not
  // change; the internal forces turn with the beam.
  System system = turned_system(Quaternion::Identity());
  const State state =
      solve(system, {}, turned_loads(Quaternion::Identity()), system.reference_state());
  State turned = state;
  for (Vector3& r : turned.position) r = Q * r;
  for (Quaternion& q : turned.rotation) q = Q * q;
  const double energy = system.potential_energy(state, {});
  EXPECT_LT(measured("energy", std::abs(system.potential_energy(turned, {}) / energy - 1)), 1e-12);
  const Eigen::VectorXd R = system.residual(state, {});
  const Eigen::VectorXd Rt = system.residual(turned, {});
  double error = 0;
  for (std::size_t j = 0; j < state.position.size(); ++j) {
    for (const std::size_t first : {0U, 3U}) {
      Vector3 a;
      Vector3 b;
      for (std::size_t c = 0; c < 3; ++c) {
        a[static_cast<Eigen::Index>(c)] =
            R[static_cast<Eigen::Index>(system.node_unknown(j, first + c))];
        b[static_cast<Eigen::Index>(c)] =
            Rt[static_cast<Eigen::Index>(system.node_unknown(j, first + c))];
      }
      error = std::max(error, (Q * a - b).norm());
    }
  }
  for (std::size_t k = 0; k < state.force.size(); ++k)
    for (std::size_t c = 0; c < 6; ++c)
      error = std::max(error, std::abs(R[static_cast<Eigen::Index>(system.point_unknown(k, c))] -
                                       Rt[static_cast<Eigen::Index>(system.point_unknown(k, c))]));
  EXPECT_LT(measured("residual", error), 1e-13);
}

TEST(BeamObjectivity, TheRotatedProblemHasTheRotatedSolution) {
  System system = turned_system(Quaternion::Identity());
  System turned = turned_system(Q);
  const State a = solve(system, {}, turned_loads(Quaternion::Identity()), system.reference_state());
  const State b = solve(turned, {}, turned_loads(Q), turned.reference_state());
  EXPECT_LT(measured("error", distance(a, b, Q)), 1e-10);
}

TEST(BeamPath, DoesNotMatter) {
  // Oracle: the loads are conservative, so the equilibrium knows its loads alone: in one go, in
  // twenty steps, x before y, y before x.
  System system(straight_curve, mesh(), {{0}});
  const Loads x = end_load(4, {1.2, 0, 0}, Vector3::Zero());
  const Loads y = end_load(4, {0, 0.9, -0.3}, Vector3::Zero());
  const Loads both = combine(1, x, 1, y);
  const State start = system.reference_state();
  const State direct = solve(system, {}, both, start);
  const State x_first = solve(system, x, both, solve(system, {}, x, start));
  const State y_first = solve(system, y, both, solve(system, {}, y, start));
  State small = start;
  for (int i = 0; i < 20; ++i)
    small =
        solve(system, combine(i / 20.0, both, 0, {}), combine((i + 1) / 20.0, both, 0, {}), small);
  EXPECT_LT(measured("x_first", distance(direct, x_first)), 1e-10);
  EXPECT_LT(measured("y_first", distance(direct, y_first)), 1e-10);
  EXPECT_LT(measured("small_steps", distance(direct, small)), 1e-10);
}

TEST(BeamPath, ALoadCycleEndsWhereItBegan) {
  System system(straight_curve, mesh(), {{0}});
  const Loads x = end_load(4, {1.2, 0, 0}, Vector3::Zero());
  const Loads xy = end_load(4, {1.2, 0.9, -0.3}, {0.1, 0.2, 0.5});
  const Loads y = end_load(4, {0, 0.9, -0.3}, Vector3::Zero());
  const State start = system.reference_state();
  State state = solve(system, {}, x, start);
  state = solve(system, x, xy, state);
  state = solve(system, xy, y, state);
  state = solve(system, y, {}, state);
  EXPECT_LT(measured("error", distance(start, state)), 1e-10);
}

TEST(BeamNewton, ConvergesQuadratically) {
  // Exponent log(e₃/e₂)/log(e₂/e₁) of the last increments above rounding error. Conservative,
  // height-dependent and bordered tangents.
  const auto exponent = [](const NewtonReport& report) {
    std::vector<double> e;
    for (const double increment : report.increments)
      if (increment > 1e-13) e.push_back(increment);
    const std::size_t n = e.size();
    EXPECT_GE(n, 3U);
    return std::log(e[n - 1] / e[n - 2]) / std::log(e[n - 2] / e[n - 3]);
  };
  System system(straight_curve, mesh(), {{0}});
  State state = system.reference_state();
  const NewtonReport dead =
      newton(system, state, end_load(4, {0.35, 0.25, 0.05}, Vector3::Zero()), {});
  ASSERT_TRUE(dead.converged) << dead.reason;
  EXPECT_GT(measured("dead", exponent(dead)), 1.7);

  state = system.reference_state();
  Loads flow;
  flow.force_per_height = {0.3, 0.2, 0};
  const NewtonReport height = newton(system, state, flow, {});
  ASSERT_TRUE(height.converged) << height.reason;
  EXPECT_GT(measured("flow", exponent(height)), 1.7);

  Mesh moving = mesh();
  moving.velocities = {0, 0, 0, 1, 0};
  System contact(straight_curve, moving, {{0}});
  state = contact.reference_state();
  const Loads push = end_load(3, {0.5, 0, 0}, Vector3::Zero());
  const Condition height_of_contact = at_height(3, 1.45, Condition::Unknown::shift);
  const NewtonReport border = newton(contact, state, push, {}, std::array{height_of_contact});
  ASSERT_TRUE(border.converged) << border.reason;
  EXPECT_GT(measured("contact", exponent(border)), 1.7);

  state = contact.reference_state();
  const Condition aside = at_place(3, Vector3::UnitX(), 0.5, Condition::Unknown::load_factor);
  const NewtonReport probe = newton(contact, state, push, {}, std::array{height_of_contact, aside});
  ASSERT_TRUE(probe.converged) << probe.reason;
  EXPECT_GT(measured("probe", exponent(probe)), 1.7);
}

TEST(BeamNewton, CutsTheLoadStepBackAndGoesOn) {
  // A load far too large for one step: Newton alone fails, the load path arrives.
  System system(straight_curve, mesh(), {{0}});
  const Loads loads = end_load(4, {0, 0, 0}, {0, 4 * pi, 0});
  State state = system.reference_state();
  EXPECT_FALSE(newton(system, state, loads, {}).converged);
  EXPECT_EQ(distance(state, system.reference_state()), 0) << "a failed attempt leaves no trace";
  const PathReport report = advance(system, state, {}, loads, {});
  EXPECT_TRUE(report.converged) << report.message;
  EXPECT_GT(report.cutbacks, 0);
}

TEST(BeamNewton, SaysWhereItFailed) {
  System system(straight_curve, mesh(), {{0}});
  const Loads loads = end_load(4, {0, 0, 0}, {0, 4 * pi, 0});
  State state = system.reference_state();
  const PathReport report = advance(system, state, {}, loads,
                                    {.tolerance = 1e-12, .max_iterations = 5, .max_cutbacks = 0});
  EXPECT_FALSE(report.converged);
  EXPECT_NE(report.message.find("residuals"), std::string::npos);
  EXPECT_NE(report.message.find("last converged at the fraction 0"), std::string::npos);
}

}  // namespace
