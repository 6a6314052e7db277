// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <numbers>
#include <string>
#include <vector>

#include "analytic/body/mesh_field.h"
#include "analytic/elastica/elastica.h"
#include "analytic/rod/field_models.h"
#include "compare/input/case.h"
#include "compare/input/described.h"
#include "compare/models/registry.h"
#include "fem/beam/beam.h"
#include "fem/calculix/calculix_model.h"
#include "fem/potential/potential.h"
#include "fem/solid/solid_options.h"
#include "problem/error.h"
#include "tests/support/key_table.h"
#include "tests/support/same_case.h"

namespace ciliaval::compare {
namespace {

using testing::ElementsAre;

std::filesystem::path source(std::string_view file) {
  return std::filesystem::path(CILIAVAL_SOURCE_DIR) / file;
}

/// The good case with another load.
std::string with_load(std::string_view load) {
  std::string text(good_case);
  const std::size_t from = text.find("type = ");
  const std::size_t to = text.find("[sensor]");
  return text.replace(from, to - from, std::string(load) + "\n");
}

TEST(GoodCase, IsReadAsTheFileStatesIt) {
  const input::Case c = read(good_case);
  EXPECT_EQ(c.name, "good");
  EXPECT_EQ(c.title, "A case without a fault");
  EXPECT_EQ(c.cilium.diameter, 0.003);
  ASSERT_EQ(c.cilium.segments.size(), 2U);
  EXPECT_EQ(c.cilium.segments[0].name, "base");
  EXPECT_EQ(c.cilium.segments[0].length, 0.003);
  EXPECT_EQ(c.cilium.segments[0].young_modulus, 1e5);
  EXPECT_EQ(c.cilium.segments[0].poisson_ratio, 0.49);
  EXPECT_EQ(c.cilium.segments[0].magnetization, 0.0);
  EXPECT_EQ(c.cilium.segments[1].name, "magnet");
  EXPECT_EQ(c.cilium.segments[1].length, 0.017);
  EXPECT_EQ(c.cilium.segments[1].young_modulus, 3e6);
  EXPECT_EQ(c.cilium.segments[1].magnetization, 75000.0);
  ASSERT_EQ(c.load_path.size(), 3U);
  const std::array forces{0.001, 0.002, 0.004};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto contact = *c.load_path[i].as<ContactLoad>();
    EXPECT_EQ(contact.force, forces[i]);
    EXPECT_EQ(contact.height, 0.016);
    EXPECT_NEAR(contact.azimuth, std::numbers::pi / 6, 2.3e-16);  // two roundings
  }
  EXPECT_THAT(c.stated_by, testing::IsEmpty());
  EXPECT_THAT(c.sensors, ElementsAre(Vector3(-0.0001, 0.0002, -0.00155)));
  EXPECT_THAT(c.mechanics, ElementsAre("elastica", "beam", "solid"));
  EXPECT_THAT(c.fields, ElementsAre("dipole", "line", "volume", "mesh"));
}

TEST(GoodCase, DotsInCommentsAndTextsAreNoDottedKeys) {
  const std::string dots = [] {
    std::string text;
    for (int i = 0; i < 40; ++i) text += " .";
    return text;
  }();
  const input::Case reference = read(good_case);
  expect_same(read("# don't" + dots + "\n" + std::string(good_case)), reference);
  expect_same(read(replaced(good_case, "\"3 mm\"\n", "\"3 mm\" # see \"" + dots + "\n")),
              reference);
  const auto titled = [](const std::string& title) {
    return read(replaced(good_case, "\"A case without a fault\"", title)).title;
  };
  EXPECT_EQ(titled("\"" + dots + "\""), dots);
  EXPECT_EQ(titled("\"\\\"" + dots + "\""), "\"" + dots);
  EXPECT_EQ(titled("'\\' #" + dots), "\\");
  EXPECT_EQ(titled("\"\"\"\\\n  it's\"\"" + dots + "\"\"\"\"\"" + " #" + dots),
            "it's\"\"" + dots + "\"\"");
}

TEST(GoodCase, AzimuthMayBeTwoTurns) {
  for (const char* turns : {"720 deg", "-720 deg", "2 turn"})
    EXPECT_NEAR(std::abs(azimuth(read(replaced(good_case, "30 deg", turns)).load_path[0])),
                4 * std::numbers::pi, 1e-14);
}

TEST(GoodCase, LeavesTheModelsTheirDefaults) {
  const input::Case c = read(replaced(good_case, "[models.solid]\nrefinement = 1\n", ""));
  for (const auto& [model, option] : all_options())
    EXPECT_EQ(option.get(c.options), option.get(input::ModelOptions{}))
        << model << '.' << option.name;
}

TEST(GoodCase, LoadsBroadcastSingleValuesAlongThePath) {
  const input::Case c =
      read(with_load("type = \"contact\"\nforce = \"1 mN\"\nheight = [\"4 mm\", \"8 mm\"]"
                     "\nazimuth = [\"0 deg\", \"-1 rad\"]"));
  ASSERT_EQ(c.load_path.size(), 2U);
  EXPECT_EQ(c.load_path[0].as<ContactLoad>()->force, 0.001);
  EXPECT_EQ(c.load_path[1].as<ContactLoad>()->force, 0.001);
  EXPECT_EQ(c.load_path[0].as<ContactLoad>()->height, 0.004);
  EXPECT_EQ(c.load_path[1].as<ContactLoad>()->height, 0.008);
  EXPECT_EQ(c.load_path[1].as<ContactLoad>()->azimuth, -1.0);
}

TEST(GoodCase, AzimuthIsZeroByDefault) {
  const input::Case c = read(replaced(good_case, "azimuth = \"30 deg\"\n", ""));
  EXPECT_EQ(azimuth(c.load_path.front()), 0.0);
}

TEST(GoodCase, VelocityBecomesTheDragOfThePaper) {
  // Oracle: the paper's section 3.5: q_max = 0.375 N/m for v = 0.5 m/s, d = 3 mm, water, C_d = 1.
  const input::Case c = read(with_load("type = \"flow\"\nvelocity = [\"0 m/s\", \"0.5 m/s\"]"));
  EXPECT_EQ(c.load_path[0].as<FlowLoad>()->force_per_height, 0.0);
  EXPECT_NEAR(c.load_path[1].as<FlowLoad>()->force_per_height, 0.375, 1e-16);
  EXPECT_THAT(input::stated_values(c, "velocity"), ElementsAre(0.0, 0.5));
  // Linear in density and drag coefficient: 0.8 · 1.2 · 0.375.
  const input::Case oil =
      read(with_load("type = \"flow\"\nvelocity = \"0.5 m/s\"\ndensity = \"0.8 "
                     "g/cm^3\"\ndrag_coefficient = 1.2"));
  EXPECT_NEAR(oil.load_path[0].as<FlowLoad>()->force_per_height, 0.36, 2e-16);
}

TEST(GoodCase, OtherLoadsAreRead) {
  const input::Case flow = read(with_load("type = \"flow\"\nforce_per_height = \"0.3 N/m\""));
  EXPECT_EQ(flow.load_path[0].as<FlowLoad>()->force_per_height, 0.3);
  EXPECT_THAT(flow.stated_by, testing::IsEmpty());
  const input::Case dead = read(with_load("type = \"dead\"\nforce_per_length = \"0.3 mN/mm\""));
  EXPECT_NEAR(dead.load_path[0].as<DeadLoad>()->force_per_length, 0.3, 6e-17);
  const input::Case section =
      read(with_load("type = \"section\"\nforce = \"1 mN\"\narclength = \"5 mm\""));
  EXPECT_EQ(section.load_path[0].as<SectionLoad>()->force, 0.001);
  EXPECT_EQ(section.load_path[0].as<SectionLoad>()->arclength, 0.005);
  // A displacement of more than the cilium's length is no fault: it slips off.
  const input::Case probe = read(with_load(
      "type = \"probe\"\ndisplacement = [\"0 mm\", \"2 mm\", \"1 m\"]\nheight = \"16 mm\""));
  ASSERT_EQ(probe.load_path.size(), 3U);
  EXPECT_EQ(probe.load_path[1].as<ProbeLoad>()->displacement, 0.002);
  EXPECT_EQ(probe.load_path[2].as<ProbeLoad>()->displacement, 1.0);
  EXPECT_EQ(probe.load_path[1].as<ProbeLoad>()->height, 0.016);
}

TEST(GoodCase, ASectionAtTheTipIsAtTheTipInSpiteOfRounding) {
  // 0.1 + 0.2 > 0.3 and 0.7 + 0.1 < 0.8 in double precision.
  const std::array<std::array<std::string_view, 3>, 2> lengths{
      {{"0.1 m", "0.2 m", "0.3 m"}, {"0.7 m", "0.1 m", "0.8 m"}}};
  for (const auto& [first, second, tip] : lengths) {
    std::string text =
        with_load("type = \"section\"\nforce = \"1 mN\"\narclength = \"" + std::string(tip) + "\"");
    text = replaced(text, "length = \"3 mm\"", "length = \"" + std::string(first) + "\"");
    text = replaced(text, "length = \"17 mm\"", "length = \"" + std::string(second) + "\"");
    const input::Case c = read(text);
    EXPECT_EQ(c.load_path[0].as<SectionLoad>()->arclength, c.cilium.length());
  }
}

TEST(GoodCase, SensorsMayBeAList) {
  const input::Case c =
      read(replaced(good_case, "[\"-0.1 mm\", \"0.2 mm\", \"-1.55 mm\"]",
                    "[[\"1 mm\", \"2 mm\", \"3 mm\"], [\"0 m\", \"0 m\", \"-1 m\"]]"));
  EXPECT_THAT(c.sensors, ElementsAre(Vector3(0.001, 0.002, 0.003), Vector3(0, 0, -1)));
}

TEST(GoodCase, SensorsMayHaveNames) {
  const std::string text =
      replaced(good_case, "[sensor]\nposition = [\"-0.1 mm\", \"0.2 mm\", \"-1.55 mm\"]\n",
               "[[sensor]]\nname = \"left\"\nposition = [\"1 mm\", \"2 mm\", \"3 mm\"]\n"
               "[[sensor]]\nname = \"right\"\nposition = [\"0 m\", \"0 m\", \"-1 m\"]\n");
  const input::Case c = read(text);
  EXPECT_THAT(c.sensors, ElementsAre(Vector3(0.001, 0.002, 0.003), Vector3(0, 0, -1)));
  EXPECT_THAT(input::sensor_names(c), ElementsAre("left", "right"));
  expect_read_back(c);
  EXPECT_THAT(input::sensor_names(read(std::string(good_case))), ElementsAre("0"));
}

TEST(GoodCase, SaysHowReadingsAreRead) {
  const input::Case c = read(std::string(good_case) +
                             "[readings]\nunit = \"mG\"\nmap = \"bx=Ch 1, by=Ch 2, bz=Ch 3\"\n"
                             "scale = \"0.15 uT\"\nunloaded = \"0 s..1 s\"\n");
  EXPECT_EQ(c.readings.unit.text, "mG");
  EXPECT_THAT(c.readings.unit.where, testing::EndsWith(":37:8: [readings] unit"));
  EXPECT_EQ(c.readings.unloaded.text, "0 s..1 s");
  expect_read_back(c);
}

TEST(GoodCase, NeedsNoSensorWithoutFields) {
  std::string text =
      replaced(good_case, "fields = [\"dipole\", \"line\", \"volume\", \"mesh\"]\n", "");
  text = replaced(text, "[sensor]\nposition = [\"-0.1 mm\", \"0.2 mm\", \"-1.55 mm\"]\n", "");
  text = replaced(text, "magnetization = \"75 kA/m\"\n", "");
  const input::Case c = read(text);
  EXPECT_THAT(c.fields, testing::IsEmpty());
  EXPECT_THAT(c.sensors, testing::IsEmpty());
}

TEST(GoodCase, MagnetizationMayPointToTheBase) {
  EXPECT_EQ(
      read(replaced(good_case, "\"75 kA/m\"", "\"-75 kA/m\"")).cilium.segments[1].magnetization,
      -75000.0);
}

TEST(GoodCase, NumbersOfSegmentsVary) {
  std::string text(good_case);
  std::string more;
  for (int i = 0; i < 5; ++i)
    more += "[[cilium.segment]]\nname = \"s" + std::to_string(i) +
            "\"\nlength = \"1 mm\"\nyoung_modulus = \"1 GPa\"\npoisson_ratio = 0\n";
  const input::Case c = read(replaced(text, "[load]", more + "[load]"));
  ASSERT_EQ(c.cilium.segments.size(), 7U);
  EXPECT_EQ(c.cilium.segments[6].name, "s4");
  EXPECT_EQ(c.cilium.segments[6].poisson_ratio, 0.0);
}

constexpr std::string_view all_option_lines = R"toml(
[models.elastica]
form = "height"
tip = "point"
joints = "none"
tolerance = 1e-9
[models.beam]
degree = 2
refinement = 4
shear_rigid = true
joints = "corrected"
tip = "point"
tolerance = 1e-8
max_iterations = 11
max_cutbacks = 3
[models.calculix]
refinement = 3
error_estimate = false
first_increment = 0.1
threads = 3
time_limit = "10 min"
program = "/opt/ccx"
keep = "/somewhere"
[models.solid]
material = "yeoh"
yeoh_ratios = [-0.2, 0.03]
refinement = 2
initial_guess = "none"
solver = "iterative"
symmetry = false
kernel_width = "0.25 mm"
newton_tolerance = 1e-7
max_iterations = 12
max_cutbacks = 4
[models.dipole]
push_forward = "R"
[models.line]
push_forward = "R"
method = "quadrature"
tolerance = 1e-6
[models.volume]
slices = "stacked"
method = "quadrature"
tolerance = 1e-5
[models.mesh]
push_forward = "R"
tolerance = 1e-4
[models.potential]
relative_permeability = 1.2
push_forward = "R"
tolerance = 1e-2
max_unknowns = 5000
[[models.potential.plate]]
lower = ["-5 mm", "-6 mm", "-4 mm"]
upper = ["5 mm", "6 mm", "-3 mm"]
relative_permeability = 1000
[[models.potential.plate]]
lower = ["-5 mm", "-6 mm", "-8 mm"]
upper = ["5 mm", "6 mm", "-7 mm"]
relative_permeability = 0.5
)toml";

