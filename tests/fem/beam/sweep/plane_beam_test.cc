// SPDX-License-Identifier: LGPL-2.1-or-later
// The beam condensed to its nodal angles against the full beam, and its derivatives against
// differences.
#include "fem/beam/sweep/plane_beam.h"

#include <gtest/gtest.h>

#include <random>

#include "../beams.h"
#include "fem/beam/cilium_beam.h"
#include "fem/beam/sweep/follower.h"
#include "fem/beam/sweep/tip.h"
#include "sweeps.h"

namespace ciliaval::fem::beam::sweep {
namespace {

using beams::measured;
using Eigen::Index;

struct Scene {
  CiliumBeam full;
  PlaneBeam beam;
  Eigen::VectorXd angles;
  Vector2d force{0.7, -1.3};

  explicit Scene(bool shear_rigid)
      : full(cilium_beam(sweeps::paper(), sweeps::options(shear_rigid, TipShape::point))),
        beam(full.system),
        angles(beam.n_angles()) {
    std::mt19937 engine(3);
    std::uniform_real_distribution<double> uniform(-0.3, 0.3);
    for (double& angle : angles) angle = 0.5 + uniform(engine);
  }
};

/// Oracle: central differences of order 6 of the energy, the gradient and the tip's position;
/// errors are measured below 1e-10 of the largest entry.
TEST(PlaneBeam, HasTheDerivativesOfItsEnergy) {
  const Scene s(false);
  Viscosity viscosity{0.7, 0.1 * s.beam.curvature(s.angles)};
  const auto difference = [](const auto& f) {
    const double h = 1e-3;
    using Value = decltype(f(h));
    return Value((45.0 * (f(h) - f(-h)) - 9.0 * (f(2 * h) - f(-2 * h)) + (f(3 * h) - f(-3 * h))) /
                 (60 * h));
  };
  const Response at = s.beam.respond(s.angles, s.force);
  const Response viscous = s.beam.respond(s.angles, s.force, viscosity);
  const double scale = at.hessian.cwiseAbs().maxCoeff();
  for (Index i = 0; i < s.angles.size(); ++i) {
    const auto moved = [&](double h) {
      Eigen::VectorXd angles = s.angles;
      angles[i] += h;
      return angles;
    };
    // G = E − F·r.
    const double slope = difference([&](double h) {
      const Response r = s.beam.respond(moved(h), s.force);
      return r.energy - s.force.dot(r.tip);
    });
    EXPECT_LT(measured("gradient", std::abs(slope - at.gradient[i]) / scale), 1e-9);
    const Eigen::VectorXd column =
        difference([&](double h) { return s.beam.respond(moved(h), s.force, viscosity).gradient; });
    EXPECT_LT(measured("hessian", (column - viscous.hessian.col(i)).norm() / scale), 1e-9);
    const Vector2d turning =
        difference([&](double h) { return s.beam.respond(moved(h), s.force).tip; });
    EXPECT_LT(measured("tip", (turning - at.tip_turning.col(i)).norm()), 1e-9);
  }
  for (Index i = 0; i < 2; ++i) {
    const auto moved = [&](double h) { return Vector2d(s.force + h * Vector2d::Unit(i)); };
    const Vector2d column =
        difference([&](double h) { return s.beam.respond(s.angles, moved(h)).tip; });
    EXPECT_LT(measured("compliance", (column - at.compliance.col(i)).norm()), 1e-11);
    const Eigen::VectorXd gradient =
        difference([&](double h) { return s.beam.respond(s.angles, moved(h)).gradient; });
    EXPECT_LT((gradient + at.tip_turning.row(i).transpose()).norm(), 1e-9);
  }
}

/// Oracle: the residual of the full beam in space under the same tip force and moment, in an
/// oblique plane. Measured below 1e-13 of the section forces.
TEST(PlaneBeam, IsTheFullBeamsEquilibrium) {
  const double azimuth = 0.7;
  for (const bool shear_rigid : {false, true}) {
    Scene s(shear_rigid);
    const System& system = s.full.system;
    const double R = 0.075;
    const surroundings::Surface surface{surroundings::SineProfile{1e-3, 30e-3}, 0.3, 0};
    const Tip tip(s.beam, surface, sweeps::L, R, 1e-13, 50);
    Follower follower(tip);
    const TipState state = follower.begin({0.9, 0}).state;
    ASSERT_EQ(state.status.touch, Touch::rear);
    const Vector3 e(std::cos(azimuth), std::sin(azimuth), 0);
    const auto in_space = [&](const Vector2d& v) -> Vector3 {
      return v[0] * e + v[1] * Vector3::UnitZ();
    };
    const Vector3 force = system.force_scale() * in_space(state.force);
    const Vector3 arm = system.length_scale() * in_space(-R * d1(state.angle()));
    const State full = s.beam.state(state.angles, state.force, azimuth);
    const Eigen::VectorXd residual =
        system.residual(full, beams::end_load(s.full.loaded, force, arm.cross(force)));
    double worst = 0;
    for (std::size_t i = 0; i < system.n_unknowns(); ++i)
      if (!system.supported()[i])
        worst = std::max(worst, std::abs(residual[static_cast<Index>(i)]));
    EXPECT_LT(measured("residual", worst / state.force.norm()), 1e-12);
    EXPECT_GT(state.angle(), 0.3);
    EXPECT_LT((full.position.back() / system.length_scale() - in_space(state.tip)).norm(), 1e-13);
    // The energy is that of the full beam, whose potential is E − F·r.
    EXPECT_NEAR(system.potential_energy(full, {}) / (system.force_scale() * system.length_scale()),
                state.energy, 1e-12 * state.energy);
  }
}

}  // namespace
}  // namespace ciliaval::fem::beam::sweep
