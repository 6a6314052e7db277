// SPDX-License-Identifier: LGPL-2.1-or-later
// A case with measurements as a user runs it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "tests/support/program.h"

namespace ciliaval {
namespace {

using test::TemporaryFolder;
using testing::HasSubstr;

constexpr const char* table = R"toml(
[[measurement]]
quantity = "tip.deflection"
point = ["1.5 mm", "0 mm"]
file = "tip.csv"
column = "w_over_L"
scale = "20 mm"
uncertainty = "0.1 mm"
source = "Camera, corner of the end"

[[measurement]]
quantity = "dB.0.x"
step = 1
value = "-150 uT"
uncertainty = "5 uT"
source = "Hall sensor"
fitted = true

[[input_uncertainty]]
number = "cilium.segment.base.young_modulus"
uncertainty = "5 %"
source = "tensile test"

[[input_uncertainty]]
number = "load.height"
uncertainty = "0.1 mm"
)toml";

std::string case_text(const std::string& mechanics) {
  return test::case_text({.name = "one", .force = "[\"0.5 mN\", \"1 mN\"]"},
                         "mechanics = [" + mechanics + "]\nfields = [\"line\", \"volume\"]\n") +
         table;
}

TEST(Validation, OfARunIsPrintedAndWritten) {
  const TemporaryFolder folder;
  folder.write("one.toml", case_text("\"elastica\", \"beam\""));
  folder.write("tip.csv", "# read from a picture\nforce_mN,w_over_L\n0.5,0.08\n1,0.2\n");
  const auto run = test::run_program(folder.path(), "run one.toml --quiet --explain");
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("Against measurements (ASME V&V 20)"));
  EXPECT_THAT(run.out, HasSubstr("Camera, corner of the end"));
  const auto summary =
      nlohmann::json::parse(test::read_text(folder.path() / "results/one/summary.json"));
  const auto& validation = summary["validation"];
  ASSERT_EQ(validation["series"].size(), 6U);  // two shapes, four pairs
  const auto& beam = validation["series"][1];
  EXPECT_EQ(beam["model"], "beam");
  EXPECT_EQ(beam["points"][1]["measured"], 4e-3);
  // Oracle: the tip and its angle in the same file.
  const auto& shape = summary["steps"][1]["mechanics"]["beam"];
  const double tip = std::hypot(shape["tip"][0].get<double>(), shape["tip"][1].get<double>());
  const double angle = shape["tip_angle"];
  const double azimuth = 3.14159265358979323846 / 6;
  // The point lies along +x; its displacement along the azimuth, by the section's rotation about
  // the axis across it.
  const double expected = tip - 1.5e-3 * std::cos(azimuth) * (1 - std::cos(angle));
  EXPECT_NEAR(beam["points"][1]["simulated"].get<double>(), expected, 1e-9);
  const auto& pair = validation["series"][5];
  EXPECT_EQ(pair["model"], "beam/volume");
  EXPECT_EQ(pair["points"][0]["simulated"],
            summary["steps"][1]["fields"]["beam/volume"]["dB"][0][0]);
  EXPECT_EQ(pair["fitted"], 1);
  // The file that the run wrote back says the same; it holds the rows themselves, so that nothing
  // is to be said of how they were paired with steps.
  nlohmann::json of_values = validation;
  ASSERT_EQ(of_values["remarks"].size(), 2U);
  EXPECT_EQ(of_values["remarks"][1],
            "tip.csv: 2 rows of tip.deflection from 'w_over_L', steps by 'force_mN' (force)");
  of_values["remarks"].erase(1);
  const auto again = test::run_program(folder.path(), "run results/one/case.toml --quiet -o again");
  ASSERT_EQ(again.code, 0) << again.err;
  const auto second =
      nlohmann::json::parse(test::read_text(folder.path() / "again/one/summary.json"));
  EXPECT_EQ(second["validation"], of_values);
}

TEST(Validation, OfANumberThatTheCaseDoesNotHaveIsRefusedBeforeTheRun) {
  const TemporaryFolder folder;
  std::string text = case_text("\"elastica\"");
  text.replace(text.find("load.height"), 11, "load.weight");
  folder.write("one.toml", text);
  folder.write("tip.csv", "w_over_L\n0.08\n0.2\n");
  for (const char* command : {"run", "validate"}) {
    const auto run = test::run_program(folder.path(), std::string(command) + " one.toml");
    EXPECT_EQ(run.code, 2);
    EXPECT_THAT(run.err, HasSubstr("one.toml:"));
    EXPECT_THAT(run.err, HasSubstr("the case has no number 'load.weight'"));
  }
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "results/one"));
}

}  // namespace
}  // namespace ciliaval