std::string with_all_options() {
  const std::string mesh = "mesh = \"" + source("cases/verification/ogrid.msh").string() +
                           "\"\nmesh_unit = \"1 mm\"\nsymmetry";
  return replaced(replaced(good_case, "[models.solid]\nrefinement = 1\n", all_option_lines),
                  "symmetry", mesh);
}

/// The other material and the paper's sums, and their options.
std::string with_mooney_rivlin() {
  return replaced(good_case, "refinement = 1", "mooney_ratio = 0.1\nmaterial = \"mooney-rivlin\"") +
         "\n[models.elastica]\njoints = \"corrected\"\n"
         "[models.line]\nmethod = \"uniform\"\nelements = 7\n"
         "[models.volume]\nmethod = \"uniform\"\nelements = 9\n";
}

std::string with_tolerance() {
  return replaced(good_case, "refinement = 1", "tolerance = \"0.1 %\"\ntolerance_of = \"field\"");
}

TEST(Options, ReachTheOptionsOfTheirModel) {
  const input::ModelOptions o = read(with_all_options()).options;
  const input::ModelOptions mooney = read(with_mooney_rivlin()).options;
  using analytic::elastica::ElasticaOptions;
  const auto elastica = o.of<ElasticaOptions>();
  EXPECT_EQ(elastica.form, ElasticaOptions::Form::height);
  EXPECT_EQ(elastica.tolerance, 1e-9);
  EXPECT_EQ(elastica.tip, analytic::elastica::CiliumEnd::point);
  EXPECT_EQ(mooney.of<ElasticaOptions>().joints, joints::Correction::corrected);
  const auto beam = o.of<fem::beam::BeamOptions>();
  EXPECT_EQ(beam.tip, fem::beam::TipShape::point);
  EXPECT_EQ(beam.degree, 2U);
  EXPECT_EQ(beam.refinement, 4U);
  EXPECT_TRUE(beam.shear_rigid);
  EXPECT_EQ(beam.joints, joints::Correction::corrected);
  EXPECT_EQ(beam.tolerance, 1e-8);
  EXPECT_EQ(beam.max_iterations, 11U);
  EXPECT_EQ(beam.max_cutbacks, 3U);
  const auto calculix = o.of<fem::calculix::CalculixOptions>();
  EXPECT_EQ(calculix.refinement, 3U);
  EXPECT_FALSE(calculix.error_estimate);
  EXPECT_EQ(calculix.first_increment, 0.1);
  EXPECT_EQ(calculix.threads, 3U);
  EXPECT_EQ(calculix.time_limit, 600);
  EXPECT_EQ(calculix.program, "/opt/ccx");
  EXPECT_EQ(calculix.keep, "/somewhere");
  using fem::solid::SolidOptions;
  const auto solid = o.of<SolidOptions>();
  EXPECT_EQ(solid.material, SolidOptions::Material::yeoh);
  EXPECT_EQ(solid.yeoh_ratios, (std::array{-0.2, 0.03}));
  EXPECT_EQ(mooney.of<SolidOptions>().material, SolidOptions::Material::mooney_rivlin);
  EXPECT_EQ(mooney.of<SolidOptions>().mooney_ratio, 0.1);
  EXPECT_EQ(solid.refinement, 2U);
  EXPECT_EQ(solid.solver, fem::solid::solvers::SolverKind::iterative);
  EXPECT_EQ(solid.initial_guess, fem::solid::InitialGuess::none);
  EXPECT_FALSE(solid.symmetry);
  EXPECT_EQ(solid.mesh, source("cases/verification/ogrid.msh"));
  EXPECT_EQ(solid.mesh_unit, 1e-3);
  EXPECT_EQ(solid.kernel_width, 0.00025);
  EXPECT_EQ(solid.newton_tolerance, 1e-7);
  EXPECT_EQ(solid.max_iterations, 12U);
  EXPECT_EQ(solid.max_cutbacks, 4U);
  using namespace analytic::rod;
  using analytic::sources::PushForward;
  EXPECT_EQ(o.of<DipoleOptions>().push_forward, PushForward::R);
  EXPECT_EQ(o.of<LineOptions>().push_forward, PushForward::R);
  EXPECT_EQ(o.of<LineOptions>().method, Method::quadrature);
  EXPECT_EQ(o.of<LineOptions>().tolerance, 1e-6);
  EXPECT_EQ(mooney.of<LineOptions>().method, Method::uniform);
  EXPECT_EQ(mooney.of<LineOptions>().elements, 7U);
  EXPECT_EQ(o.of<VolumeOptions>().slices, VolumeOptions::Slices::stacked);
  EXPECT_EQ(o.of<VolumeOptions>().method, Method::quadrature);
  EXPECT_EQ(o.of<VolumeOptions>().tolerance, 1e-5);
  EXPECT_EQ(mooney.of<VolumeOptions>().method, Method::uniform);
  EXPECT_EQ(mooney.of<VolumeOptions>().elements, 9U);
  EXPECT_EQ(o.of<analytic::body::MeshOptions>().push_forward, PushForward::R);
  EXPECT_EQ(o.of<analytic::body::MeshOptions>().tolerance, 1e-4);
  const auto potential = o.of<fem::potential::PotentialOptions>();
  EXPECT_EQ(potential.relative_permeability, 1.2);
  EXPECT_EQ(potential.push_forward, fem::potential::MagnetPushForward::R);
  EXPECT_EQ(potential.tolerance, 1e-2);
  EXPECT_EQ(potential.max_unknowns, 5000U);
  ASSERT_EQ(potential.plates.size(), 2U);
  EXPECT_EQ(potential.plates[0].box.min(), Vector3(-0.005, -0.006, -0.004));
  EXPECT_EQ(potential.plates[0].box.max(), Vector3(0.005, 0.006, -0.003));
  EXPECT_EQ(potential.plates[0].relative_permeability, 1000);
  EXPECT_EQ(potential.plates[1].relative_permeability, 0.5);
}

