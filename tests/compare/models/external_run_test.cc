// SPDX-License-Identifier: LGPL-2.1-or-later
// Results of this suite itself, taken for an external model: they must come back as they were.
#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "compare/input/case.h"
#include "compare/models/errors.h"
#include "compare/models/registry.h"
#include "compare/models/run.h"
#include "compare/output/results.h"
#include "compare/output/table.h"
#include "problem/error.h"
#include "tests/support/synthetic.h"

namespace ciliaval::compare {
namespace {

using testing::HasSubstr;

const std::string text =
    test::case_text({.name = "roundtrip",
                     .force = R"(["1 mN", "4 mN"])",
                     .sensor = R"([["-0.1 mm", "0.2 mm", "-1.55 mm"], ["5 mm", "0 mm", "-2 mm"]])"},
                    "mechanics = [\"elastica\"]\nfields = [\"line\", \"volume\"]\n");

/// The earth's field and a sensor's offset at 0° and 60°, T; at 30° their mean.
const Vector3 earth_0(20e-6, -3e-6, 44e-6);
const Vector3 earth_60(8e-6, -13e-6, 44e-6);

class ExternalRun : public testing::Test {
 protected:
  void write(const std::string& name, const std::string& text) const { folder_.write(name, text); }
  models::CaseResult run_case(const std::string& more) const {
    return models::run(
        input::read_case(text + more, (folder_.path() / "case.toml").string(), models::known()),
        models::mechanics_models(), models::field_models());
  }
  /// The centrelines as `ciliaval run` writes them.
  void write_centrelines(const models::CaseResult& result) const {
    for (std::size_t i = 0; i < 2; ++i)
      write(fmt::format("elastica_{}.csv", i),
            output::centreline_csv(result.mechanics[0].result.steps[i].deformation->centreline));
  }
  /// B of elastica/volume plus a background, as a bench would log it, in µT.
  void write_readings(const models::FieldRun& fields, const Vector3& background,
                      bool undeformed) const {
    std::string csv = "step,sensor,Bx [uT],By [uT],Bz [uT]\n";
    const auto add = [&](const std::string& step, const models::FieldStep& values) {
      for (std::size_t s = 0; s < 2; ++s) {
        const Vector3 B = 1e6 * (*values.B[s] + background);
        csv += fmt::format("{},{},{},{},{}\n", step, s, B.x(), B.y(), B.z());
      }
    };
    if (undeformed) add("undeformed", fields.undeformed);
    for (std::size_t i = 0; i < 2; ++i) add(std::to_string(i), *fields.steps[i]);
    write("readings.csv", csv);
  }

