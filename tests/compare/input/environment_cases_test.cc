// SPDX-License-Identifier: LGPL-2.1-or-later
// Case files with [environment]: what they say, what is refused and where, and that they are
// written back.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <initializer_list>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compare/input/case.h"
#include "compare/models/registry.h"
#include "tests/support/planted_fault.h"
#include "tests/support/same_case.h"

namespace ciliaval::compare {
namespace {

using surroundings::Environment;
using surroundings::MagneticEnergy;
using testing::HasSubstr;
using testing::StartsWith;

/// Counted by hand: the segments begin in the lines 5 and 11, [environment] in line 18, [models] in
/// line 23.
constexpr std::string_view weight_and_field = R"([case]
name = "around"
[cilium]
diameter = "3 mm"
[[cilium.segment]]
name = "base"
length = "3 mm"
young_modulus = "0.1 MPa"
poisson_ratio = 0.49
density = "1 g/cm^3"
[[cilium.segment]]
name = "magnet"
length = "17 mm"
young_modulus = "3 MPa"
poisson_ratio = 0.49
magnetization = "75 kA/m"
density = "3000 kg/m^3"
[environment]
gravity = ["0 m/s2", "0 m/s2", "-9.81 m/s2"]
fluid_density = "997 kg/m^3"
uniform_field = ["0 mT", "10 mT", "2 mT"]
magnetic_energy = "R"
[models]
mechanics = ["elastica", "beam"]
)";

constexpr std::string_view one_field = R"(["0 mT", "10 mT", "2 mT"])";
constexpr std::string_view three_fields =
    R"([["0 mT", "0 mT", "0 mT"], ["0 mT", "0 mT", "1 mT"], ["0 mT", "-10 mT", "2 mT"]])";

std::string loaded(std::string_view load, std::string_view text = weight_and_field) {
  return replaced(text, "[models]", std::string("[load]\n").append(load).append("\n[models]"));
}

TEST(EnvironmentCase, ActsAloneWithoutALoad) {
  const input::Case c = read(weight_and_field);
  EXPECT_EQ(c.cilium.segments[0].density, 1000);
  EXPECT_EQ(c.cilium.segments[1].density, 3000);
  ASSERT_EQ(c.load_path.size(), 1U);
  const Load& load = c.load_path.front();
  ASSERT_TRUE(load.is<EnvironmentLoad>());
  EXPECT_EQ(load.as<EnvironmentLoad>()->scale, 1);
  // The elastica bends in the plane of the field.
  EXPECT_DOUBLE_EQ(azimuth(load), std::numbers::pi / 2);
  const Environment& around = load.environment();
  EXPECT_EQ(around.gravity, Vector3(0, 0, -9.81));
  EXPECT_EQ(around.fluid_density, 997);
  EXPECT_EQ(around.uniform_field, Vector3(0, 0.01, 0.002));
  EXPECT_EQ(around.magnetic_energy, MagneticEnergy::R);
}

TEST(EnvironmentCase, AListOfFieldsIsAPath) {
  const input::Case c = read(replaced(weight_and_field, one_field, three_fields));
  ASSERT_EQ(c.load_path.size(), 3U);
  const std::vector<Vector3> fields{Vector3(0, 0, 0), Vector3(0, 0, 0.001),
                                    Vector3(0, -0.01, 0.002)};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(c.load_path[i].environment().uniform_field, fields[i]);
    EXPECT_EQ(c.load_path[i].environment().gravity.z(), -9.81);
    // That of the strongest field, for every step.
    EXPECT_DOUBLE_EQ(azimuth(c.load_path[i]), -std::numbers::pi / 2);
  }
}

TEST(EnvironmentCase, BendsInThePlaneOfGravityWithoutAHorizontalField) {
  const auto azimuth_under = [](std::string_view gravity) {
    return azimuth(
        read(replaced(replaced(weight_and_field, one_field, R"(["0 mT", "0 mT", "2 mT"])"),
                      R"(["0 m/s2", "0 m/s2", "-9.81 m/s2"])", gravity))
            .load_path.front());
  };
  EXPECT_DOUBLE_EQ(azimuth_under(R"(["-1 m/s2", "-1 m/s2", "0 m/s2"])"), -0.75 * std::numbers::pi);
  EXPECT_EQ(azimuth_under(R"(["0 m/s2", "0 m/s2", "-1 m/s2"])"), 0);
}