// A mesh is looked for beside the case file, and is written back with its full name: the results go
// elsewhere.
TEST(Options, TheMeshIsBesideTheCaseFile) {
  const std::string text =
      replaced(good_case, "refinement = 1", "mesh = \"../verification/ogrid.msh\"");
  const input::Case c =
      input::read_case(text, source("cases/paper/some.toml").string(), models::known());
  EXPECT_EQ(c.options.of<fem::solid::SolidOptions>().mesh, source("cases/verification/ogrid.msh"));
  expect_read_back(c);
  try {
    input::read_case(text, "/some.toml", models::known());
    FAIL() << "the mesh is not there";
  } catch (const InputError& error) {
    EXPECT_THAT(
        error.what(),
        testing::HasSubstr("some.toml:35:8: there is no mesh file '/verification/ogrid.msh'"));
  }
}

TEST(Options, AreAllInTheListAbove) {
  // So that the test of the options and of the round trip covers an option added later.
  const input::ModelOptions set = read(with_all_options()).options;
  const input::ModelOptions mooney = read(with_mooney_rivlin()).options;
  const input::ModelOptions refined = read(with_tolerance()).options;
  for (const auto& [model, option] : all_options()) {
    const auto is_set = [&option = option](const input::ModelOptions& options) {
      return option.belongs(options) && option.get(options) != option.get(input::ModelOptions{});
    };
    EXPECT_TRUE(is_set(set) || is_set(mooney) || is_set(refined)) << model << '.' << option.name;
  }
}

