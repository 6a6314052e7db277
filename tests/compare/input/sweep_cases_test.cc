// SPDX-License-Identifier: LGPL-2.1-or-later
// Case files of a sweep: what they say, what is refused and where, and that they are written back.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <variant>

#include "compare/input/case.h"
#include "compare/models/registry.h"
#include "compare/study/case_number.h"
#include "tests/support/planted_fault.h"
#include "tests/support/same_case.h"
#include "tests/support/temporary_folder.h"

namespace ciliaval::compare {
namespace {

using namespace surroundings;
using testing::HasSubstr;

/// Counted by hand: [surface] begins in line 11, [load] in line 20, [signal] in line 27.
constexpr std::string_view good_sweep = R"([case]
name = "sweep"
[cilium]
diameter = "3 mm"
[[cilium.segment]]
name = "rod"
length = "20 mm"
young_modulus = "3 MPa"
poisson_ratio = 0.49
magnetization = "75 kA/m"
[surface]
profile = "trapezoid"
height = "1 mm"
top = "10 mm"
bottom = "10 mm"
flank = "1 mm"
radius = "0.5 mm"
friction = 0.3
tilt = "1 deg"
[load]
type = "sweep"
interference = "1 mm"
travel = "30 mm"
samples = 31
return = true
azimuth = "30 deg"
[signal]
sampling_rate = "100 Hz"
noise = "1 uT"
cutoff = "1 Hz"
[sensor]
position = ["0 mm", "0 mm", "-1.55 mm"]
[models]
mechanics = ["elastica"]
fields = ["line"]
)";

TEST(SweepCase, SaysWhereTheSurfaceGoes) {
  const input::Case c = read(good_sweep);
  ASSERT_EQ(c.load_path.size(), 61U);
  const auto at = [&](std::size_t i) { return c.load_path[i].as<SweepLoad>().value(); };
  EXPECT_EQ(at(0).travel, 0);
  EXPECT_DOUBLE_EQ(at(10).travel, 0.01);
  EXPECT_EQ(at(30).travel, 0.03);
  EXPECT_EQ(at(50).travel, at(10).travel);
  EXPECT_EQ(at(60).travel, 0);
  EXPECT_EQ(at(7).interference, 1e-3);
  EXPECT_EQ(at(7).speed, 0.01);
  const Surface& surface = *c.load_path[7].surface();
  EXPECT_EQ(surface.friction, 0.3);
  EXPECT_EQ(std::get<TrapezoidProfile>(surface.profile).radius, 0.5e-3);
  ASSERT_TRUE(c.signal);
  EXPECT_EQ(c.signal->order, 4U);
}

TEST(SweepCase, TakesAClearanceForAMinus) {
  const input::Case c =
      read(replaced(good_sweep, "interference = \"1 mm\"", "clearance = \"0.25 mm\""));
  EXPECT_EQ(c.load_path.back().as<SweepLoad>()->interference, -0.25e-3);
  EXPECT_EQ(c.stated_by.size(), c.load_path.size());
}

TEST(SweepCase, ListsMakeAnyPath) {
  const input::Case c =
      read(replaced(replaced(good_sweep, "samples = 31\nreturn = true\n", ""), "travel = \"30 mm\"",
                    "travel = [\"0 mm\", \"2 mm\", \"1 mm\"]"));
  ASSERT_EQ(c.load_path.size(), 3U);
  EXPECT_EQ(c.load_path[2].as<SweepLoad>()->travel, 1e-3);
}

TEST(SweepCase, IsWrittenBack) {
  for (const std::string& text :
       {std::string(good_sweep), replaced(good_sweep, "return = true\n", ""),
        replaced(good_sweep, "interference = \"1 mm\"", "clearance = \"0.25 mm\""),
        replaced(replaced(good_sweep, "samples = 31\nreturn = true\n", ""), "travel = \"30 mm\"",
                 "travel = [\"0 mm\", \"2 mm\", \"1 mm\"]"),
        replaced(replaced(replaced(good_sweep, "samples = 31\nreturn = true\n", ""),
                          "travel = \"30 mm\"", "travel = [\"2 mm\"]"),
                 "[signal]\nsampling_rate = \"100 Hz\"\nnoise = \"1 uT\"\ncutoff = \"1 Hz\"\n", ""),
        replaced(good_sweep,
                 "\"trapezoid\"\nheight = \"1 mm\"\ntop = \"10 mm\"\nbottom = \"10 mm\"\nflank = "
                 "\"1 mm\"\nradius = \"0.5 mm\"",
                 "\"random\"\nrms = \"20 um\"\nhurst = 0.8\nlongest = \"5 mm\"\nshortest = \"0.5 "
                 "mm\"\nseed = 4000000000")}) {
    const input::Case first = read(text);
    const input::Case second = expect_read_back(first);
    for (const double x : {-0.02, -0.0131, 0.001, 0.0077})
      EXPECT_EQ(first.load_path[0].surface()->at(x).height,
                second.load_path[0].surface()->at(x).height);
  }
}

TEST(SweepCase, StudiesMayVaryTheSurface) {
  const input::Case c = read(good_sweep);
  const input::Case other = varied(
      c, {{"surface.friction", 0.5}, {"surface.radius", 0.2e-3}, {"load.interference", 2e-3}});
  EXPECT_EQ(other.load_path[40].surface()->friction, 0.5);
  EXPECT_EQ(std::get<TrapezoidProfile>(other.load_path[40].surface()->profile).radius, 0.2e-3);
  EXPECT_EQ(std::get<TrapezoidProfile>(other.load_path[40].surface()->profile).top, 10e-3);
  EXPECT_EQ(other.load_path[40].as<SweepLoad>()->interference, 2e-3);
  EXPECT_EQ(c.load_path[40].surface()->friction, 0.3);
}

class BadSweepCase : public testing::TestWithParam<PlantedFault> {};

TEST_P(BadSweepCase, IsRefusedWithOneLocatedMessage) {
  expect_refused(good_sweep, GetParam());
}

const PlantedFault bad_sweeps[]{
    {"NegativeFriction", "friction = 0.3", "friction = -0.1", "18:12",
     "Coulomb's coefficient is not negative"},
    {"FrictionNotFinite", "friction = 0.3", "friction = nan", "18:12", "must be finite"},
    {"SteepTilt", "tilt = \"1 deg\"", "tilt = \"50 deg\"", "19:8", "cannot be swept over"},
    {"InterferenceBeyondTheTip", "\"1 mm\"\ntravel", "\"20 mm\"\ntravel", "22:16",
     "must be less than the length"},
    {"InterferenceOfAForce", "\"1 mm\"\ntravel", "\"1 mN\"\ntravel", "22:16", "length"},
    {"NeitherInterferenceNorClearance", "interference = \"1 mm\"\n", "", "20:1",
     "needs 'interference' or 'clearance'"},
    {"NegativeTravel", "travel = \"30 mm\"", "travel = \"-30 mm\"", "23:10", "'travel' is -0.03 m"},
    {"OneSample", "samples = 31", "samples = 1", "24:11", "'samples' is 1"},
    {"HalfASample", "samples = 31", "samples = 3.5", "24:11", "whole number"},
    {"ReturnIsNoFlag", "return = true", "return = \"yes\"", "25:10", "must be true or false"},
    {"SamplesOfAList", "\"30 mm\"\nsamples = 31\nreturn = true",
     "[\"0 mm\", \"1 mm\"]\nsamples = 31", "24:11", "contradicts the list 'travel'"},
    {"UnknownProfile", "\"trapezoid\"", "\"trapezium\"", "12:11", "did you mean 'trapezoid'?"},
    {"ZeroRadius", "radius = \"0.5 mm\"", "radius = \"0 mm\"", "17:10", "'radius' is 0 m"},
    {"RadiusTooLarge", "radius = \"0.5 mm\"", "radius = \"9 mm\"", "11:1",
     "choose a smaller radius"},
    {"UnknownKey", "tilt = \"1 deg\"", "edge = \"1 mm\"", "19:1",
     "unknown key 'edge' in [surface]"},
    {"UnknownType", "type = \"sweep\"", "type = \"swep\"", "21:8", "did you mean 'sweep'?"},
    {"CutoffAboveTheNyquistFrequency", "\"100 Hz\"", "\"1 Hz\"", "30:10",
     "must be below half the 'sampling_rate'"},
    {"TooManySamples", "\"100 Hz\"", "\"1 GHz\"", "28:17", "samples, more than 1e+06"},
    {"OneSampleOfTheRecord", "\"100 Hz\"\nnoise = \"1 uT\"\ncutoff = \"1 Hz\"", "\"0.1 Hz\"",
     "28:17", "makes 1 sample: the record needs more than 1"},
    {"FewSamplesForTheFilter", "\"100 Hz\"\nnoise = \"1 uT\"\ncutoff = \"1 Hz\"",
     "\"2 Hz\"\ncutoff = \"0.5 Hz\"\nphase = \"zero_phase\"", "28:17",
     "makes 13 samples: the record needs more than 15"},
    {"OrderWithoutCutoff", "cutoff = \"1 Hz\"", "order = 3", "30:9", "'order' goes with 'cutoff'"},
    {"NoiseIsNoField", "noise = \"1 uT\"", "noise = \"1 mm\"", "29:9", "flux density"},
};

INSTANTIATE_TEST_SUITE_P(Sweeps, BadSweepCase, testing::ValuesIn(bad_sweeps), name_of);

TEST(SweepCase, NeedsItsSurfaceAndNoOtherLoadHasOne) {
  const std::string text(good_sweep);
  const std::size_t from = text.find("[surface]");
  const std::size_t to = text.find("[load]");
  EXPECT_THAT(faults_of(std::string(text).erase(from, to - from)),
              HasSubstr("the table [surface] is missing"));
  EXPECT_THAT(faults_of(std::string(good_case) + "[surface]\nprofile = \"flat\"\n"),
              HasSubstr("[surface] goes with the load type 'sweep', not 'contact'"));
  EXPECT_THAT(faults_of(std::string(good_case) + "[signal]\nsampling_rate = \"9 Hz\"\n"),
              HasSubstr("[signal] goes with the load type 'sweep'"));
}

class ProfileFile : public testing::Test {
 protected:
  std::string text(std::string_view csv) const {
    const std::string path = folder_.write("profile.csv", csv).string();
    return replaced(good_sweep,
                    "\"trapezoid\"\nheight = \"1 mm\"\ntop = \"10 mm\"\nbottom = \"10 "
                    "mm\"\nflank = \"1 mm\"\nradius = \"0.5 mm\"",
                    "\"file\"\npath = \"" + path + "\"");
  }
  test::TemporaryFolder folder_;
};

TEST_F(ProfileFile, RunsAlongTheWayOfTheTip) {
  const input::Case c = read(
      text("x [mm], height [um]\n-20, 0\n-10, 0\n0, 0\n5, 100\n10, 200\n20, 0\n30, 0\n40, 0\n"));
  const Surface& surface = *c.load_path[0].surface();
  EXPECT_NEAR(surface.at(-10e-3).height - std::tan(surface.tilt) * -10e-3, 200e-6, 1e-15);
  EXPECT_EQ(read(input::to_toml(c, models::known())).surface->file, c.surface->file);
}

TEST(SweepCase, TakesNoCorrectedJoints) {
  EXPECT_THAT(faults_of(std::string(good_sweep) + "[models.elastica]\njoints = \"corrected\"\n"),
              HasSubstr("bad.toml:37:10: the corrected joints take no sweep"));
}

TEST_F(ProfileFile, IsRefusedWithItsPlace) {
  const auto said = [&](std::string_view csv) { return faults_of(text(csv)); };
  EXPECT_THAT(said("x [mm], height [um]\n0, 0\n1, 0\n"), HasSubstr("4 points or more, not 2"));
  EXPECT_THAT(said("x [mm], height [um]\n0, 0\n2, 0\n1, 0\n3, 0\n"),
              HasSubstr("profile.csv:4:1: x must increase"));
  EXPECT_THAT(said("x [mm], height [um]\n0, 0\n2, nan\n4, 0\n5, 0\n"), HasSubstr("profile.csv:3:"));
  EXPECT_THAT(said("x, height\n0, 0\n2, 1\n4, 0\n5, 0\n"), HasSubstr("profile.csv:1:"));
  EXPECT_THAT(said("x [mm], height [um]\n-20, 0\n1, 0\n5, 0\n20, 0\n"),
              HasSubstr("the profile goes from x = -0.02 m to 0.02 m, but the sweep from 0 m to "
                        "0.03 m"));
}

}  // namespace
}  // namespace ciliaval::compare
