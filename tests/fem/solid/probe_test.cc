// SPDX-License-Identifier: LGPL-2.1-or-later
// Displacement control of the contact point.
#include "fem/solid/loads/probe.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "fem/solid/solid.h"
#include "problem/error.h"
#include "tests/fem/solid/cilia.h"

namespace ciliaval::fem::solid {
using namespace material;
using namespace discretisation;
using namespace loads;
using namespace equilibrium;
using namespace solvers;
namespace {

constexpr double width = 0.5e-3;

/// Gives each node the displacement that belongs to its place X.
template <typename Field>
Vector displaced(const BentCilium& cilium, const Field& field) {
  std::vector<dealii::Point<3>> support(cilium.space->unknowns());
  dealii::DoFTools::map_dofs_to_support_points<3, 3>(*cilium.mapping, cilium.space->dof_handler(),
                                                     support);
  Vector u(cilium.space->unknowns());
  for (const SolidElement& element : cilium.space->elements())
    for (std::size_t a = 0; a < element_nodes; ++a) {
      const auto X = support[element.dofs[a]];
      const Vector3 value = field(Vector3(X[0], X[1], X[2]));
      for (std::size_t c = 0; c < 3; ++c)
        u[element.dofs[c * element_nodes + a]] = value[static_cast<Eigen::Index>(c)];
    }
  return u;
}

double mean(const BentCilium& cilium, const Vector& u, double height, const Vector3& e,
            Vector* gradient = nullptr) {
  return mean_displacement(*cilium.space, *cilium.quadrature, contact_density(1, 1, height, width),
                           e, u, gradient);
}

// Oracle: a cilium that is tilted rigidly by θ about its foot has its axis at h tan θ at the height
// h; the other lines are X (1/cos θ − 1) off, which cancels. Measured: 5e-16 of the height.
TEST(ProbeMean, OfATiltedCiliumIsThatOfItsAxis) {
  const BentCilium cilium;
  const double theta = 0.3;
  const double azimuth = 0.4;
  const Vector3 e(std::cos(azimuth), std::sin(azimuth), 0);
  const Matrix3 rotation =
      Eigen::AngleAxisd(theta, Vector3::UnitZ().cross(e).normalized()).toRotationMatrix();
  const auto u = displaced(cilium, [&](const Vector3& X) -> Vector3 { return rotation * X - X; });
  const double h = 5.3e-3;
  EXPECT_NEAR(mean(cilium, u, h, e) / (h * std::tan(theta)), 1, 1e-13);
}

// Oracle: for x = X + c z²/2 at constant heights the kernel's second moment, w² (1/3 − 2/π²), by
// hand.
TEST(ProbeMean, AddsTheKernelsSecondMomentToACurve) {
  const BentCilium cilium;
  const double c = 30;
  const auto u = displaced(cilium, [&](const Vector3& X) -> Vector3 {
    return c * X.z() * X.z() / 2 * Vector3::UnitX();
  });
  const double h = 5.3e-3;
  const double moment = width * width * (1.0 / 3 - 2 / (std::numbers::pi * std::numbers::pi));
  const double at_h = c * h * h / 2;
  EXPECT_NEAR(mean(cilium, u, h, Vector3::UnitX()), at_h + c * moment / 2, 1e-13 * at_h);
  EXPECT_GT(c * moment / 2, 1e-4 * at_h);
}

// Oracle: central differences along a random direction, in mid-line and where the extrusion lines
// end inside the kernel. Measured: 4e-10 and 2e-8.
TEST(ProbeMean, HasItsOwnDerivative) {
  const BentCilium cilium;
  const Vector3 e = direction(Load{ProbeLoad{0, 0, 0.4}});
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  Vector change(cilium.space->unknowns());
  for (double& d : change) d = uniform(generator);
  for (const double height : {5.3e-3, 7.6e-3}) {
    Vector gradient(cilium.space->unknowns());
    mean(cilium, cilium.state.displacement, height, e, &gradient);
    const auto moved = [&](double step) {
      Vector u(cilium.state.displacement);
      u.add(step, change);
      return mean(cilium, u, height, e);
    };
    const double step = 1e-8;
    const double difference = (moved(step) - moved(-step)) / (2 * step);
    EXPECT_NEAR(gradient * change / difference, 1, 1e-7) << height;
  }
}

TEST(ProbeMean, IsRefusedWhereNothingIsInTheKernel) {
  const BentCilium cilium;
  EXPECT_THROW(mean(cilium, cilium.state.displacement, 9e-3, Vector3::UnitX()), SolverError);
}

/// Newton's method on a coarse cilium.
struct Bench {
  BentCilium cilium;
  Newton newton{
      *cilium.space,
      increment_constraints(*cilium.space, std::vector<DirichletCondition>{{.boundary = 0}}),
      SolverKind::automatic, MPI_COMM_SELF};
  double height = 5.3e-3;
  double azimuth = 0.4;