TEST(Options, HaveAToleranceInPlaceOfARefinement) {
  const input::Case c = read(with_tolerance());
  EXPECT_EQ(c.options.of<input::ErrorLimit>().percent, 0.1);
  EXPECT_EQ(c.options.of<input::ErrorLimit>().of, input::ErrorLimit::Of::field);
  expect_read_back(c);
}

TEST(Options, HaveDefaultsInTheirRange) {
  for (const auto& [model, option] : all_options()) {
    const description::Value value = option.get(input::ModelOptions{});
    if (const auto* number = std::get_if<double>(&value)) {
      EXPECT_TRUE(option.range.contains(*number)) << model << '.' << option.name;
    }
    if (const auto* number = std::get_if<unsigned int>(&value)) {
      EXPECT_TRUE(option.range.contains(*number)) << model << '.' << option.name;
    }
    if (const auto* text = std::get_if<std::string>(&value); text && !option.choices.empty()) {
      EXPECT_THAT(option.choices, testing::Contains(*text)) << model << '.' << option.name;
    }
  }
}

TEST(WrittenCase, ReadsBackAsTheSameCaseBitForBit) {
  const std::vector<std::string> texts{
      std::string(good_case),
      with_all_options(),
      with_mooney_rivlin(),
      replaced(good_case, "\"A case without a fault\"", R"("µ \"quoted\" \\ 'back'")"),
      with_load("type = \"contact\"\nforce = [\"1 mN\", \"1 mN\"]\nheight = \"3.1 mm\""),
      with_load("type = \"contact\"\nforce = [\"1 mN\"]\nheight = \"0.3 inch\""),
      with_load("type = \"flow\"\nvelocity = [\"0.1 m/s\", \"0.7 kt\"]\ndensity = [\"1.025 "
                "g/cm^3\", \"2 lb/ft^3\"]\ndrag_coefficient = 1.1"),
      with_load("type = \"flow\"\nforce_per_height = [\"0.1 lbf/ft\", \"0 N/m\"]\nazimuth = "
                "[\"77 deg\", \"-1 deg\"]"),
      with_load("type = \"section\"\nforce = [\"1 mN\", \"3 gf\"]\narclength = \"20 mm\""),
      with_load("type = \"probe\"\ndisplacement = [\"1 mm\", \"0.3 inch\"]\nheight = [\"16 mm\", "
                "\"0.5 inch\"]\nazimuth = \"77 deg\""),
      with_load("type = \"dead\"\nforce_per_length = \"0.7 N/m\"\nazimuth = \"33 deg\""),
      replaced(good_case, "[\"-0.1 mm\", \"0.2 mm\", \"-1.55 mm\"]",
               "[[\"1 um\", \"0.1 inch\", \"3 mm\"], [\"0 m\", \"-0 m\", \"-1 ft\"]]")};
  for (const std::string& text : texts) {
    SCOPED_TRACE(text);
    expect_read_back(text);
  }
}

