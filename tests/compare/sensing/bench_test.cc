// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/sensing/bench.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>

#include "problem/error.h"
#include "tests/support/program.h"

namespace ciliaval::compare {
namespace {

using testing::HasSubstr;

using sensing::degree;

sensing::Bench paper_bench() {
  sensing::Bench bench;
  bench.problem = test::paper_case({1e-3, 2e-3, 4e-3});
  bench.models = sensing::parse_pair("elastica/volume");
  bench.truth = bench.models;
  return bench;
}

const sensing::BenchRow& row(const sensing::BenchResult& result, sensing::ErrorSource source) {
  for (const sensing::BenchRow& r : result.rows)
    if (r.source == source) return r;
  throw std::out_of_range("no such row");
}

TEST(Bench, WithoutErrorsFindsTheLoads) {
  const sensing::BenchResult result = sensing::run_bench(paper_bench());
  ASSERT_EQ(result.rows.size(), 2u);  // none, all
  for (const sensing::BenchRow& r : result.rows) {
    EXPECT_LT(r.inversion.magnitude_rms, 1e-9);
    EXPECT_LT(r.inversion.azimuth_largest, 1e-9);
    EXPECT_EQ(r.inversion.below_ten_degrees, 1);
  }
  EXPECT_EQ(row(result, sensing::ErrorSource::none).inversion.readings, 36u);
  // The linear fit is off by what the response is not linear.
  EXPECT_GT(row(result, sensing::ErrorSource::none).linear_fit.magnitude_rms, 1e-3);
}

// Oracle: first-order propagation. The noise of reading and offset add up to √2 σ; relative to the
// load along it, in radians across it.
TEST(Bench, NoiseSpreadsAsItsPropagationSays) {
  sensing::Bench bench = paper_bench();
  bench.noise = 0.2e-6;
  bench.draws = 100;
  const sensing::BenchErrors errors =
      row(sensing::run_bench(bench), sensing::ErrorSource::noise).inversion;
  const sensing::Response response(bench.problem, "volume",
                                   sensing::shapes_up_to(bench.problem, "elastica", 5e-3),
                                   bench.problem.sensors);
  double along = 0;
  double across = 0;
  for (const Load& load : bench.problem.load_path)
    for (int a = 0; a < 12; ++a) {
      const sensing::Vector2 e(std::cos(a * 30 * degree), std::sin(a * 30 * degree));
      const Eigen::MatrixX2d J = response.derivative(magnitude(load) * e);
      const Eigen::Matrix2d covariance =
          2 * bench.noise * bench.noise * (J.transpose() * J).inverse();
      along += e.dot(covariance * e) / std::pow(magnitude(load), 2) / 36;
      const sensing::Vector2 n(-e.y(), e.x());
      across += n.dot(covariance * n) / std::pow(magnitude(load), 2) / 36;
    }
  EXPECT_NEAR(errors.magnitude_rms, std::sqrt(along), 0.1 * std::sqrt(along));
  EXPECT_NEAR(errors.azimuth_rms, std::sqrt(across), 0.1 * std::sqrt(across));
}

// A stage that is turned shows in the direction alone, by the angle that it is turned.
TEST(Bench, TheStagesAngleIsTheDirectionsError) {
  sensing::Bench bench = paper_bench();
  bench.stage_azimuth = 2 * degree;
  bench.draws = 400;
  bench.azimuths = 3;
  const sensing::BenchErrors errors =
      row(sensing::run_bench(bench), sensing::ErrorSource::stage_azimuth).inversion;
  EXPECT_LT(errors.magnitude_rms, 1e-9);
  EXPECT_NEAR(errors.azimuth_rms, 2 * degree, 0.3 * degree);  // 4 standard deviations of 400 draws
  EXPECT_GT(errors.azimuth_largest, 2 * errors.azimuth_rms);
  // The root mean square of n normal numbers has the standard deviation σ/√(2n); the three azimuths
  // of a draw share one. 1.97: Student's t at 97.5 %.
  const double interval = 1.97 * 2 * degree / std::sqrt(2 * 400.0);
  EXPECT_NEAR(errors.azimuth_rms_interval, interval, 0.2 * interval);
  bench.draws = 1;
  EXPECT_EQ(row(sensing::run_bench(bench), sensing::ErrorSource::stage_azimuth)
                .inversion.azimuth_rms_interval,
            0);
}

// The ambient field is measured at each azimuth and taken off: what is left is the noise of that
// measurement, however strong the field.
TEST(Bench, OfTheAmbientFieldTheNoiseOfItsMeasurementIsLeft) {
  sensing::Bench bench = paper_bench();
  bench.noise = 0.2e-6;
  bench.ambient = Vector3(20e-6, 0, -43e-6);
  const sensing::BenchErrors once =
      row(sensing::run_bench(bench), sensing::ErrorSource::ambient).inversion;
  bench.ambient *= 10;
  const sensing::BenchErrors ten_times =
      row(sensing::run_bench(bench), sensing::ErrorSource::ambient).inversion;
  EXPECT_GT(once.magnitude_rms, 0);
  EXPECT_NEAR(ten_times.magnitude_rms, once.magnitude_rms, 1e-6 * once.magnitude_rms);
}

// A misplaced sensor, digits, and another model each leave errors; all together are more than each;
// the same seed gives the same numbers, another one others.
TEST(Bench, EachSourceShowsAndTheSeedDecides) {
  sensing::Bench bench = paper_bench();
  bench.truth = sensing::parse_pair("beam/line");
  bench.noise = 0.5e-6;
  bench.quantum = 0.5e-6;
  bench.sensor_position = 0.1e-3;
  bench.draws = 5;
  const sensing::BenchResult result = sensing::run_bench(bench);
  const sensing::BenchErrors all = row(result, sensing::ErrorSource::all).inversion;
  for (const sensing::ErrorSource source :
       {sensing::ErrorSource::noise, sensing::ErrorSource::quantum,
        sensing::ErrorSource::sensor_position, sensing::ErrorSource::models}) {
    EXPECT_GT(row(result, source).inversion.magnitude_rms, 1e-5) << sensing::to_string(source);
    EXPECT_GT(all.azimuth_largest, row(result, source).inversion.azimuth_rms)
        << sensing::to_string(source);
  }
  EXPECT_EQ(sensing::bench_json(bench, result, {}),
            sensing::bench_json(bench, sensing::run_bench(bench), {}));
  EXPECT_EQ(result.first_draw.size(), 36u);
  EXPECT_EQ(result.by_magnitude.size(), 3u);
  EXPECT_GT(result.by_magnitude.front().azimuth_rms, result.by_magnitude.back().azimuth_rms);
  sensing::Bench other = bench;
  other.seed = 2;
  EXPECT_NE(row(sensing::run_bench(other), sensing::ErrorSource::noise).inversion.magnitude_rms,
            row(result, sensing::ErrorSource::noise).inversion.magnitude_rms);
}

// The file, as a user writes it and as one gets it wrong.
TEST(Bench, FilesAreReadAndTheirFaultsSaidWithTheirPlace) {
  const test::TemporaryFolder folder;
  const auto write = [&](const std::string& name, const std::string& text) {
    std::ofstream(folder.path() / name) << text;
  };
  write("one.toml", test::case_text({.name = "one"}, "mechanics = [\"elastica\"]\n"));
  const std::string good =
      "[bench]\ncase = \"one.toml\"\nmodels = \"beam/line\"\nazimuths = 4\ndraws = 2\n[errors]\n"
      "noise = \"0.5 uT\"\nambient = [\"20 uT\", \"0 uT\", \"-43 uT\"]\n";
  write("one.sense.toml", good);
  const sensing::Bench bench = sensing::read_bench(folder.path() / "one.sense.toml");
  EXPECT_EQ(bench.truth.name(), "beam/line");
  EXPECT_EQ(bench.azimuths, 4u);
  EXPECT_DOUBLE_EQ(bench.ambient.z(), -43e-6);
  EXPECT_DOUBLE_EQ(bench.noise, 0.5e-6);
  const auto refused = [&](std::string from, const std::string& to, const std::string& message) {
    std::string text = good;
    text.replace(text.find(from), from.size(), to);
    write("bad.sense.toml", text);
    const test::Outcome outcome = test::run_program(folder.path(), "sense bad.sense.toml");
    EXPECT_EQ(outcome.code, 2) << text;
    EXPECT_THAT(outcome.err, HasSubstr(message));
    EXPECT_THAT(outcome.err, HasSubstr("bad.sense.toml:"));
  };
  refused("one.toml", "none.toml", "does not exist");
  refused("beam/line", "beam/lime", "there is no model `lime`");
  refused("azimuths", "azimuth", "did you mean");
  refused("0.5 uT", "0.5 mm", "flux density");
  refused("0.5 uT", "-1 uT", "'noise' is");
  refused("draws = 2", "draws = 0", "'draws'");
  refused("\"20 uT\", ", "", "three components");
  refused("[errors]", "[mistakes]", "mistakes");
  const test::Outcome outcome =
      test::run_program(folder.path(), "sense one.sense.toml --json one.json --plot one.svg");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("ambient field"));
  const auto json = nlohmann::json::parse(test::read_text(folder.path() / "one.json"));
  EXPECT_EQ(json["sources"].back()["source"], "all");
  EXPECT_THAT(test::read_text(folder.path() / "one.svg"), HasSubstr("true load"));
}

}  // namespace
}  // namespace ciliaval::compare
