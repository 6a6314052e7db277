// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>

#include "tests/support/program.h"

namespace ciliaval {
namespace {

using test::Outcome;
using test::read_text;
using test::TemporaryFolder;
using testing::HasSubstr;

// Oracle: small deflections of a slender rod. By the law F a uniform field across the magnet pulls
// its end faces by ±M A B, which moves the tip of a clamped rod by M A B L³/(3 E I); the weight
// across it, (ρ − ρ_f) g A per length, by (ρ − ρ_f) g A L⁴/(8 E I). Both are some 1e-3 of L here,
// so that the linear theory is right to 1e-5; the beam's shear adds some (d/L)² = 1e-4.
TEST(Environment, APathOfFieldsBendsTheRodsAsLinearTheory) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "rod.toml") << R"([case]
name = "rod"
[cilium]
diameter = "0.2 mm"
[[cilium.segment]]
name = "rod"
length = "20 mm"
young_modulus = "10 MPa"
poisson_ratio = 0.49
magnetization = "1 kA/m"
density = "1200 kg/m^3"
[environment]
gravity = ["0 m/s2", "0.1 m/s2", "0 m/s2"]
fluid_density = "1000 kg/m^3"
uniform_field = [["0 mT", "0 mT", "0 mT"], ["0 mT", "0.1 mT", "0 mT"], ["0 mT", "0.2 mT", "0 mT"]]
[sensor]
position = ["0 mm", "0 mm", "-1 mm"]
[models]
mechanics = ["elastica", "beam"]
fields = ["volume"]
)";
  const Outcome run = test::run_program(folder.path(), "run rod.toml -o out --explain");
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("azimuth 90 deg, field (0, 0.2, 0) mT"));
  const auto summary =
      nlohmann::json::parse(read_text(folder.path() / "out" / "rod" / "summary.json"));
  ASSERT_EQ(summary["steps"].size(), 3U);
  const double L = 20e-3;
  const double area = std::numbers::pi * 1e-8;
  const double stiffness = 10e6 * std::numbers::pi * 1e-16 / 4;
  double last = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double field = 1e-4 * static_cast<double>(i);
    EXPECT_EQ(summary["steps"][i]["environment"]["uniform_field"][1], field);
    const double tip =
        (1e3 * area * field * L * L * L / 3 + 200 * 0.1 * area * L * L * L * L / 8) / stiffness;
    for (const char* model : {"elastica", "beam"}) {
      const auto& found = summary["steps"][i]["mechanics"][model];
      EXPECT_NEAR(found["tip"][1], tip, 1e-3 * tip) << model;
      EXPECT_NEAR(found["tip"][0], 0, 1e-12) << model;
      EXPECT_NEAR(found["applied_force"], 0, 1e-12) << model;
      EXPECT_GT(found["tip"][1], last) << model;
    }
    last = summary["steps"][i]["mechanics"]["beam"]["tip"][1];
  }
  EXPECT_EQ(test::run_program(folder.path(), "run out/rod/case.toml -o again").code, 0);
  const auto again =
      nlohmann::json::parse(read_text(folder.path() / "again" / "rod" / "summary.json"));
  EXPECT_EQ(again["steps"][2]["mechanics"]["elastica"]["tip"],
            summary["steps"][2]["mechanics"]["elastica"]["tip"]);
}

}  // namespace
}  // namespace ciliaval