TEST(WrittenCase, StatesEveryOptionWithItsValue) {
  const input::Case c = read(good_case);
  const std::string written = input::to_toml(c, models::known());
  for (const auto& [model, option] : all_options()) {
    if (!option.belongs(c.options)) {
      EXPECT_THAT(written, Not(testing::HasSubstr(std::string(option.name)))) << model;
      continue;
    }
    std::string line = "\n";
    line += option.name;
    line += " = " + input::to_toml(option, option.get(input::ModelOptions{})) + "\n";
    EXPECT_THAT(written, testing::HasSubstr(line)) << model;
  }
  EXPECT_THAT(written, testing::HasSubstr("kernel_width = \"0.0005 m\""));
  EXPECT_THAT(written, testing::HasSubstr("diameter = \"0.003 m\""));
}

TEST(WrittenCase, StatesTheDefaultsOfTheChosenMaterial) {
  const auto written = [](const std::string& material) {
    return input::to_toml(
        read(replaced(good_case, "refinement = 1", "material = \"" + material + "\"")),
        models::known());
  };
  EXPECT_THAT(written("mooney-rivlin"), testing::HasSubstr("\nmooney_ratio = 0.25\n"));
  EXPECT_THAT(written("yeoh"), testing::HasSubstr("\nyeoh_ratios = [-0.1, 0.01]\n"));
}

