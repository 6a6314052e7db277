// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "problem/error.h"
#include "problem/surroundings/magnets/magnet.h"

namespace ciliaval::surroundings::magnets {
namespace {

Magnet cylinder() {
  Magnet magnet;
  magnet.name = "below";
  magnet.shape = Shape::cylinder;
  magnet.diameter = 4e-3;
  magnet.length = 6e-3;
  magnet.magnetization = {0, 0, 1e6};
  return magnet;
}

TEST(MagnetShape, HasTheVolumeAndMomentOfTheBody) {
  Magnet magnet = cylinder();
  magnet.rotation = Eigen::AngleAxisd(std::numbers::pi / 2, Vector3::UnitY());
  EXPECT_NEAR(volume(magnet), std::numbers::pi * 4e-6 * 6e-3, 1e-22);
  EXPECT_NEAR((moment(magnet) - volume(magnet) * 1e6 * Vector3::UnitX()).norm(), 0, 1e-16);
  magnet.shape = Shape::ball;
  EXPECT_NEAR(volume(magnet), 4 * std::numbers::pi / 3 * 8e-9, 1e-22);
  magnet.shape = Shape::cuboid;
  magnet.edges = {1e-3, 2e-3, 3e-3};
  EXPECT_NEAR(volume(magnet), 6e-9, 1e-22);
}

TEST(MagnetShape, DistanceIsThatOfTheNearestPoint) {
  Magnet magnet = cylinder();
  magnet.position = {0.1, 0, 0};
  magnet.rotation = Eigen::AngleAxisd(std::numbers::pi / 2, Vector3::UnitY());  // axis along x
  EXPECT_NEAR(distance(magnet, {0.1 + 5e-3, 0, 0}), 2e-3, 1e-15);
  EXPECT_NEAR(distance(magnet, {0.1, 0, 5e-3}), 3e-3, 1e-15);
  EXPECT_NEAR(distance(magnet, {0.1 + 6e-3, 0, 6e-3}), 5e-3, 1e-15);
  EXPECT_EQ(distance(magnet, {0.1, 1e-3, 0}), 0);
}

TEST(MagnetShape, DistanceFromTheCiliumIsThatOfTheBodies) {
  Magnet magnet = cylinder();
  magnet.position = {0, 0, 25e-3};  // above the tip of a cilium of 20 mm
  EXPECT_NEAR(distance_from_upright_cylinder(magnet, 1.5e-3, 20e-3), 2e-3, 1e-12);
  magnet.position = {10e-3, 0, 10e-3};  // beside
  EXPECT_NEAR(distance_from_upright_cylinder(magnet, 1.5e-3, 20e-3), 6.5e-3, 1e-12);
  magnet.position = {3.4e-3, 0, 10e-3};
  EXPECT_EQ(distance_from_upright_cylinder(magnet, 1.5e-3, 20e-3), 0);
  // An edge above the rim: a cuboid turned by 45° about y.
  magnet.shape = Shape::cuboid;
  magnet.edges = Vector3::Constant(2e-3);
  magnet.rotation = Eigen::AngleAxisd(std::numbers::pi / 4, Vector3::UnitY());
  magnet.position = {4e-3, 0, 25e-3};
  EXPECT_NEAR(distance_from_upright_cylinder(magnet, 1.5e-3, 20e-3),
              std::hypot(7.5e-3 / std::sqrt(2.0) - 1e-3, 2.5e-3 / std::sqrt(2.0) - 1e-3), 1e-9);
}

TEST(MagnetShape, RefusesWhatIsNoMagnet) {
  const auto message = [](const std::function<void(Magnet&)>& spoil) -> std::string {
    Magnet magnet = cylinder();
    spoil(magnet);
    try {
      require_valid(magnet);
    } catch (const InputError& error) {
      return error.what();
    }
    return "valid";
  };
  using testing::HasSubstr;
  EXPECT_EQ(message([](Magnet&) {}), "valid");
  EXPECT_THAT(message([](Magnet& m) { m.diameter = 0; }),
              HasSubstr("magnet 'below': the diameter"));
  EXPECT_THAT(message([](Magnet& m) { m.length = -1; }), HasSubstr("length"));
  EXPECT_THAT(message([](Magnet& m) { m.position[1] = NAN; }), HasSubstr("position"));
  EXPECT_THAT(message([](Magnet& m) { m.magnetization[0] = 1; }), HasSubstr("along its axis only"));
  EXPECT_THAT(message([](Magnet& m) { m.rotation = {2, 0, 0, 0}; }), HasSubstr("rotation"));
  EXPECT_THAT(message([](Magnet& m) { m.shape = Shape::cuboid; }), HasSubstr("edges"));
}

}  // namespace
}  // namespace ciliaval::surroundings::magnets
