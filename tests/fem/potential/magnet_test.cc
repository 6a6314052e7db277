// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/potential/magnet.h"

#include <gtest/gtest.h>

#include <numbers>

#include "bodies.h"

namespace ciliaval::fem {
namespace {

constexpr double R = 1.5e-3;
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

}  // namespace
}  // namespace ciliaval::fem
