// SPDX-License-Identifier: LGPL-2.1-or-later
// Case files with [[environment.magnet]]: what they say, what is refused and where, and that they
// are written back.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include "compare/input/case.h"
#include "compare/models/registry.h"
#include "compare/study/case_number.h"
#include "tests/support/planted_fault.h"
#include "tests/support/same_case.h"

namespace ciliaval::compare {
namespace {

using surroundings::magnets::Magnet;
using surroundings::magnets::Shape;
using testing::HasSubstr;
using testing::StartsWith;

/// Counted by hand: the magnets begin in the lines 11, 17 and 25, [models] in line 32.
constexpr std::string_view beside = R"([case]
name = "beside"
[cilium]
diameter = "3 mm"
[[cilium.segment]]
name = "magnet"
length = "20 mm"
young_modulus = "1 MPa"
poisson_ratio = 0.49
magnetization = "75 kA/m"
[[environment.magnet]]
name = "ball"
shape = "ball"
position = ["0 mm", "20 mm", "5 mm"]
diameter = "6 mm"
magnetization = "500 kA/m"
[[environment.magnet]]
name = "disc"
shape = "cylinder"
position = ["0 mm", "-20 mm", "10 mm"]
axis = [0, 2, 0]
diameter = "8 mm"
length = "3 mm"
remanence = "1.2 T"
[[environment.magnet]]
name = "brick"
shape = "cuboid"
position = ["0 mm", "0 mm", "-5 mm"]
rotation = [0.8, 0, 0.6, 0]
edges = ["4 mm", "5 mm", "2 mm"]
magnetization = ["0 A/m", "0 A/m", "-1 MA/m"]
[models]
mechanics = ["beam"]
)";

TEST(MagnetCase, SaysShapesPosesAndSizes) {
  const input::Case c = read(beside);
  ASSERT_EQ(c.load_path.size(), 1U);
  ASSERT_TRUE(c.load_path.front().is<EnvironmentLoad>());
  EXPECT_DOUBLE_EQ(azimuth(c.load_path.front()), std::numbers::pi / 2);
  const std::vector<Magnet>& magnets = c.load_path.front().environment().magnets;
  ASSERT_EQ(magnets.size(), 3U);
  EXPECT_EQ(magnets[0].name, "ball");
  EXPECT_EQ(magnets[0].shape, Shape::ball);
  EXPECT_EQ(magnets[0].position, Vector3(0, 0.02, 0.005));
  EXPECT_EQ(magnets[0].diameter, 0.006);
  EXPECT_EQ(magnets[0].magnetization, Vector3(0, 0, 5e5));
  EXPECT_EQ(magnets[1].shape, Shape::cylinder);
  EXPECT_EQ(magnets[1].length, 0.003);
  EXPECT_NEAR(magnets[1].magnetization.z(), 1.2 / vacuum_permeability, 1e-6);
  EXPECT_LT((magnets[1].rotation * Vector3::UnitZ() - Vector3::UnitY()).norm(), 1e-15);
  EXPECT_EQ(magnets[2].edges, Vector3(0.004, 0.005, 0.002));
  EXPECT_EQ(magnets[2].rotation.coeffs(), Quaternion(0.8, 0, 0.6, 0).coeffs());
  EXPECT_EQ(magnets[2].magnetization, Vector3(0, 0, -1e6));
}

TEST(MagnetCase, TurnsAnAxisThatPointsDown) {
  const input::Case c = read(replaced(beside, "[0, 2, 0]", "[0, 0, -1]"));
  const Magnet& disc = c.load_path.front().environment().magnets[1];
  EXPECT_LT((disc.rotation * Vector3::UnitZ() + Vector3::UnitZ()).norm(), 1e-15);
}

constexpr std::string_view one_place = R"(["0 mm", "20 mm", "5 mm"])";
constexpr std::string_view two_places = R"([["0 mm", "20 mm", "5 mm"], ["0 mm", "18 mm", "5 mm"]])";

TEST(MagnetCase, AListOfPositionsIsAPath) {
  const input::Case c = read(replaced(beside, one_place, two_places));
  ASSERT_EQ(c.load_path.size(), 2U);
  EXPECT_EQ(c.load_path[1].environment().magnets[0].position.y(), 0.018);
  EXPECT_EQ(c.load_path[1].environment().magnets[1].position.y(), -0.02);
  const std::string with_load =
      replaced(replaced(beside, one_place, two_places), "[models]",
               "[load]\ntype = \"section\"\nforce = [\"1 mN\", \"2 mN\", \"3 mN\"]\narclength = "
               "\"20 mm\"\n[models]");
  EXPECT_THAT(faults_of(with_load), StartsWith("bad.toml:14:12: 'position' lists 2 values, "
                                               "but the load has 3 steps"));
}

TEST(MagnetCase, IsWrittenBack) {
  for (const std::string& text :
       {std::string(beside), replaced(beside, one_place, two_places),
        replaced(beside, "[[environment.magnet]]\nname = \"ball\"",
                 "[environment]\nuniform_field = [\"0 mT\", \"1 mT\", \"2 mT\"]\nmagnetic_energy "
                 "= \"R\"\n[[environment.magnet]]\nname = \"ball\""),
        replaced(beside, "[models]",
                 "[load]\ntype = \"contact\"\nforce = [\"1 mN\", \"2 mN\"]\nheight = \"16 "
                 "mm\"\n[models]")})
    expect_read_back(text);
}

TEST(MagnetCase, StudiesMayVaryIt) {
  const input::Case c = read(replaced(beside, one_place, two_places));
  for (const study::CaseNumber& number : study::case_numbers(c))
    EXPECT_NE(number.path, "environment.magnet.ball.position.x");  // it tells the steps apart
  const input::Case other = varied(c, {{"environment.magnet.ball.diameter", 5e-3},
                                       {"environment.magnet.disc.position.y", -0.03},
                                       {"environment.magnet.disc.length", 2e-3},
                                       {"environment.magnet.brick.magnetization", 3e5}});
  ASSERT_EQ(other.load_path.size(), 2U);
  for (const Load& load : other.load_path) {
    const std::vector<Magnet>& magnets = load.environment().magnets;
    EXPECT_EQ(magnets[0].diameter, 5e-3);
    EXPECT_EQ(magnets[1].position, Vector3(0, -0.03, 0.01));
    EXPECT_EQ(magnets[1].length, 2e-3);
    EXPECT_EQ(magnets[2].magnetization, Vector3(0, 0, 3e5));
  }
}

class BadMagnetCase : public testing::TestWithParam<PlantedFault> {};

TEST_P(BadMagnetCase, IsRefusedWithOneLocatedMessage) {
  expect_refused(beside, GetParam());
}

const PlantedFault bad_magnets[]{
    {"Touches", "\"20 mm\", \"5 mm\"]\ndiameter", "\"4.4 mm\", \"5 mm\"]\ndiameter", "14:12",
     "the magnet 'ball' touches the straight cilium: move it away"},
    {"NoUnit", "\"6 mm\"", "6", "15:12", "has no unit: write a length"},
    {"PositionWithoutUnit", "\"20 mm\", \"5 mm\"]\ndiameter", "20, \"5 mm\"]\ndiameter", "14:21",
     "has no unit: write a length"},
    {"ZeroDiameter", "\"6 mm\"", "\"0 mm\"", "15:12", "'diameter' is 0 m"},
    {"ZeroEdge", "[\"4 mm\"", "[\"0 mm\"", "30:10", "'edges' is 0 m"},
    {"NoDiameter", "diameter = \"6 mm\"\n", "", "11:1", "[[environment.magnet]] needs 'diameter'"},
    {"NoName", "name = \"ball\"\n", "", "11:1", "[[environment.magnet]] needs 'name'"},
    {"NoPosition", "position = [\"0 mm\", \"20 mm\", \"5 mm\"]\n", "", "11:1",
     "[[environment.magnet]] needs 'position'"},
    {"NoMagnetization", "magnetization = \"500 kA/m\"\n", "", "11:1",
     "[[environment.magnet]] needs 'magnetization' or 'remanence'"},
    {"Both", "remanence = \"1.2 T\"", "remanence = \"1.2 T\"\nmagnetization = \"1 MA/m\"", "24:13",
     "'remanence' contradicts 'magnetization': give one of them"},
    {"Nothing", "500 kA/m", "0 kA/m", "16:17", "magnetisation is zero"},
    {"FieldForMagnetization", "500 kA/m", "1 T", "16:17", "magnetization M = B_r/mu_0"},
    {"AcrossTheAxis", "remanence = \"1.2 T\"", "magnetization = [\"1 MA/m\", \"0 A/m\", \"0 A/m\"]",
     "24:17", "a cylinder is magnetised along its axis only"},
    {"UnknownShape", "\"ball\"\nposition", "\"bell\"\nposition", "13:9",
     "'shape' cannot be 'bell' (valid: ball, cylinder, cuboid)"},
    {"SameName", "name = \"disc\"", "name = \"ball\"", "18:8",
     "the magnet name 'ball' is already taken"},
    {"ZeroAxis", "[0, 2, 0]", "[0, 0, 0]", "21:8", "'axis' must point somewhere"},
    {"AxisAndRotation", "axis = [0, 2, 0]", "axis = [0, 2, 0]\nrotation = [1, 0, 0, 0]", "21:8",
     "'axis' contradicts 'rotation': give one of them"},
    {"NoRotation", "[0.8, 0, 0.6, 0]", "[0.8, 0, 0.7, 0]", "29:12", "a unit quaternion"},
    {"LengthOfABall", "diameter = \"6 mm\"", "diameter = \"6 mm\"\nlength = \"3 mm\"", "16:10",
     "'length' goes with a cylinder only"},
    {"NoMagnetOfItsOwn", "magnetization = \"75 kA/m\"\n", "", "10:1",
     "[[environment.magnet]] needs a magnet: no [[cilium.segment]] has a 'magnetization'"},
    {"Elastica", "[\"beam\"]", "[\"beam\", \"elastica\"]", "33:22",
     "the elastica takes no [[environment.magnet]]: use 'beam' or 'solid'"},
};

INSTANTIATE_TEST_SUITE_P(Magnets, BadMagnetCase, testing::ValuesIn(bad_magnets), name_of);

}  // namespace
}  // namespace ciliaval::compare
