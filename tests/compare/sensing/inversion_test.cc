// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/sensing/inversion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "problem/error.h"
#include "tests/support/synthetic.h"

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
