// SPDX-License-Identifier: LGPL-2.1-or-later
// Case files with [cilium.section]: what they say, what is refused and where, and that they are
// written back.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>
#include <string>
#include <string_view>

#include "compare/input/case.h"
#include "compare/models/registry.h"
#include "compare/study/case_number.h"
#include "tests/support/planted_fault.h"
#include "tests/support/same_case.h"

namespace ciliaval::compare {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

/// Counted by hand: the section's table begins in line 4, [load] in line 16, [models] in line 23.
constexpr std::string_view plate = R"([case]
name = "plate"
[cilium]
[cilium.section]
shape = "rectangle"
width = "1 mm"
height = "5 mm"
orientation = "30 deg"
[[cilium.segment]]
name = "magnet"
length = "17 mm"
young_modulus = "3 MPa"
poisson_ratio = 0.49
magnetization = "75 kA/m"

[load]
type = "contact"
force = "1 mN"
height = "16 mm"
azimuth = "30 deg"
[sensor]
position = ["0 mm", "0 mm", "-2 mm"]
[models]
mechanics = ["elastica", "beam", "solid"]
fields = ["dipole", "line", "volume", "mesh"]
)";

constexpr std::string_view rectangle =
    "shape = \"rectangle\"\nwidth = \"1 mm\"\nheight = \"5 mm\"\norientation = \"30 deg\"";

std::string tube() {
  return replaced(replaced(plate, "[cilium]\n", "[cilium]\ndiameter = \"3 mm\"\n"), rectangle,
                  "shape = \"tube\"\ninner_diameter = \"1 mm\"");
}

TEST(SectionCase, IsARectangleOrATube) {
  const Cilium cilium = read(plate).cilium;
  EXPECT_EQ(cilium.section.shape, CrossSection::Shape::rectangle);
  EXPECT_EQ(cilium.section.width, 1e-3);
  EXPECT_EQ(cilium.section.height, 5e-3);
  EXPECT_DOUBLE_EQ(cilium.section.orientation, std::numbers::pi / 6);
  const Cilium hollow = read(tube()).cilium;
  EXPECT_EQ(hollow.section.shape, CrossSection::Shape::tube);
  EXPECT_EQ(hollow.diameter, 3e-3);
  EXPECT_EQ(hollow.section.inner_diameter, 1e-3);
  const std::string circle =
      replaced(tube(), "shape = \"tube\"\ninner_diameter = \"1 mm\"", "shape = \"circle\"");
  EXPECT_EQ(read(circle).cilium.section, CrossSection{});
}

TEST(SectionCase, IsWrittenBack) {
  expect_read_back(plate);
  expect_read_back(tube());
}

TEST(SectionCase, StudiesMayVaryItsSides) {
  const input::Case c = read(plate);
  for (const study::CaseNumber& number : study::case_numbers(c)) {
    EXPECT_NE(number.path, "cilium.diameter");
    EXPECT_NE(number.path, "cilium.aspect_ratio");
  }
  EXPECT_EQ(varied(c, {{"cilium.section.width", 2e-3}}).cilium.section.width, 2e-3);
}

class BadSectionCase : public testing::TestWithParam<PlantedFault> {};

TEST_P(BadSectionCase, IsRefusedWithOneLocatedMessage) {
  expect_refused(plate, GetParam());
}

const PlantedFault bad_sections[]{
    {"NoHeight", "height = \"5 mm\"\n", "", "4:1", "needs 'height'"},
    {"ZeroHeight", "\"5 mm\"", "\"0 mm\"", "7:10", "'height' is 0 m"},
    {"HeightWithoutUnit", "\"5 mm\"", "5", "7:10", "has no unit: write a length"},
    {"UnknownShape", "\"rectangle\"", "\"rectangel\"", "5:9", "did you mean 'rectangle'?"},
    {"NoShape", "shape = \"rectangle\"\n", "", "4:1", "needs 'shape'"},
    {"DiameterToo", "[cilium]\n", "[cilium]\ndiameter = \"3 mm\"\n", "4:12",
     "a rectangle has 'width' and 'height' in place of 'diameter'"},
    {"HoleOfARectangle", "orientation = \"30 deg\"", "inner_diameter = \"1 mm\"", "8:18",
     "'inner_diameter' goes with shape = \"tube\" only"},
    {"AlongNoSide", "azimuth = \"30 deg\"", "azimuth = \"40 deg\"", "20:11",
     "a rectangular cilium bends out of the load's plane"},
    {"TwoAzimuths", "azimuth = \"30 deg\"", "azimuth = [\"30 deg\", \"120 deg\"]", "20:22",
     "a rectangular cilium takes a path of one azimuth"},
    {"TooThin", "\"1 mm\"", "\"1 nm\"", "4:1", "diameters long"},
    {"Potential", "\"mesh\"]", "\"mesh\", \"potential\"]", "25:47",
     "potential takes circular sections only"},
    {"NotInClosedForm", "\"mesh\"]\n", "\"mesh\"]\n[models.volume]\nmethod = \"quadrature\"\n",
     "27:10", "a rectangle or a tube has the method \"closed_form\" only"},
    {"CorrectedJoints", "\"mesh\"]\n", "\"mesh\"]\n[models.beam]\njoints = \"corrected\"\n",
     "27:10", "circular"},
    {"Stacked", "\"mesh\"]\n", "\"mesh\"]\n[models.volume]\nslices = \"stacked\"\n", "27:10",
     "a rectangle or a tube has the slices \"wedge\" only"},
    {"Drag", "type = \"contact\"\nforce = \"1 mN\"\nheight = \"16 mm\"",
     "type = \"flow\"\nvelocity = \"1 m/s\"", "18:12", "state force_per_height"},
};

INSTANTIATE_TEST_SUITE_P(Sections, BadSectionCase, testing::ValuesIn(bad_sections), name_of);

TEST(SectionCase, TheHoleIsNarrowerThanTheTube) {
  EXPECT_THAT(faults_of(replaced(tube(), "\"1 mm\"", "\"3 mm\"")),
              StartsWith("bad.toml:7:18: the hole of a tube is narrower than its 'diameter'"));
  EXPECT_THAT(faults_of(replaced(tube(), "diameter = \"3 mm\"\n", "")),
              HasSubstr("needs 'diameter'"));
}

}  // namespace
}  // namespace ciliaval::compare