TEST(EnvironmentCase, SurroundsEveryStepOfALoad) {
  const input::Case c =
      read(loaded("type = \"contact\"\nforce = [\"1 mN\", \"2 mN\"]\nheight = \"16 "
                  "mm\"\nazimuth = \"90 deg\""));
  ASSERT_EQ(c.load_path.size(), 2U);
  for (const Load& load : c.load_path) {
    EXPECT_TRUE(load.is<ContactLoad>());
    EXPECT_EQ(load.environment().uniform_field.y(), 0.01);
  }
}

TEST(EnvironmentCase, GivesEachStepItsField) {
  const std::string text = replaced(weight_and_field, one_field, three_fields);
  const input::Case listed =
      read(loaded("type = \"section\"\nforce = [\"1 mN\", \"2 mN\", \"3 mN\"]\narclength = \"20 "
                  "mm\"\nazimuth = "
                  "\"90 deg\"",
                  text));
  ASSERT_EQ(listed.load_path.size(), 3U);
  EXPECT_EQ(magnitude(listed.load_path[2]), 3e-3);
  EXPECT_EQ(listed.load_path[2].environment().uniform_field.y(), -0.01);
  const input::Case single =
      read(loaded("type = \"flow\"\nvelocity = \"0.5 m/s\"\nazimuth = \"90 deg\"", text));
  ASSERT_EQ(single.load_path.size(), 3U);
  EXPECT_EQ(magnitude(single.load_path[2]), magnitude(single.load_path[0]));
  EXPECT_EQ(single.load_path[1].environment().uniform_field.z(), 0.001);
  EXPECT_EQ(single.stated_by.size(), 3U);
}

TEST(EnvironmentCase, AListOfOneFieldStandsForAllSteps) {
  const std::string text =
      replaced(weight_and_field, one_field, "[[\"0 mT\", \"10 mT\", \"1 mT\"]]");
  const input::Case c =
      read(loaded("type = \"section\"\nforce = [\"1 mN\", \"2 mN\"]\narclength = \"20 mm\"\n"
                  "azimuth = \"90 deg\"",
                  text));
  ASSERT_EQ(c.load_path.size(), 2U);
  EXPECT_EQ(c.load_path[1].environment().uniform_field.y(), 0.01);
}

TEST(EnvironmentCase, ScalesMakeAPath) {
  const input::Case c =
      read(loaded("type = \"environment\"\nscale = [0, 0.5, 1]\nazimuth = \"90 deg\""));
  ASSERT_EQ(c.load_path.size(), 3U);
  EXPECT_EQ(acting_environment(c.load_path[1]).uniform_field.y(), 0.005);
}

TEST(EnvironmentCase, IsWrittenBack) {
  const std::string contact =
      "type = \"contact\"\nforce = [\"1 mN\", \"2 mN\", \"4 mN\"]\nheight = \"16 mm\"\nazimuth = "
      "\"90 deg\"";
  const std::string fields = replaced(weight_and_field, one_field, three_fields);
  const std::string field_alone =
      replaced(replaced(fields, "fluid_density = \"997 kg/m^3\"\n", ""),
               "gravity = [\"0 m/s2\", \"0 m/s2\", \"-9.81 m/s2\"]\n", "");
  const std::string weight_alone =
      replaced(replaced(weight_and_field, "uniform_field = [\"0 mT\", \"10 mT\", \"2 mT\"]\n", ""),
               "magnetic_energy = \"R\"\n", "");
  for (const std::string& text :
       {std::string(weight_and_field), fields, field_alone, weight_alone, loaded(contact),
        loaded(contact, fields), loaded(contact, weight_alone),
        loaded("type = \"flow\"\nvelocity = \"0.5 m/s\"\nazimuth = \"90 deg\"", fields),
        replaced(weight_alone, "-9.81", "0"),
        replaced(weight_and_field, one_field, R"(["0 mT", "0 mT", "0 mT"])"),
        replaced(field_alone, three_fields, R"(["0 mT", "0 mT", "0 mT"])")}) {
    const input::Case again = expect_read_back(text);
    EXPECT_EQ(again.cilium.segments[0].density, 1000);
    EXPECT_EQ(again.cilium.segments[1].density, 3000);
  }
}

