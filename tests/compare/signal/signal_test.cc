// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/signal/signal.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "compare/signal/butterworth.h"
#include "problem/error.h"

namespace ciliaval::compare {
namespace {
using signal::Signal;
using signal::SignalOptions;
using testing::HasSubstr;

/// No field for a time, so that the record is its noise.
Signal noise(const SignalOptions& options, double duration, std::uint32_t sensor = 0) {
  const std::vector<double> times{0, duration};
  return signal::record(times, std::vector<Vector3>(2, Vector3::Zero()), options, sensor);
}

std::vector<double> component(const std::vector<Vector3>& values, int i) {
  std::vector<double> result;
  result.reserve(values.size());
  for (const Vector3& value : values) result.push_back(value[i]);
  return result;
}

/// Σ a_k b_{k+lag}/(n σ²): for independent noise of standard deviation σ about 0 ± 1/√n.
double correlation(const std::vector<double>& a, const std::vector<double>& b, std::size_t lag,
                   double sigma) {
  double sum = 0;
  for (std::size_t k = 0; k + lag < a.size(); ++k) sum += a[k] * b[k + lag];
  return sum / (static_cast<double>(a.size()) * sigma * sigma);
}

// Oracle: the straight lines themselves, drawn through uneven times; numbers that are exact.
TEST(Record, SamplesTheStraightLineBetweenTwoTimes) {
  const std::vector<double> times{1, 1.25, 3};
  const std::vector<Vector3> B{{0, 8, -1}, {4, 8, -1}, {4, 1, -1}};
  const Signal result = signal::record(times, B, {.sampling_rate = 8});
  ASSERT_EQ(result.time.size(), 17);
  for (std::size_t k = 0; k < result.time.size(); ++k) {
    const double t = 1 + static_cast<double>(k) / 8;
    EXPECT_EQ(result.time[k], t);
    const Vector3 expected(std::min(4.0, 16 * (t - 1)), std::min(8.0, 8 - 4 * (t - 1.25)), -1);
    EXPECT_LE((result.raw[k] - expected).norm(), 1e-14) << t;
    EXPECT_EQ(result.filtered[k], result.raw[k]) << "no filter";
  }
}

TEST(Record, DoesNotOvershootAtAJump) {
  const std::vector<double> times{0, 0.3, 0.5, 0.5 + 1e-9, 0.8, 1};
  std::vector<Vector3> B(times.size(), Vector3(1, 2, 3));
  for (std::size_t i = 3; i < B.size(); ++i) B[i] *= -1;
  const Signal result = signal::record(times, B, {.sampling_rate = 100});
  ASSERT_EQ(result.raw.size(), 101);
  for (std::size_t k = 0; k < result.raw.size(); ++k)
    EXPECT_LE((result.raw[k] - (k <= 50 ? 1 : -1) * Vector3(1, 2, 3)).norm(), 1e-15) << k;
}

// Neither 0.1 nor 0.3 − 0.1 is exact: the last sample must not be lost to rounding.
TEST(Record, EndsWithTheLastTime) {
  for (const double last : {0.3, 0.7, 1.1, 5.9}) {
    const std::vector<double> times{0.1, last};
    const std::vector<Vector3> B{{0, 0, 0}, {1, 1, 1}};
    const Signal result = signal::record(times, B, {.sampling_rate = 10});
    EXPECT_EQ(result.time.size(), std::lround(10 * (last - 0.1)) + 1);
    EXPECT_NEAR(result.raw.back().x(), 1, 1e-14);
    EXPECT_LE(result.time.back(), last);
  }
}

// Quantiles of the standard error: 4.5 of it is exceeded once in 150,000 seeds.
TEST(Noise, IsGaussianOfTheGivenStandardDeviation) {
  const double sigma = 0.4e-6;
  const SignalOptions options{.sampling_rate = 1000, .noise = sigma, .seed = 7};
  const Signal record = noise(options, 100);
  for (const int i : {0, 1, 2}) {
    std::vector<double> values = component(record.raw, i);
    const auto n = static_cast<double>(values.size());
    double mean = 0;
    double variance = 0;
    for (const double value : values) {
      mean += value / n;
      variance += value * value / n;
    }
    EXPECT_LE(std::abs(mean), 4.5 * sigma / std::sqrt(n));
    EXPECT_LE(std::abs(variance / (sigma * sigma) - 1), 4.5 * std::sqrt(2 / n));
    // Kolmogorov's distance from the normal distribution; √n D > 1.95 once in 1,000.
    std::ranges::sort(values);
    double distance = 0;
    for (std::size_t k = 0; k < values.size(); ++k) {
      const double below = std::erfc(-values[k] / sigma / std::numbers::sqrt2) / 2;
      distance = std::max(
          {distance, below - static_cast<double>(k) / n, static_cast<double>(k + 1) / n - below});
    }
    EXPECT_LE(distance * std::sqrt(n), 1.95) << i;
  }
}

TEST(Noise, IsIndependentInTimeAndOfOtherComponentsSensorsAndSeeds) {
  const SignalOptions options{.sampling_rate = 1000, .noise = 2, .seed = 7};
  SignalOptions other = options;
  other.seed = 8;
  std::vector<std::vector<double>> series;
  for (const Signal& record :
       {noise(options, 100, 0), noise(options, 100, 1), noise(other, 100, 0)})
    for (const int i : {0, 1, 2}) series.push_back(component(record.raw, i));
  const double bound = 4.5 / std::sqrt(static_cast<double>(series.front().size()));
  for (std::size_t i = 0; i < series.size(); ++i)
    for (std::size_t j = i; j < series.size(); ++j)
      for (std::size_t lag = i == j ? 1 : 0; lag <= 3; ++lag)
        EXPECT_LE(std::abs(correlation(series[i], series[j], lag, 2)), bound)
            << i << ", " << j << ", " << lag;
}

TEST(Noise, IsTheSameForTheSameSeedWhateverTheFieldAndTheLength) {
  const SignalOptions options{.sampling_rate = 50, .noise = 1, .seed = 5};
  const Signal record = noise(options, 10);
  EXPECT_EQ(noise(options, 10).raw, record.raw);
  const Signal longer = noise(options, 20);
  EXPECT_TRUE(std::equal(record.raw.begin(), record.raw.end(), longer.raw.begin()));
  SignalOptions twice = options;
  twice.noise = 2;
  const std::vector<double> times{0, 10};
  const Signal with_field = signal::record(times, std::vector<Vector3>(2, {8, 16, 32}), twice);
  for (std::size_t k = 0; k < record.raw.size(); ++k)
    EXPECT_LE((with_field.raw[k] - Vector3(8, 16, 32) - 2 * record.raw[k]).norm(), 1e-13);
}

// Oracle: white noise leaves the filter with the variance σ² ∫|H|² df/(f_s/2), |H|⁴ both ways; the
// integral of the closed form by the midpoint rule.
TEST(Record, FilterPassesItsShareOfTheNoise) {
  SignalOptions options{.sampling_rate = 100, .noise = 3, .seed = 11, .order = 4, .cutoff = 20};
  for (const auto& [phase, power] :
       {std::pair{SignalOptions::Phase::causal, 1}, std::pair{SignalOptions::Phase::zero, 2}}) {
    options.phase = phase;
    double share = 0;
    const int intervals = 2000;
    for (int i = 0; i < intervals; ++i) {
      const double x =
          std::tan(std::numbers::pi * 0.2) / std::tan(std::numbers::pi / 2 * (i + 0.5) / intervals);
      share += std::pow(1 / (1 + std::pow(x, 8)), power) / intervals;
    }
    const std::vector<double> values = component(noise(options, 1000).filtered, 1);
    // Filtered noise is correlated: fewer independent samples, but no less than a half.
    EXPECT_NEAR(correlation(values, values, 0, 3), share,
                4.5 * share * std::sqrt(4.0 / static_cast<double>(values.size())));
  }
}

// A field of 5 mT at rest that a sine of 1 µT disturbs from the middle on: the offset is not seen.
TEST(Record, FilterTakesTheRestingFieldAwayFromTheFirstSampleOn) {
  std::vector<double> times;
  std::vector<Vector3> B;
  for (int k = 0; k <= 4000; ++k) {
    times.push_back(k / 400.0);
    const double sine = k < 2000 ? 0 : 1e-6 * std::sin(2 * std::numbers::pi * 20 * times.back());
    B.emplace_back(5e-3, -2e-3 + sine, 1e-3);
  }
  SignalOptions options{.sampling_rate = 400, .order = 4, .cutoff = 1};
  for (const auto phase : {SignalOptions::Phase::causal, SignalOptions::Phase::zero}) {
    options.phase = phase;
    const Signal result = signal::record(times, B, options);
    double before = 0;
    double sine = 0;
    for (std::size_t k = 0; k < result.filtered.size(); ++k) {
      EXPECT_LE(std::abs(result.filtered[k].x()), 1e-15) << k;
      EXPECT_LE(std::abs(result.filtered[k].z()), 1e-15) << k;
      const double y = std::abs(result.filtered[k].y());
      if (k < 1000) before = std::max(before, y);
      if (k >= 2800 && k < 3200) sine = std::max(sine, y);  // 20 samples a period
    }
    // The filter that runs backwards sees the sine 2.5 s ahead: measured 2.1e-11.
    EXPECT_LE(before, phase == SignalOptions::Phase::causal ? 1e-15 : 1e-10);
    EXPECT_NEAR(sine, 1e-6, 0.02e-6);
  }
}

TEST(Record, FiltersEachComponentByTheChosenPhase) {
  SignalOptions options{.sampling_rate = 50, .noise = 1, .seed = 2, .order = 3, .cutoff = 4};
  const auto sections = signal::butterworth_highpass(3, 4, 50);
  const Signal causal = noise(options, 10);
  options.phase = SignalOptions::Phase::zero;
  const Signal zero = noise(options, 10);
  for (const int i : {0, 1, 2}) {
    const std::vector<double> raw = component(causal.raw, i);
    EXPECT_EQ(component(causal.filtered, i), signal::filter(sections, raw, raw.front()));
    EXPECT_EQ(component(zero.filtered, i), signal::filter_both_ways(sections, raw));
  }
}

TEST(Record, WithoutACutOffTheRecordIsTheRawOne) {
  const Signal result = noise({.sampling_rate = 50, .noise = 1, .seed = 2, .order = 3}, 10);
  EXPECT_GT(result.raw.size(), 400U);
  EXPECT_EQ(result.filtered, result.raw);
}

TEST(Record, BadInputsAreInputErrors) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  const SignalOptions good{.sampling_rate = 50, .noise = 1e-6, .seed = 2, .order = 4, .cutoff = 4};
  const std::vector<double> times{0, 1, 2};
  const std::vector<Vector3> B(3, Vector3(1e-3, 0, 0));
  ASSERT_NO_THROW(signal::record(times, B, good));
  const auto message = [](const std::vector<double>& t, const std::vector<Vector3>& b,
                          const SignalOptions& options) -> std::string {
    try {
      signal::record(t, b, options);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_THAT(message({}, {}, good), HasSubstr("two times or more"));
  EXPECT_THAT(message({0}, {B[0]}, good), HasSubstr("two times or more"));
  EXPECT_THAT(message({0, 1}, B, good), HasSubstr("2 times and 3 fields"));
  EXPECT_THAT(message({0, 1, 1}, B, good), HasSubstr("after 1 s comes 1 s (number 3)"));
  EXPECT_THAT(message({0, 1, 0.5}, B, good), HasSubstr("after 1 s comes 0.5 s (number 3)"));
  EXPECT_THAT(message({0, nan, 2}, B, good), HasSubstr("2 of 3 is not finite"));
  EXPECT_THAT(message({0, 1, infinity}, B, good), HasSubstr("3 of 3 is not finite"));
  EXPECT_THAT(message(times, {B[0], Vector3(0, nan, 0), B[2]}, good),
              HasSubstr("2 of 3 is not finite"));

  const auto with = [&](const std::function<void(SignalOptions&)>& change) {
    SignalOptions options = good;
    change(options);
    return message(times, B, options);
  };
  for (const double bad : {0.0, -1.0, nan, infinity})
    EXPECT_THAT(with([&](SignalOptions& o) { o.sampling_rate = bad; }),
                HasSubstr("the sampling rate must be finite and positive"));
  for (const double bad : {-1e-9, nan, infinity})
    EXPECT_THAT(with([&](SignalOptions& o) { o.noise = bad; }), HasSubstr("standard deviation"));
  EXPECT_THAT(with([](SignalOptions& o) { o.order = 21; }), HasSubstr("1 to 20, not 21"));
  for (const double bad : {-1.0, 1e-9, 25.0, nan})
    EXPECT_THAT(with([&](SignalOptions& o) { o.cutoff = bad; }), HasSubstr("the cut-off"));
  EXPECT_THAT(with([](SignalOptions& o) { o.sampling_rate = 0.4; }),
              HasSubstr("shorter than one interval"));
  EXPECT_THAT(with([](SignalOptions& o) { o.sampling_rate = 6e6; }),
              HasSubstr("more than 1e+07 samples"));
  EXPECT_THAT(with([](SignalOptions& o) {
                o.sampling_rate = 5;
                o.cutoff = 1;
                o.phase = SignalOptions::Phase::zero;
              }),
              HasSubstr("more than 15 samples; there are 11"));
}

}  // namespace
}  // namespace ciliaval::compare