  test::TemporaryFolder folder_;
};

/// The largest relative error of a model against a reference.
double largest(const models::CaseResult& result, const std::string& model,
               const std::string& reference, const std::string& quantity) {
  double value = 0;
  int count = 0;
  for (const models::Comparison& c : models::compare_models(result))
    if (c.model == model && c.reference == reference && c.quantity == quantity && c.relative &&
        c.statistic != "rrmse" && c.statistic != "r2") {
      value = std::max(value, std::abs(*c.relative));
      ++count;
    }
  EXPECT_GT(count, 0) << model << ' ' << reference << ' ' << quantity;
  return value;
}

constexpr const char* shapes = R"toml(
[[models.external]]
name = "copy"
centrelines = ["elastica_0.csv", "elastica_1.csv"]
)toml";

// Oracle: the elastica itself. Its centreline at 201 points and more comes back to the
// interpolation between them: 3.0e-9 of the tip's deflection, at the contact point, where the
// curvature has a kink that the file does not tell (h³ Δκ'/20 = 2e-11 m for h = 0.1 mm). B, that
// the ends of the magnet decide, comes back to rounding.
TEST_F(ExternalRun, ACentrelineComesBackAndCarriesTheFieldModels) {
  write_centrelines(run_case(""));
  const models::CaseResult result = run_case(shapes);
  ASSERT_EQ(result.mechanics.size(), 2U);
  EXPECT_EQ(result.mechanics[1].model, "copy");
  EXPECT_DOUBLE_EQ(result.mechanics[1].result.steps[1].applied_force, 4e-3);
  for (const char* quantity : {"tip", "tip_angle"})
    EXPECT_LT(largest(result, "elastica", "copy", quantity), 1e-13) << quantity;
  EXPECT_LT(largest(result, "elastica", "copy", "centreline"), 1e-8);
  for (const char* field : {"line", "volume"})
    for (const char* quantity : {"B", "dB"})
      EXPECT_LT(
          largest(result, std::string("elastica/") + field, std::string("copy/") + field, quantity),
          1e-11)
          << field << ' ' << quantity;
  for (const models::Comparison& c : models::compare_models(result))
    if (c.statistic == "r2") {
      EXPECT_NEAR(c.r2.value_or(0), 1, 1e-12);
    }
}

// Oracle: the elastica. Without theta and S they are made from the points: by chords and tangents.
TEST_F(ExternalRun, PointsAloneAreEnough) {
  const models::CaseResult own = run_case("");
  for (std::size_t i = 0; i < 2; ++i) {
    std::string csv = "x [mm],y [mm],z [mm]\n";
    const Centreline& line = own.mechanics[0].result.steps[i].deformation->centreline;
    for (int k = 0; k <= 100; ++k) {
      const Vector3 r = 1e3 * line.at(line.length() * k / 100).position;
      csv += fmt::format("{},{},{}\n", r.x(), r.y(), r.z());
    }
    write(fmt::format("elastica_{}.csv", i), csv);
  }
  const models::CaseResult result = run_case(shapes);
  EXPECT_THAT(result.mechanics[1].result.steps[0].message, HasSubstr("length along the points"));
  EXPECT_LT(largest(result, "elastica", "copy", "tip"), 1e-13);
  EXPECT_LT(largest(result, "elastica", "copy", "tip_angle"), 1e-3);
  EXPECT_LT(largest(result, "elastica", "copy", "centreline"), 1e-3);
  EXPECT_LT(largest(result, "elastica/volume", "copy/volume", "dB"), 5e-3);
}

constexpr const char* bench = R"toml(
[[models.external]]
name = "bench"
readings = "readings.csv"
field_uncertainty = "0.1 uT"
)toml";

// Oracle: elastica/volume itself: its B, logged in µT to 17 digits, and a planted background that
// is taken off again to rounding, 1e-16 of 2.4 mT or 5e-12 of ΔB.
TEST_F(ExternalRun, ReadingsComeBackAndAPlantedBackgroundIsRemoved) {
  const models::CaseResult own = run_case("");
  const models::FieldRun& volume = own.fields[1];
  ASSERT_EQ(volume.name(), "elastica/volume");
  write_readings(volume, Vector3::Zero(), true);
  const models::CaseResult plain = run_case(bench);
  ASSERT_EQ(plain.mechanics.size(), 1U);
  ASSERT_EQ(plain.fields.size(), 3U);
  EXPECT_EQ(plain.fields[2].name(), "bench/readings");
  EXPECT_LT(largest(plain, "elastica/volume", "bench/readings", "B"), 1e-14);
  EXPECT_LT(largest(plain, "elastica/volume", "bench/readings", "dB"), 1e-11);

  write_readings(volume, (earth_0 + earth_60) / 2, true);
  EXPECT_GT(largest(run_case(bench), "elastica/volume", "bench/readings", "B"), 1e-2);
  std::string csv = "azimuth [deg],Bx [milligauss],By [milligauss],Bz [milligauss]\n";
  for (const auto& [azimuth, B] : {std::pair{60, earth_60}, std::pair{0, earth_0}})
    csv += fmt::format("{},{},{},{}\n", azimuth, 1e7 * B.x(), 1e7 * B.y(), 1e7 * B.z());
  write("earth.csv", csv);
  const models::CaseResult cleaned = run_case(std::string(bench) + "background = \"earth.csv\"\n");
  EXPECT_LT(largest(cleaned, "elastica/volume", "bench/readings", "B"), 1e-14);
  EXPECT_LT(largest(cleaned, "elastica/volume", "bench/readings", "dB"), 1e-11);
}

