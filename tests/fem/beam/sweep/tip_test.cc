// SPDX-License-Identifier: LGPL-2.1-or-later
// The equations of a contact: their tangent against differences, and each state's laws.
#include "fem/beam/sweep/tip.h"

#include <gtest/gtest.h>

#include <random>

#include "../beams.h"
#include "fem/beam/cilium_beam.h"
#include "sweeps.h"

namespace ciliaval::fem::beam::sweep {
namespace {

using beams::measured;
using Eigen::Index;

/// Oracle: central differences of order 6 of the residual, at a state that solves nothing. p″ is a
/// difference itself, right to 1e-8 or so.
TEST(TipEquations, HaveAConsistentTangent) {
  const CiliumBeam full = cilium_beam(sweeps::paper(), sweeps::options(false, TipShape::rim));
  const PlaneBeam beam(full.system);
  const surroundings::Surface surface{surroundings::SineProfile{1e-3, 10e-3}, 0.3, 0.05};
  const Tip tip(beam, surface, sweeps::L, 0.075, 1e-12, 30);
  std::mt19937 engine(5);
  std::uniform_real_distribution<double> uniform(-0.2, 0.2);
  const Index n = beam.n_angles();
  Eigen::VectorXd all(n + 7);
  for (double& value : all) value = 0.5 + uniform(engine);
  const Viscosity viscosity{1.5, 0.5 * beam.curvature(all.head(n))};
  Eigen::VectorXd residual;
  Eigen::MatrixXd J;
  Eigen::MatrixXd unused;
  for (const ContactStatus status :
       {ContactStatus{Touch::none, 0}, ContactStatus{Touch::rear, 0}, ContactStatus{Touch::rear, 1},
        ContactStatus{Touch::front, -1}, ContactStatus{Touch::face, 0},
        ContactStatus{Touch::face, 1}, ContactStatus{Touch::rear_and_face, 0},
        ContactStatus{Touch::both_ends, -1}}) {
    const Eigen::VectorXd at = all.head(parts(status.touch).size() == 2 ? n + 7 : n + 4);
    const auto residual_at = [&](Index i, double h) {
      Eigen::VectorXd moved = at;
      moved[i] += h;
      Eigen::VectorXd result;
      tip.equations(status, {0.9, 0.2}, {0.4, 0.01}, viscosity, moved, result, unused);
      return result;
    };
    tip.equations(status, {0.9, 0.2}, {0.4, 0.01}, viscosity, at, residual, J);
    for (Index i = 0; i < at.size(); ++i) {
      // The unknowns that Touch::none leaves alone are not moved: their rows are there for a
      // regular matrix.
      if (status.touch == Touch::none && i >= n) continue;
      const double h = 1e-3;
      const Eigen::VectorXd column = (45.0 * (residual_at(i, h) - residual_at(i, -h)) -
                                      9.0 * (residual_at(i, 2 * h) - residual_at(i, -2 * h)) +
                                      (residual_at(i, 3 * h) - residual_at(i, -3 * h))) /
                                     (60 * h);
      // The arc length of a rolling contact is of three Gauss points, the tangent's exact.
      const double tolerance = status.touch != Touch::none && status.slip == 0 ? 1e-5 : 1e-7;
      EXPECT_LT(measured("tangent", (column - J.col(i)).norm() / J.cwiseAbs().maxCoeff()),
                tolerance)
          << static_cast<int>(status.touch) << ' ' << status.slip << ' ' << i;
    }
  }
}

}  // namespace
}  // namespace ciliaval::fem::beam::sweep
