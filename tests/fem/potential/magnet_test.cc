// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/potential/magnet.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bodies.h"
#include "fem/potential/block_cut.h"

namespace ciliaval::fem::potential {
namespace {

using test::R;
constexpr double L = 17e-3;
constexpr double M = 75e3;

struct Total {
  double volume = 0;
  Vector3 moment = Vector3::Zero();
};

Total total(const Magnet& magnet, std::size_t n) {
  std::vector<MagnetSample> samples;
  for (const Magnet::Block& block : magnet.blocks()) magnet.sample(block, n, samples);
  Total sum;
  for (const MagnetSample& s : samples) {
    sum.volume += s.volume;
    sum.moment += s.moment;
  }
  return sum;
}

// Pappus: the volume of a bent rod is that of the straight one. F: Σ M dr over the volume is
// πR²M (r_top − r_bottom), since ∂x/∂S − r' has no mean over a section. Measured 4e-15; Gauss rules
// of 8 points integrate an arc of 58° per block to rounding error.
TEST(Magnet, BentRodKeepsItsVolumeAndCarriesItsChordsMoment) {
  const Deformation bent = test::arc(60);
  const Total sum = total(Magnet(test::paper_cilium(), bent, MagnetPushForward::F), 8);
  const double area = std::numbers::pi * R * R;
  EXPECT_NEAR(sum.volume / (area * L), 1, 1e-12);
  const Vector3 chord = bent.centreline.at(20e-3).position - bent.centreline.at(3e-3).position;
  EXPECT_LT((sum.moment - M * area * chord).norm() / (M * area * L), 1e-12);
}

// R on an inextensible, shear-rigid rod: M d₃ J dV has the mean M d₃ = M r' over a section, the
// same total.
TEST(Magnet, BothPushForwardsOfAnInextensibleRodHaveTheSameTotal) {
  const Deformation bent = test::arc(60);
  const Total F = total(Magnet(test::paper_cilium(), bent, MagnetPushForward::F), 8);
  const Total rigid = total(Magnet(test::paper_cilium(), bent, MagnetPushForward::R), 8);
  EXPECT_LT((F.moment - rigid.moment).norm() / F.moment.norm(), 1e-12);
}

// Across the axis M turns with the sections: ∫ d₁ dS = [(sin θ, 0, cos θ)/κ] of an arc, d₂ stays.
TEST(Magnet, BentRodCarriesWhatIsAcrossItsAxis) {
  constexpr double curvature = 60;
  Cilium cilium = test::paper_cilium();
  cilium.segments.back().magnetization = 0;
  cilium.segments.back().transverse_magnetization = {M, -M / 2};
  const double low = curvature * 3e-3;
  const double high = curvature * 20e-3;
  const Vector3 exact =
      std::numbers::pi * R * R * M *
      (Vector3(std::sin(high) - std::sin(low), 0, std::cos(high) - std::cos(low)) / curvature -
       L / 2 * Vector3::UnitY());
  for (const auto push_forward : {MagnetPushForward::F, MagnetPushForward::R}) {
    const Total sum = total(Magnet(cilium, test::arc(curvature), push_forward), 8);
    EXPECT_LT((sum.moment - exact).norm() / exact.norm(), 1e-12);
  }
}

// The ball's volume 4π/3 R³. Measured 5e-6: its geometry is interpolated with degree 5.
TEST(Magnet, CellsOfASolidAreSampledWithTheirVolume) {
  const Vector3 m(1e3, -2e3, 3e3);
  const Total sum = total(Magnet(test::ball(R, m), MagnetPushForward::F), 12);
  const double volume = 4 * std::numbers::pi / 3 * R * R * R;
  EXPECT_NEAR(sum.volume / volume, 1, 1e-5);
  EXPECT_LT((sum.moment / volume - m).norm() / m.norm(), 1e-5);
}

// Distances from a cylinder by hand: below its lower face, beside its mantle, off its rim, inside.
TEST(Magnet, DistanceIsFromBelowAndToTwoPercent) {
  const Magnet magnet(test::paper_cilium(), test::arc(0), MagnetPushForward::F);
  const auto check = [&](const Vector3& x, double exact) {
    const double distance = magnet.distance(x, 1e-8);
    EXPECT_LE(distance, exact);
    EXPECT_GE(distance, 0.98 * exact);
  };
  check({0.1e-3, 0.2e-3, -1.55e-3}, 4.55e-3);
  check({5e-3, 0, 11e-3}, 3.5e-3);
  check({0, -R - 3e-3, 24e-3}, 5e-3);
  check({0, 0, 20.01e-3}, 0.01e-3);
  EXPECT_EQ(magnet.distance({0, 1e-3, 10e-3}, 1e-6), 0);
}

/// Volume of the blocks' pieces below the plane x_i = height.
double volume_below(const std::vector<MagnetSample>& pieces, Eigen::Index i, double height) {
  double sum = 0;
  for (const MagnetSample& s : pieces)
    if (s.position[i] < height) sum += s.volume;
  return sum;
}

// Oracle: the part of a unit cube below a plane at the distance h from its corner, across its
// diagonal: with s = √3 h it is s³/6 up to s = 1, s³/6 − (s − 1)³/2 up to 2. Measured 1e-15.
TEST(BlockCut, IsExactForAPlaneAcrossACube) {
  auto body = std::make_shared<SolidBody>();
  body->nodes = LagrangeBasis({0, 1});
  SolidCell cell;
  cell.magnetization = Vector3(0, 0, 1);
  const Quaternion turn = Quaternion::FromTwoVectors(Vector3(1, 1, 1), Vector3::UnitX());
  for (int node = 0; node < 8; ++node) {
    cell.reference.emplace_back(node % 2, node / 2 % 2, node / 4);
    cell.current.push_back(turn * cell.reference.back());
  }
  body->cells.push_back(cell);
  const Magnet magnet(body, MagnetPushForward::F);
  std::vector<MagnetSample> gauss;
  magnet.sample(magnet.blocks().front(), 4, gauss);
  for (const double h : {0.2, 0.5, 0.7, 1.1}) {
    // Planes x = h + 10 k, and others that do not meet the cube.
    std::vector<MagnetSample> pieces;
    BlockCut(4, 2).cut(gauss, {Vector3(h, -5, -5), 10}, pieces);
    const double s = std::sqrt(3) * h;
    const double exact = std::pow(s, 3) / 6 - (s > 1 ? std::pow(s - 1, 3) / 2 : 0);
    EXPECT_NEAR(volume_below(pieces, 0, h), exact, 1e-12);
    EXPECT_NEAR(volume_below(pieces, 0, 10), 1, 1e-12);
  }
}

// Oracle: the part of a straight cylinder below a plane across its axis, and beside one along it,
// a circle's segment R² (α − sin α cos α) with R cos α the plane's distance. Measured 1e-13 and
// 1.3e-3 of the volume: quadrants of the whole length are known by 4³ points each.
TEST(BlockCut, CutsAStraightRod) {
  const Magnet magnet(test::paper_cilium(), test::arc(0), MagnetPushForward::F);
  const double area = std::numbers::pi * R * R;
  const auto pieces_between = [&](const PlaneGrid& planes) {
    std::vector<MagnetSample> pieces;
    for (const Magnet::Block& block : magnet.blocks()) {
      std::vector<MagnetSample> gauss;
      magnet.sample(block, 4, gauss);
      BlockCut(4, 2).cut(gauss, planes, pieces);
    }
    return pieces;
  };
  for (const double z : {4e-3, 9.7e-3, 19.9e-3})
    EXPECT_NEAR(
        volume_below(pieces_between({Vector3(-0.5, -0.5, z), 1}), 2, z) / (area * (z - 3e-3)), 1,
        1e-12);
  for (const double x : {-1.2e-3, -0.3e-3, 0.9e-3}) {
    const double alpha = std::acos(-x / R);
    const double exact = R * R * (alpha - std::sin(alpha) * std::cos(alpha)) * L;
    const double volume = volume_below(pieces_between({Vector3(x, -0.5, -0.5), 1}), 0, x);
    EXPECT_NEAR(volume / (area * L), exact / (area * L), 2e-3);
  }
}

// Cutting loses nothing: total volume and moment of the pieces are those of the Gauss points.
TEST(BlockCut, KeepsVolumeAndMoment) {
  const Magnet magnet(test::paper_cilium(), test::arc(60), MagnetPushForward::F);
  std::vector<MagnetSample> gauss;
  std::vector<MagnetSample> pieces;
  for (const Magnet::Block& block : magnet.blocks()) {
    std::vector<MagnetSample> own;
    magnet.sample(block, 4, own);
    BlockCut(4, 2).cut(own, {Vector3(0.2e-3, 0.1e-3, 0), 1.1e-3}, pieces);
    gauss.insert(gauss.end(), own.begin(), own.end());
  }
  EXPECT_GT(pieces.size(), 10 * gauss.size());
  Total difference;
  Total sum;
  for (const MagnetSample& s : gauss) {
    sum.volume += s.volume;
    sum.moment += s.moment;
  }
  difference = sum;
  for (const MagnetSample& s : pieces) {
    difference.volume -= s.volume;
    difference.moment -= s.moment;
  }
  EXPECT_LT(std::abs(difference.volume), 1e-12 * sum.volume);
  EXPECT_LT(difference.moment.norm(), 1e-12 * sum.moment.norm());
}

}  // namespace
}  // namespace ciliaval::fem::potential
