// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/sensing/inversion.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/non_central_chi_squared.hpp>
#include <cmath>
#include <fstream>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "compare/sensing/sensing.h"
#include "problem/error.h"
#include "tests/support/synthetic.h"
#include "tests/support/temporary_folder.h"

namespace ciliaval::compare {
namespace {

const Vector3 noise = Vector3(0.5e-6, 0.5e-6, 1e-6);

const sensing::Response& paper_response() {
  static const input::Case problem = test::paper_case({1e-3});
  static const sensing::Response response(
      problem, "volume", sensing::shapes_up_to(problem, "elastica", 4e-3), problem.sensors);
  return response;
}

TEST(Inversion, GivesTheLoadBackFromExactReadings) {
  const sensing::Inversion invert(paper_response(), noise);
  for (double azimuth = -3; azimuth < 3.2; azimuth += 0.5)
    for (const double force : {1e-6, 0.3e-3, 1.9e-3, 3.99e-3}) {
      const sensing::Vector2 p = sensing::polar(force, azimuth);
      const sensing::SensedLoad sensed = invert(paper_response().change(p));
      EXPECT_LT((sensed.load - p).norm(), 1e-10 * 4e-3) << p.transpose();
      EXPECT_LT(sensed.chi_squared, 1e-6);
      EXPECT_TRUE(sensed.converged);
      EXPECT_FALSE(sensed.beyond_range);
    }
}

// 2000 readings with known noise: 95 % of the intervals hold the truth (binomial, 4 standard
// deviations: ±2 %), and χ² is distributed as it should be.
TEST(Inversion, ItsIntervalsHoldTheTruthAsOftenAsTheySay) {
  const sensing::Inversion invert(paper_response(), noise);
  std::mt19937 random(20261);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  constexpr int readings = 2000;
  int magnitudes = 0;
  int azimuths = 0;
  int likely = 0;
  for (int i = 0; i < readings; ++i) {
    const sensing::Vector2 p =
        sensing::polar(0.2e-3 + 3.6e-3 * uniform(random), 6 * uniform(random));
    Eigen::VectorXd change = paper_response().change(p);
    for (int c = 0; c < 3; ++c) change[c] += noise[c] * normal(random);
    const sensing::SensedLoad sensed = invert(change);
    magnitudes += std::abs(sensed.magnitude() - p.norm()) < sensed.magnitude_interval();
    azimuths += std::abs(std::remainder(sensed.azimuth() - std::atan2(p.y(), p.x()),
                                        2 * std::numbers::pi)) < sensed.azimuth_interval();
    likely += sensed.misfit_probability > 0.5;
  }
  EXPECT_NEAR(magnitudes, 0.95 * readings, 0.02 * readings);
  EXPECT_NEAR(azimuths, 0.95 * readings, 0.02 * readings);
  EXPECT_NEAR(likely, 0.5 * readings, 0.045 * readings);
}

// Oracle: a load has two components, so noise alone is taken for one in 5 % of the unloaded
// readings (binomial, 4 standard deviations: ±1.4 %). By 1.96 σ of one component it was 15 %. With
// the offset of one unloaded reading the noise is √2 times as much.
TEST(Inversion, TakesNoiseForALoadAsOftenAsItSays) {
  const sensing::Inversion invert(paper_response(), noise);
  std::mt19937 random(20262);
  std::normal_distribution<double> normal;
  constexpr int readings = 4000;
  for (const double variance : {1., 2.}) {
    int found = 0;
    int nothing = 0;
    for (int i = 0; i < readings; ++i) {
      Eigen::Vector3d change;
      for (int c = 0; c < 3; ++c) change[c] = std::sqrt(variance) * noise[c] * normal(random);
      const sensing::SensedLoad sensed = invert(change, {variance});
      found += sensing::status_of(sensed) == sensing::SenseStatus::found;
      nothing += sensing::status_of(sensed) == sensing::SenseStatus::nothing;
      EXPECT_EQ(sensed.is_nothing(), sensed.azimuth_interval() == std::numbers::pi);
    }
    EXPECT_NEAR(found, 0.05 * readings, 0.014 * readings) << variance;
    EXPECT_GE(found + nothing, 0.995 * readings);  // one in a thousand is a misfit
  }
}

// Oracle: the noncentral χ² of two degrees of freedom (Boost.Math): 0.35 % lie below 5.99.
TEST(Inversion, FindsLoadsOfFiveStandardDeviations) {
  const sensing::Inversion invert(paper_response(), noise);
  std::mt19937 random(20263);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  const Eigen::Matrix2d inverse_covariance = invert(Eigen::Vector3d::Zero()).covariance.inverse();
  constexpr int readings = 2000;
  int found = 0;
  for (int i = 0; i < readings; ++i) {
    sensing::Vector2 p = sensing::polar(1, 6.3 * uniform(random));
    p *= 5 / std::sqrt(p.dot(inverse_covariance * p));
    Eigen::VectorXd change = paper_response().change(p);
    for (int c = 0; c < 3; ++c) change[c] += noise[c] * normal(random);
    found += sensing::status_of(invert(change)) == sensing::SenseStatus::found;
  }
  const double missed = boost::math::cdf(boost::math::non_central_chi_squared(2, 25),
                                         boost::math::quantile(boost::math::chi_squared(2), 0.95));
  EXPECT_NEAR(missed, 0.0035, 1e-4);
  // Binomial, 4 standard deviations, and one misfit in a thousand.
  EXPECT_NEAR(found, (1 - missed - 0.001) * readings, 0.0062 * readings);
}

/// Simulated readings with a background: files of the stage's azimuths with noise, one unloaded
/// row, one loaded.
class WithBackground : public testing::Test {
 protected:
  /// Counts the intervals that hold the true load's magnitude and azimuth. `azimuths` of the
  /// background are each read `repeats` times; unloaded and loaded rows stand at any azimuth, or
  /// both at the background's one.
  void expect_coverage(int azimuths, int repeats, const sensing::Response& response) {
    constexpr int trials = 400;
    const auto sensors = static_cast<int>(response.sensors());
    std::vector<std::string> names;
    for (int s = 0; s < sensors; ++s) names.push_back(std::to_string(s));
    const sensing::Inversion invert(response, Vector3::Constant(sigma));
    int magnitudes = 0;
    int directions = 0;
    int misfits = 0;
    for (int trial = 0; trial < trials; ++trial) {
      std::ofstream background(folder_.path() / "background.csv");
      background << "azimuth [deg],Bx [T],By [T],Bz [T]\n";
      for (int a = 0; a < azimuths; ++a)
        for (int r = 0; r < repeats; ++r)
          background << fmt::format("{:.17g}{}\n", 360. * a / azimuths, noisy(Vector3::Zero()));
      background.close();
      const sensing::Vector2 p =
          sensing::polar(0.5e-3 + 3e-3 * uniform_(random_), 6.3 * uniform_(random_));
      const Eigen::VectorXd change = response.change(p);
      std::ofstream readings(folder_.path() / "readings.csv");
      readings << "sample,sensor,azimuth [deg],Bx [T],By [T],Bz [T]\n";
      for (const bool loaded : {false, true}) {
        const double azimuth = azimuths == 1 ? 0 : 360 * uniform_(random_);
        for (int s = 0; s < sensors; ++s)
          readings << fmt::format(
              "{},{},{:.17g}{}\n", loaded ? "a" : "unloaded", s, azimuth,
              noisy(loaded ? Vector3(change.segment<3>(3 * s)) : Vector3(Vector3::Zero())));
      }
      readings.close();
      const sensing::SensorReadings read = sensing::read_sensor_readings(
          folder_.path() / "readings.csv", folder_.path() / "background.csv", names, {});
      const sensing::Sample& sample = read.samples.at(0);
      const sensing::SensedLoad sensed = invert(sample.change, read.error(sample));
      magnitudes += std::abs(sensed.magnitude() - p.norm()) < sensed.magnitude_interval();
      directions += std::abs(std::remainder(sensed.azimuth() - std::atan2(p.y(), p.x()),
                                            2 * std::numbers::pi)) < sensed.azimuth_interval();
      misfits += sensed.misfit_probability < 0.05;
    }
    // Binomial, 4 standard deviations: ±4.4 %.
    EXPECT_NEAR(magnitudes, 0.95 * trials, 0.044 * trials) << azimuths << " x " << repeats;
    EXPECT_NEAR(directions, 0.95 * trials, 0.044 * trials) << azimuths << " x " << repeats;
    EXPECT_NEAR(misfits, 0.05 * trials, 0.044 * trials) << azimuths << " x " << repeats;
  }
  /// ",Bx,By,Bz" with noise.
  std::string noisy(const Vector3& B) {
    std::string text;
    for (const double component : B)
      text += fmt::format(",{:.17g}", component + sigma * normal_(random_));
    return text;
  }

