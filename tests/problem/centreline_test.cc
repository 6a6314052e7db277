// SPDX-License-Identifier: LGPL-2.1-or-later
#include "problem/centreline.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "problem/error.h"

namespace ciliaval {
namespace {

/// Circular arc of curvature kappa in the plane of azimuth phi: θ = κS.
SectionState arc(double S, double kappa, double phi) {
  const Vector3 e(std::cos(phi), std::sin(phi), 0);
  const Vector3 axis = Vector3::UnitZ().cross(e);
  SectionState state;
  state.position =
      (1 - std::cos(kappa * S)) / kappa * e + std::sin(kappa * S) / kappa * Vector3::UnitZ();
  state.rotation = Quaternion(Eigen::AngleAxisd(kappa * S, axis));
  state.curvature = kappa * axis;
  state.forces.moment = S * axis;
  return state;
}

Centreline::Piece arc_piece(double a, double b, double kappa, double phi) {
  Centreline::Piece piece{chebyshev_points(18, a, b), {}};
  for (const double S : piece.S) piece.states.push_back(arc(S, kappa, phi));
  return piece;
}

// Oracle: the arc itself; derivative dr/dS = d₃ since it neither shears nor stretches.
TEST(Centreline, InterpolatesACircularArcToRoundingError) {
  const double kappa = 70;
  const Centreline line({arc_piece(0, 8e-3, kappa, 0.5), arc_piece(8e-3, 20e-3, kappa, 0.5)});
  for (int i = 0; i <= 54; ++i) {
    const double S = 0.37e-3 * i;
    const CentrelinePoint p = line.at(S);
    const SectionState exact = arc(S, kappa, 0.5);
    EXPECT_NEAR((p.position - exact.position).norm(), 0, 1e-16 * 10);
    EXPECT_NEAR(p.theta(), kappa * S, 1e-12);
    EXPECT_NEAR((p.derivative - p.normal()).norm(), 0, 1e-11);
    EXPECT_NEAR(p.bending_curvature(), kappa, 1e-10);
    EXPECT_NEAR((p.forces.moment - exact.forces.moment).norm(), 0, 1e-16);
  }
}

TEST(Centreline, TakesQuaternionsOfEitherSign) {
  Centreline::Piece piece = arc_piece(0, 20e-3, 70, 0);
  for (std::size_t i = 0; i < piece.states.size(); i += 2) piece.states[i].rotation.coeffs() *= -1;
  const Centreline line({piece});
  EXPECT_NEAR(line.at(11e-3).theta(), 70 * 11e-3, 1e-12);
}

TEST(Centreline, GivesOneSidedValuesAtBreaks) {
  const Centreline line({arc_piece(0, 8e-3, 20, 0), [] {
                           Centreline::Piece upper = arc_piece(8e-3, 20e-3, 20, 0);
                           for (SectionState& s : upper.states) s.curvature *= 3;
                           return upper;
                         }()});
  EXPECT_NEAR(line.at(8e-3, 0).bending_curvature(), 20, 1e-10);
  EXPECT_NEAR(line.at(8e-3, 1).bending_curvature(), 60, 1e-10);
  EXPECT_EQ(line.piece_at(8e-3), 1U);
}

TEST(Centreline, ClampsToItsEndsAndRefusesNonsense) {
  const Centreline line = straight_centreline({0, 3e-3, 20e-3});
  EXPECT_EQ(line.at(-1).position, Vector3::Zero());
  EXPECT_EQ(line.at(1).position, Vector3(0, 0, 20e-3));
  EXPECT_EQ(line.length(), 20e-3);
  EXPECT_THROW(line.at(std::numeric_limits<double>::quiet_NaN()), InputError);
  EXPECT_THROW(Centreline().at(0), InputError);
  EXPECT_THROW(Centreline(std::vector<Centreline::Piece>{}), InputError);
  EXPECT_THROW(Centreline({arc_piece(0, 1, 1, 0), arc_piece(1.5, 2, 1, 0)}), InputError);
}

}  // namespace
}  // namespace ciliaval