TEST(ShippedCases, AreReadAndWrittenBack) {
  int count = 0;
  for (const auto& file : std::filesystem::recursive_directory_iterator(source("cases"))) {
    if (file.path().extension() != ".toml" || file.path().string().ends_with(".study.toml") ||
        file.path().string().ends_with(".sense.toml"))
      continue;
    SCOPED_TRACE(file.path());
    const input::Case c = input::read_case(file.path(), models::known());
    EXPECT_EQ(c.name, file.path().stem());
    expect_read_back(c);
    ++count;
  }
  EXPECT_GE(count, 4);
}

TEST(ShippedCases, HaveTheFiguresOfThePaper) {
  // Oracle: the paper, sections 3.2, 3.4 and 3.5.
  for (const std::string_view name : {"fig3b", "fig3d", "fig5"}) {
    SCOPED_TRACE(name);
    const input::Case c =
        input::read_case(source("cases/paper") / (std::string(name) + ".toml"), models::known());
    EXPECT_EQ(c.cilium.diameter, 0.003);
    EXPECT_THAT(c.cilium.interfaces(), ElementsAre(0.0, 0.003, 0.02));
    EXPECT_EQ(c.cilium.segments[0].young_modulus, 0.1e6);
    EXPECT_EQ(c.cilium.segments[1].young_modulus, 3e6);
    EXPECT_EQ(c.cilium.segments[1].magnetization, 7.5e4);
    EXPECT_THAT(c.sensors, ElementsAre(Vector3(-0.1e-3, 0.2e-3, -1.55e-3)));
  }
  const input::Case flow = input::read_case(source("cases/paper/fig5.toml"), models::known());
  EXPECT_EQ(flow.load_path.size(), 5U);
  EXPECT_NEAR(magnitude(flow.load_path.back()), 0.375, 1e-16);  // the paper's q_max
  const input::Case contact = input::read_case(source("cases/paper/fig3b.toml"), models::known());
  EXPECT_EQ(contact.load_path.front().as<ContactLoad>()->force, 0.001);
  EXPECT_EQ(contact.load_path.front().as<ContactLoad>()->height, 0.016);
}

TEST(Documentation, HasTheTableOfKeys) {
  std::ifstream in(source("docs/guide/cases.md"));
  const std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  if (std::getenv("CILIAVAL_PRINT_KEYS") != nullptr)
    std::fputs(test::key_table(models::known()).c_str(), stdout);
  EXPECT_THAT(text, testing::HasSubstr(test::key_table(models::known())))
      << "run this test with CILIAVAL_PRINT_KEYS=1 and put the table into docs/guide/cases.md";
}

TEST(Documentation, ExampleIsACase) {
  std::ifstream in(source("docs/guide/cases.md"));
  const std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  constexpr std::string_view fence = "```toml\n";
  const std::size_t from = text.find(fence);
  ASSERT_NE(from, std::string::npos);
  const std::size_t start = from + fence.size();
  EXPECT_EQ(read(text.substr(start, text.find("```", start) - start)).name, "fig3b");
}

}  // namespace
}  // namespace ciliaval::compare