  static constexpr double sigma = 0.5e-6;  ///< T
  test::TemporaryFolder folder_;
  std::mt19937 random_{20264};
  std::normal_distribution<double> normal_;
  std::uniform_real_distribution<double> uniform_;
};

// Without the background's own noise the intervals held the truth in 78–83 %.
TEST_F(WithBackground, IntervalsHoldTheTruthAsOftenAsTheySay) {
  for (const int azimuths : {1, 2, 5, 20}) expect_coverage(azimuths, 1, paper_response());
  expect_coverage(1, 20, paper_response());
  expect_coverage(4, 5, paper_response());
}

// Both sensors have the same rows of the background, whose error is then the same.
TEST_F(WithBackground, SensorsThatShareItAreCorrelated) {
  const input::Case problem = test::paper_case({1e-3});
  const std::vector<Vector3> sensors{{1e-3, 0, -1.55e-3}, {-1e-3, 0.5e-3, -1.55e-3}};
  const sensing::Response response(problem, "volume",
                                   sensing::shapes_up_to(problem, "elastica", 4e-3), sensors);
  expect_coverage(5, 1, response);
}

// Unloaded rows at several azimuths have the noise of several background rows: that alone makes no
// doubt. Rows of another load do. Oracle: χ² of (rows − 1) · 3 is as large as its mean.
TEST_F(WithBackground, TheScatterOfRowsKnowsItsNoise) {
  double squares = 0;
  std::size_t freedom = 0;
  for (int trial = 0; trial < 200; ++trial) {
    std::ofstream background(folder_.path() / "background.csv");
    std::ofstream readings(folder_.path() / "readings.csv");
    background << "azimuth [deg],Bx [T],By [T],Bz [T]\n";
    readings << "sample,azimuth [deg],Bx [T],By [T],Bz [T]\na,10,0,0,0\n";
    for (int azimuth = 0; azimuth < 360; azimuth += 60) {
      background << azimuth << noisy(Vector3::Zero()) << '\n';
      for (const int between : {0, 0, 20})
        readings << "unloaded," << azimuth + between << noisy(Vector3::Zero()) << '\n';
    }
    background.close();
    readings.close();
    const std::vector<std::string> names{"0"};
    const sensing::SensorReadings read = sensing::read_sensor_readings(
        folder_.path() / "readings.csv", folder_.path() / "background.csv", names, {});
    squares += read.scatter.squares / (sigma * sigma);
    freedom += read.scatter.freedom;
  }
  EXPECT_EQ(freedom, 200U * 3 * 17);
  // χ² of f degrees of freedom has the standard deviation √(2f): 4 of them are 5.6 %.
  EXPECT_NEAR(squares / static_cast<double>(freedom), 1, 0.056);
}

TEST(Inversion, SaysWhatAReadingDoesNotTell) {
  const sensing::Inversion invert(paper_response(), noise);
  const sensing::SensedLoad nothing = invert(Eigen::Vector3d(1e-7, -1e-7, 0));
  EXPECT_EQ(nothing.azimuth_interval(), std::numbers::pi);
  EXPECT_GE(nothing.magnitude_interval(), nothing.magnitude());
  const sensing::SensedLoad large = invert(paper_response().change(sensing::polar(4.4e-3, 1)));
  EXPECT_TRUE(large.beyond_range);
  // Readings that no load makes: ΔB_z alone, half a millitesla of it.
  EXPECT_LT(invert(Eigen::Vector3d(0, 0, 5e-4)).misfit_probability, 1e-12);
  EXPECT_THROW(invert(Eigen::Vector3d(0, std::nan(""), 0)), InputError);
  EXPECT_THROW(invert(Eigen::VectorXd::Zero(6)), InputError);
  EXPECT_THROW(sensing::Inversion(paper_response(), Vector3(1e-6, 0, 1e-6)), InputError);
}

// Small loads: the response is linear in them, and the paper's fit inverts it. Over the whole range
// it is off.
TEST(LinearFit, InvertsSmallLoads) {
  const input::Case problem = test::paper_case({1e-3});
  const sensing::Response small(problem, "volume", sensing::shapes_up_to(problem, "elastica", 1e-6),
                                problem.sensors);
  const sensing::LinearFit fit(small, noise);
  const sensing::Vector2 p = sensing::polar(0.6e-6, 2);
  EXPECT_LT((fit(small.change(p)) - p).norm(), 1e-4 * p.norm());
  EXPECT_LT(fit.misfit(), 1e-3);
  EXPECT_GT(sensing::LinearFit(paper_response(), noise).misfit(), 10 * fit.misfit());
}

}  // namespace
}  // namespace ciliaval::compare
