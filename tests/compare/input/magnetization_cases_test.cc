// SPDX-License-Identifier: LGPL-2.1-or-later
// Segments that are magnetised across their axis: what the case says, what is refused and where,
// and that it is written back.
#include <gtest/gtest.h>

#include <string>
#include <string_view>

#include "compare/input/case.h"
#include "compare/models/registry.h"
#include "problem/cilium.h"
#include "tests/support/planted_fault.h"
#include "tests/support/same_case.h"

namespace ciliaval::compare {
namespace {

/// Counted by hand: `magnetization` is in line 10, [environment] in line 11, [load] in line 13,
/// [models] in line 19, [models.volume] in line 22.
constexpr std::string_view across = R"([case]
name = "across"
[cilium]
diameter = "3 mm"
[[cilium.segment]]
name = "magnet"
length = "17 mm"
young_modulus = "3 MPa"
poisson_ratio = 0.49
magnetization = ["10 kA/m", "0 A/m", "-75 kA/m"]
[environment]
uniform_field = ["1 mT", "0 mT", "2 mT"]
[load]
type = "dead"
force_per_length = ["0.01 N/m", "0.02 N/m"]
azimuth = "0 deg"
[sensor]
position = ["0 mm", "0 mm", "-2 mm"]
[models]
mechanics = ["elastica", "beam", "solid"]
fields = ["dipole", "line", "volume", "mesh"]
[models.volume]
method = "closed_form"
)";

constexpr std::string_view three = R"(["10 kA/m", "0 A/m", "-75 kA/m"])";

TEST(MagnetizationCase, HasThreeComponentsOrIsAxial) {
  EXPECT_EQ(magnetization(read(across).cilium.segments[0]), Vector3(1e4, 0, -7.5e4));
  const std::string axial = replaced(across, three, "\"-75 kA/m\"");
  EXPECT_EQ(magnetization(read(axial).cilium.segments[0]), Vector3(0, 0, -7.5e4));
  // One across the axis alone is a magnet for fields and environment.
  const std::string alone = replaced(across, "\"-75 kA/m\"", "\"0 A/m\"");
  EXPECT_EQ(magnetization(read(alone).cilium.segments[0]), Vector3(1e4, 0, 0));
}

TEST(MagnetizationCase, IsWrittenBack) {
  expect_read_back(across);
  const std::string axial =
      input::to_toml(read(replaced(across, three, "\"-75 kA/m\"")), models::known());
  EXPECT_NE(axial.find("magnetization = \"-75000 A/m\""), std::string::npos) << axial;
}

class BadMagnetizationCase : public testing::TestWithParam<PlantedFault> {};

TEST_P(BadMagnetizationCase, IsRefusedWithOneLocatedMessage) {
  expect_refused(across, GetParam());
}

const PlantedFault bad_magnetizations[]{
    {"TwoComponents", "\"0 A/m\", ", "", "10:17",
     "'magnetization' must have three components along x, y and z", "found 2"},
    {"WithoutUnit", "\"-75 kA/m\"", "-75000", "10:38", "has no unit: write a magnetization"},
    {"FluxDensity", "\"-75 kA/m\"", "\"-0.1 T\"", "10:38", "'T' is not a unit of a magnetization"},
    {"NoNumber", "\"-75 kA/m\"", "\"strong\"", "10:38", "'magnetization'"},
    {"NoNumberAtAll", three, "true", "10:17", "'magnetization'"},
    {"TooStrong", "\"10 kA/m\"", "\"101 MA/m\"", "10:18", "'magnetization' is 1.01e+08 A/m"},
    {"OutOfTheElasticasPlane", "\"0 A/m\", \"-75", "\"1 A/m\", \"-75", "20:14",
     "along the azimuth 0 deg, and the magnetisation in the field points out of it",
     "use 'beam' or 'solid'"},
    {"StackedLoops", "method = \"closed_form\"", "slices = \"stacked\"", "23:10",
     "the slices \"stacked\" have a closed form for an axial magnetisation only",
     "take \"wedge\", or the method \"quadrature\""},
};

INSTANTIATE_TEST_SUITE_P(Magnetization, BadMagnetizationCase, testing::ValuesIn(bad_magnetizations),
                         name_of);

TEST(MagnetizationCase, TheSolidTakesOneAzimuth) {
  const std::string path =
      replaced(replaced(across, "azimuth = \"0 deg\"", "azimuth = [\"0 deg\", \"180 deg\"]"),
               "\"elastica\", ", "");
  const std::string faults = faults_of(path);
  EXPECT_TRUE(faults.starts_with("bad.toml:16:21: the solid takes a path of one azimuth"))
      << faults;
  EXPECT_EQ(faults_of(replaced(path, "\"beam\", \"solid\"", "\"beam\"")).find("azimuth"),
            std::string::npos);
}

}  // namespace
}  // namespace ciliaval::compare