TEST(EnvironmentCase, StudiesMayVaryIt) {
  const input::Case other = varied(read(weight_and_field), {{"cilium.segment.magnet.density", 4000},
                                                            {"environment.fluid_density", 10},
                                                            {"environment.gravity.z", -1.6},
                                                            {"environment.uniform_field.y", 0.02},
                                                            {"load.scale", 0.5}});
  EXPECT_EQ(other.cilium.segments[1].density, 4000);
  const Environment& around = other.load_path.front().environment();
  EXPECT_EQ(around.fluid_density, 10);
  EXPECT_EQ(around.gravity, Vector3(0, 0, -1.6));
  EXPECT_EQ(around.uniform_field, Vector3(0, 0.02, 0.002));
  EXPECT_EQ(other.load_path.front().as<EnvironmentLoad>()->scale, 0.5);
}

class BadEnvironmentCase : public testing::TestWithParam<PlantedFault> {};

TEST_P(BadEnvironmentCase, IsRefusedWithOneLocatedMessage) {
  expect_refused(weight_and_field, GetParam());
}

const PlantedFault bad_environments[]{
    {"NoDensity", "density = \"1 g/cm^3\"\n", "", "5:1", "the segment 'base' needs a 'density'"},
    {"NegativeDensity", "1 g/cm^3", "-1 g/cm^3", "10:11", "'density' is -1000 kg/m^3"},
    {"DensityIsNoPressure", "1 g/cm^3", "1 Pa", "10:11", "density"},
    {"NegativeFluidDensity", "997", "-997", "20:17", "'fluid_density' is -997 kg/m^3"},
    {"FluidWithoutGravity", "gravity = [\"0 m/s2\", \"0 m/s2\", \"-9.81 m/s2\"]\n", "", "19:17",
     "'fluid_density' goes with 'gravity', which is missing"},
    {"GravityWithoutUnit", "\"-9.81 m/s2\"", "-9.81", "19:32",
     "has no unit: write an acceleration, such as \"-9.81 m/s2\""},
    {"GravityIsNoField", "-9.81 m/s2", "-9.81 T", "19:32", "acceleration"},
    {"GravityIsNoNumber", "[\"0 m/s2\", \"0 m/s2\", \"-9.81 m/s2\"]", "\"9.81 m/s2\"", "19:11",
     "'gravity' must have three components along x, y and z"},
    {"GravityHasTwo", "\"0 m/s2\", \"0 m/s2\", ", "\"0 m/s2\", ", "19:11",
     "'gravity' must have three components"},
    {"GravityTooLarge", "-9.81 m/s2", "-9.81 km/ms2", "19:32", "'gravity' is"},
    {"FieldWithoutUnit", "\"10 mT\"", "0.01", "21:26",
     "has no unit: write a flux density, such as"},
    {"FieldIsNoMagnetization", "10 mT", "10 kA/m", "21:26", "flux density"},
    {"FieldHasFour", "\"10 mT\", ", "\"10 mT\", \"1 mT\", ", "21:17",
     "'uniform_field' must have three components"},
    {"FieldTooStrong", "10 mT", "101 T", "21:26", "'uniform_field' is 101 T"},
    {"NoFields", one_field, "[]", "21:17", "'uniform_field' lists 0 values"},
    {"FieldInAList", one_field, "[[\"1 mT\", \"1 mT\", \"1 mT\"], \"1 mT\"]", "21:44",
     "'uniform_field' must have three components"},
    {"EnergyWithoutField", "uniform_field = [\"0 mT\", \"10 mT\", \"2 mT\"]\n", "", "21:19",
     "'magnetic_energy' goes with 'uniform_field', which is missing"},
    {"UnknownEnergy", "\"R\"", "\"G\"", "22:19", "'magnetic_energy' cannot be 'G' (valid: F, R)"},
    {"FieldWithoutMagnet", "magnetization = \"75 kA/m\"\n", "", "20:17",
     "'uniform_field' needs a magnet: no [[cilium.segment]] has a 'magnetization'"},
    {"UnknownKey", "fluid_density", "fluid_densty", "20:1", "did you mean 'fluid_density'?"},
    {"OutOfTheElasticasPlane", "[\"0 m/s2\"", "[\"1 m/s2\"", "24:14",
     "the elastica bends in the plane of the load, along the azimuth 90 deg"},
    {"AnotherModel", "[models]\nmechanics = [\"elastica\", \"beam\"]",
     "[load]\ntype = \"dead\"\nforce_per_length = \"0.1 N/m\"\n[models]\nmechanics = "
     "[\"beam\", \"calculix\"]",
     "27:22", "calculix takes no [environment]"},
    {"BesideASweep", "[models]",
     "[surface]\nprofile = \"flat\"\n[load]\ntype = \"sweep\"\ninterference = \"1 mm\"\ntravel = "
     "\"1 mm\"\nazimuth = \"90 deg\"\n[models]",
     "18:1", "no model takes an environment beside the load type 'sweep'"},
};