// A bench that took its offset off knows ΔB alone.
TEST_F(ExternalRun, AChangeAloneIsComparedAsAChange) {
  const models::CaseResult own = run_case("");
  std::string csv = "step,sensor,dBx [T],dBy [T],dBz [T]\n";
  for (std::size_t i = 0; i < 2; ++i)
    for (std::size_t s = 0; s < 2; ++s) {
      const Vector3& dB = *own.fields[0].steps[i]->dB[s];
      csv += fmt::format("{},{},{},{},{}\n", i, s, dB.x(), dB.y(), dB.z());
    }
  write("readings.csv", csv);
  const models::CaseResult result = run_case(bench);
  EXPECT_EQ(largest(result, "elastica/line", "bench/readings", "dB"), 0);
  EXPECT_GT(largest(result, "elastica/volume", "bench/readings", "dB"), 0.03);
  const auto comparisons = models::compare_models(result);
  for (const models::Comparison& c : comparisons)
    if (c.reference == "bench/readings") {
      EXPECT_EQ(c.quantity, "dB");
    }
  EXPECT_THAT(output::table(result, comparisons, output::Footnotes::reference),
              HasSubstr("bench/readings"));
  const std::string json = output::summary_json(result, comparisons, {});
  EXPECT_THAT(json, HasSubstr("\"bench/readings\""));
}

// A reading has its own uncertainty, and no deformation's: with a model that has one too, a
// verdict.
TEST_F(ExternalRun, UncertaintiesOfReadingsReachTheVerdicts) {
  const models::CaseResult own = run_case("");
  write_centrelines(own);
  write_readings(own.fields[1], Vector3::Zero(), false);
  std::string both = shapes;
  both += "tip_uncertainty = \"0 um\"\nreadings = \"readings.csv\"\nfield_uncertainty = \"2 uT\"\n";
  const models::CaseResult result = run_case(both);
  ASSERT_EQ(result.fields.back().name(), "copy/readings");
  EXPECT_FALSE(result.fields.back().steps[0]->dB[0].has_value());
  int count = 0;
  for (const models::Comparison& c : models::compare_models(result)) {
    if (c.reference != "copy/readings" || c.statistic != "value") continue;
    EXPECT_EQ(c.quantity, "B");
    const bool model_known = c.model == "copy/volume";
    if (!model_known) continue;
    ++count;
    ASSERT_TRUE(c.uncertainty.has_value());
    EXPECT_NEAR(*c.uncertainty, 2e-6, 1e-9);
    EXPECT_EQ(c.verdict, models::Verdict::below_uncertainty);
  }
  EXPECT_EQ(count, 2 * 2 * 3);
}

// A case whose path was changed after its files were read, by a command of the suite.
TEST_F(ExternalRun, OfAnotherLoadPathIsRefused) {
  input::Case c = input::read_case(text, (folder_.path() / "case.toml").string(), models::known());
  input::external::ExternalModel other;
  other.name = "other";
  for (int i = 0; i < 2; ++i) {
    other.centrelines.push_back(straight_centreline(c.cilium.interfaces()));
    other.remarks.emplace_back();
  }
  c.external = {other};
  const auto run = [&] {
    return models::run(c, models::mechanics_models(), models::field_models());
  };
  EXPECT_EQ(run().mechanics.size(), 2U);
  c.load_path.push_back(c.load_path.back());
  EXPECT_THAT(run, testing::ThrowsMessage<InputError>(HasSubstr(
                       "the external model 'other' is of a path of 2 load steps, not of 3")));
}

}  // namespace
}  // namespace ciliaval::compare
