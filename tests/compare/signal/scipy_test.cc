// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

#include "compare/signal/butterworth.h"
#include "tests/support/temporary_folder.h"

namespace ciliaval::compare {
namespace {
using nlohmann::json;
using Sections = std::vector<signal::SecondOrderSection>;

struct Design {
  unsigned int order = 0;
  double cutoff = 0;  ///< of the sampling rate
};

std::vector<Design> designs(unsigned int highest, const std::vector<double>& cutoffs) {
  std::vector<Design> result;
  for (unsigned int order = 1; order <= highest; ++order)
    for (const double cutoff : cutoffs) result.push_back({order, cutoff});
  return result;
}

json rows(const Sections& sections) {
  json result;
  for (const auto& [b0, b1, b2, a1, a2] : sections) result.push_back({b0, b1, b2, 1.0, a1, a2});
  return result;
}

double distance(const std::vector<double>& a, const std::vector<double>& b) {
  EXPECT_EQ(a.size(), b.size());
  double result = a.size() == b.size() ? 0 : HUGE_VAL;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    result = std::max(result, std::abs(a[i] - b[i]));
  return result;
}

/// SciPy as the oracle: it shares no code with ours.
class SciPy : public testing::Test {
 protected:
  static constexpr double sampling_rate = 800;  // Hz

  void SetUp() override {
    if (std::string(CILIAVAL_SCIPY_PYTHON).empty())
      GTEST_SKIP() << "no Python with SciPy: apt-get install python3-scipy, then configure again";
  }

  /// About 1, of which the filter must not see much, by up to 1.
  static std::vector<double> random_series(std::size_t size) {
    std::mt19937 generator(20);  // NOLINT(cert-msc51-cpp): the same series in every run
    std::uniform_real_distribution<double> unit(-1, 1);
    std::vector<double> result(size);
    for (double& value : result) value = 1 + unit(generator);
    return result;
  }

  static json ask(const json& cases) {
    const test::TemporaryFolder folder;
    folder.write("in.json", cases.dump());
    const std::string command = "cd '" + folder.path().string() +
                                "' && '" CILIAVAL_SCIPY_PYTHON "' '" CILIAVAL_SOURCE_DIR
                                "/tests/compare/signal/scipy_filter.py' <in.json >out.json";
    EXPECT_EQ(std::system(command.c_str()), 0) << command;
    return json::parse(test::read_text(folder.path() / "out.json"));
  }

  struct Differences {
    double at_rest = 0;
    double steady = 0;
    double both_ways = 0;
  };

  /// The largest differences of the filtered series, whose input is 2 at most.
  static Differences differences(const std::vector<Design>& designs,
                                 const std::vector<double>& series, bool same_coefficients) {
    json cases;
    for (const auto& [order, cutoff] : designs) {
      json one{{"order", order},
               {"cutoff", cutoff * sampling_rate},
               {"sampling_rate", sampling_rate},
               {"series", series}};
      if (same_coefficients)
        one["sos"] =
            rows(signal::butterworth_highpass(order, cutoff * sampling_rate, sampling_rate));
      cases.push_back(std::move(one));
    }
    const json answers = ask(cases);
    EXPECT_EQ(answers.size(), designs.size());
    Differences result;
    for (std::size_t i = 0; i < answers.size(); ++i) {
      const Sections sections = signal::butterworth_highpass(
          designs[i].order, designs[i].cutoff * sampling_rate, sampling_rate);
      const auto compare = [&](double& worst, const char* name, const std::vector<double>& ours) {
        worst = std::max(worst, distance(ours, answers[i].at(name)));
      };
      compare(result.at_rest, "at_rest", signal::filter(sections, series, 0));
      compare(result.steady, "steady", signal::filter(sections, series, series.front()));
      compare(result.both_ways, "both_ways", signal::filter_both_ways(sections, series));
    }
    std::printf("differences: %.1e at rest, %.1e steady, %.1e both ways\n", result.at_rest,
                result.steady, result.both_ways);
    return result;
  }
};

// Measured up to order 20: 3e-15.
TEST_F(SciPy, DesignsTheSameSections) {
  const std::vector<Design> all =
      designs(20, {1e-4, 1e-3, 0.01, 0.05, 0.1, 0.2, 0.25, 0.3, 0.4, 0.49});
  json cases;
  for (const auto& [order, cutoff] : all)
    cases.push_back({{"order", order},
                     {"cutoff", cutoff * sampling_rate},
                     {"sampling_rate", sampling_rate},
                     {"series", random_series(100)}});
  const json answers = ask(cases);
  ASSERT_EQ(answers.size(), all.size());
  double worst = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto& [order, cutoff] = all[i];
    const json ours =
        rows(signal::butterworth_highpass(order, cutoff * sampling_rate, sampling_rate));
    const json& theirs = answers[i].at("sos");
    ASSERT_EQ(ours.size(), theirs.size());
    for (std::size_t s = 0; s < ours.size(); ++s)
      for (const std::size_t first : {0U, 3U}) {  // numerator, denominator
        // Of the largest coefficient: at a quarter of the sampling rate a1 is 0 but for rounding.
        double scale = 0;
        double difference = 0;
        for (std::size_t j = first; j < first + 3; ++j) {
          const double coefficient = theirs[s][j];
          scale = std::max(scale, std::abs(coefficient));
          difference = std::max(difference, std::abs(ours[s][j].get<double>() - coefficient));
        }
        worst = std::max(worst, difference / scale);
        EXPECT_LE(difference, 1e-12 * scale) << order << ", " << cutoff << ", section " << s;
      }
  }
  std::printf("coefficients: %.1e\n", worst);
}

// The same sections in both: the same sums in the same order, 0 where nothing is contracted.
TEST_F(SciPy, FiltersTheSameAtRest) {
  const std::vector<Design> all =
      designs(8, {1e-4, 1e-3, 0.01, 0.05, 0.1, 0.2, 0.25, 0.3, 0.4, 0.49});
  EXPECT_LE(differences(all, random_series(1000), true).at_rest, 1e-12);
}

// Both design their own filter. Measured: 3e-13.
TEST_F(SciPy, FiltersTheSameByItsOwnSections) {
  const Differences found = differences(
      designs(8, {0.005, 0.01, 0.05, 0.1, 0.2, 0.25, 0.3, 0.4, 0.49}), random_series(1000), false);
  EXPECT_LE(found.at_rest, 1e-12);
  EXPECT_LE(found.steady, 1e-12);
  EXPECT_LE(found.both_ways, 1e-12);
}

// At a low cut-off 1 + a1 + a2 is about (2π f_c/f_s)², 4e-7 at 1e-4, and a rounding error of the
// coefficients counts as many times more; so does SciPy's in its steady state, which is a quotient
// by that sum. Measured: 2e-10, 6e-10, 5e-10.
TEST_F(SciPy, DiffersByRoundingOfTheSectionsAtALowCutOff) {
  const Differences found = differences(designs(8, {1e-4, 1e-3}), random_series(1000), false);
  EXPECT_LE(found.at_rest, 1e-9);
  EXPECT_LE(found.steady, 2e-9);
  EXPECT_LE(found.both_ways, 2e-9);
}

}  // namespace
}  // namespace ciliaval::compare