INSTANTIATE_TEST_SUITE_P(Environment, BadEnvironmentCase, testing::ValuesIn(bad_environments),
                         name_of);

// Faults of a case with a load beside the environment, whose table begins in line 23.
TEST(EnvironmentCase, IsRefusedBesideALoadThatItDoesNotGoWith) {
  const std::string contact =
      "type = \"contact\"\nforce = \"1 mN\"\nheight = \"16 mm\"\nazimuth = \"90 deg\"";
  const std::string environment(weight_and_field.substr(
      weight_and_field.find("[environment]"),
      weight_and_field.find("[models]") - weight_and_field.find("[environment]")));
  for (const auto& [text, message] : std::initializer_list<std::pair<std::string, std::string>>{
           {loaded(replaced(contact, "\"1 mN\"", "[\"1 mN\", \"2 mN\"]"),
                   replaced(weight_and_field, one_field, three_fields)),
            "21:17: 'uniform_field' lists 3 values, but the load has 2 steps"},
           {replaced(loaded("type = \"section\"\nforce = \"1 mN\"\narclength = \"20 mm\""),
                     "[environment]", "[enviroment]"),
            "18:2: unknown key 'enviroment' in the case file (valid: case, cilium, load, "
            "environment, surface, sensor, readings, signal, models, measurement, "
            "input_uncertainty); did you mean 'environment'?"},
           {replaced(weight_and_field, weight_and_field.substr(weight_and_field.find("gravity")),
                     "[models]\nmechanics = [\"beam\"]\n"),
            "18:1: [environment] needs 'gravity', 'uniform_field' or [[environment.magnet]]"},
           {replaced(loaded("type = \"environment\"\nazimuth = \"90 deg\""), environment, ""),
            "19:8: the load type 'environment' needs the table [environment]"},
           {loaded(contact) + "[models.elastica]\nform = \"height\"\n",
            "31:8: the elastica's form 'height' (Eq. 1-4) takes no [environment]"},
           {loaded(contact) + "[models.elastica]\njoints = \"corrected\"\n",
            "31:10: the elastica takes no corrected joints in an [environment]: use 'beam'"}})
    EXPECT_THAT(faults_of(text), HasSubstr("bad.toml:" + message));
}

TEST(EnvironmentCase, ListsAThousandFieldsAtMost) {
  const auto with_fields = [](int count) {
    return faults_of(replaced(weight_and_field, one_field,
                              repeated(std::string(R"(["0 mT", "1 mT", "0 mT"])"), count)));
  };
  EXPECT_EQ(with_fields(1000), "");
  EXPECT_THAT(with_fields(1001), StartsWith("bad.toml:21:17: 'uniform_field' lists 1001 values"));
}

TEST(EnvironmentCase, TheElasticaTellsItsPlane) {
  const std::string text = loaded("type = \"environment\"\nazimuth = \"60 deg\"");
  EXPECT_THAT(faults_of(text),
              HasSubstr("along the azimuth 60 deg, and the environment points out of it: change "
                        "the azimuth, or use 'beam' or 'solid'"));
  EXPECT_EQ(faults_of(replaced(text, "\"elastica\", ", "")), "");
}

}  // namespace
}  // namespace ciliaval::compare