  NewtonResult pull(double force, SolidState& state) {
    const ExternalForces forces = external_forces(*cilium.space, *cilium.quadrature, cilium.cilium,
                                                  ContactLoad{force, height, azimuth}, width);
    NewtonResult result = newton.solve(forces, state, {.tolerance = 1e-11});
    EXPECT_TRUE(result.converged) << result.reason;
    return result;
  }
  /// From the force's own amplitude.
  NewtonResult push(double displacement, UnknownForce& force, SolidState& state) {
    force = probe_force(*cilium.space, *cilium.quadrature, {displacement, height, azimuth}, width,
                        force.amplitude);
    NewtonResult result = newton.solve(force, state, {.tolerance = 1e-11});
    EXPECT_TRUE(result.converged) << result.reason;
    return result;
  }
  double deflection(const SolidState& state) const {
    return mean(cilium, state.displacement, height, direction(Load{ProbeLoad{0, 0, azimuth}}));
  }
};

double distance(const SolidState& a, const SolidState& b) {
  Vector difference(a.displacement);
  difference -= b.displacement;
  return difference.linfty_norm() / a.displacement.linfty_norm();
}

// Oracle: uniqueness. The displacement that a contact force brings about takes that force, in the
// same state; and that force, as a contact load, brings about the displacement. The probe starts
// from the straight cilium and no force. Measured: 5e-12 of the
// force, 9e-13 of the displacement.
TEST(Probe, AndContactAreInTheSameEquilibrium) {
  Bench bench;
  SolidState contact = bench.cilium.space->undeformed();
  for (const double force : {2e-3, 6e-3, 12e-3}) {
    bench.pull(force, contact);
    const double delta = bench.deflection(contact);
    EXPECT_GT(delta, force * 0.1);
    SolidState probe = bench.cilium.space->undeformed();
    UnknownForce unknown;
    for (const double part : {0.5, 1.0}) bench.push(part * delta, unknown, probe);
    EXPECT_NEAR(unknown.amplitude / force, 1, 1e-9);
    EXPECT_LT(distance(contact, probe), 1e-9);
    SolidState back = probe;
    bench.pull(unknown.amplitude, back);
    EXPECT_NEAR(bench.deflection(back) / delta, 1, 1e-9);
  }
}

// Oracle: Newton's method with the exact bordered system is as fast as without one; with a wrong
// derivative it would be linear. Measured: 4 iterations for both.
TEST(Probe, TakesAsManyIterationsAsAContact) {
  Bench bench;
  SolidState probe = bench.cilium.space->undeformed();
  UnknownForce force;
  bench.push(1e-3, force, probe);
  SolidState contact = probe;
  const int iterations = bench.push(1.5e-3, force, probe).iterations();
  EXPECT_GE(iterations, 2);
  EXPECT_LE(iterations, bench.pull(force.amplitude, contact).iterations());
}

/// The solid on its coarsest mesh.
MechanicsResult pushed(const std::vector<double>& displacements, double height = 16e-3) {
  LoadPath path;
  for (const double delta : displacements) path.push_back(ProbeLoad{delta, height, 0.4});
  return Solid({.refinement = 0}).solve(stub_and_magnet(), path);
}

// Oracle: the contact load, whose force is what is sought there. The displacements at which the
// probe and the forces at which the contact slips off are each known to 1 %; a shorter step after
// it is solved.
TEST(Probe, SlipsOffWhereTheContactDoesAndGoesOn) {
  const MechanicsResult probe = pushed({8e-3, 12e-3, 1, 4e-3});
  const MechanicsResult contact =
      Solid({.refinement = 0}).solve(stub_and_magnet(), {ContactLoad{8e-3, 16e-3, 0.4}});
  EXPECT_EQ(probe.steps[0].status, Status::converged) << probe.steps[0].message;
  for (const std::size_t i : {1U, 2U}) {
    const MechanicsStep& step = probe.steps[i];
    EXPECT_EQ(step.status, Status::slipped_off) << step.message;
    EXPECT_FALSE(step.deformation);
    EXPECT_NEAR(step.slip_off_force.value() / contact.steps[0].slip_off_force.value(), 1, 0.01);
  }
  EXPECT_EQ(probe.steps[3].status, Status::converged) << probe.steps[3].message;
  EXPECT_FALSE(probe.steps[3].slip_off_displacement);

  // Just below it the step is solved, 1.5 % above it is not.
  const double slip_off = probe.steps[1].slip_off_displacement.value();
  const MechanicsResult check = pushed({slip_off, 1.015 * slip_off});
  EXPECT_EQ(check.steps[0].status, Status::converged);
  EXPECT_NEAR(check.steps[0].applied_force / *probe.steps[1].slip_off_force, 1, 1e-6);
  EXPECT_EQ(check.steps[1].status, Status::slipped_off);
}

// Oracle: what the load means. The centreline is at δ where it is at h, but for the width of the
// kernel and of the section; the contact there bears no moment, so that the curvature vanishes.
// Measured: 2e-6 of δ.
TEST(Probe, CentrelineIsAtTheDisplacementWhereItIsAtTheHeight) {
  const MechanicsResult result = pushed({2e-3, 8e-3});
  for (const MechanicsStep& step : result.steps) {
    ASSERT_TRUE(step.deformation) << step.message;
    const double delta = magnitude(step.load);
    const Vector3 r = step.deformation->centreline.at(step.contact_arclength.value()).position;
    EXPECT_NEAR(r.z(), 16e-3, 1e-12);
    EXPECT_NEAR(r.dot(direction(step.load)) / delta, 1, 1e-5);
  }
}

}  // namespace
}  // namespace ciliaval::fem::solid
