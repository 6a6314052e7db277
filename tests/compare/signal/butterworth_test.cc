// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/signal/butterworth.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <functional>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "problem/error.h"

namespace ciliaval::compare {
namespace {
using std::numbers::pi;
using testing::HasSubstr;
using Sections = std::vector<signal::SecondOrderSection>;

/// |H| of the analogue filter at the frequencies that the bilinear transform maps f_c and f to.
double analytic_magnitude(unsigned int order, double cutoff, double f, double sampling_rate) {
  const double ratio = std::tan(pi * cutoff / sampling_rate) / std::tan(pi * f / sampling_rate);
  return 1 / std::sqrt(1 + std::pow(ratio, 2.0 * order));
}

std::complex<double> transfer(const Sections& sections, double f, double sampling_rate) {
  const std::complex<double> w = std::polar(1.0, -2 * pi * f / sampling_rate);  // z⁻¹
  std::complex<double> result = 1;
  for (const auto& [b0, b1, b2, a1, a2] : sections)
    result *= (b0 + w * (b1 + w * b2)) / (1.0 + w * (a1 + w * a2));
  return result;
}

std::vector<double> sine(double f, double sampling_rate, std::size_t size) {
  std::vector<double> result(size);
  for (std::size_t k = 0; k < size; ++k)
    result[k] = std::sin(2 * pi * f * static_cast<double>(k) / sampling_rate);
  return result;
}

/// Amplitude and phase of the samples [first, last), a whole number of periods of sin(2πft).
std::complex<double> phasor(const std::vector<double>& series, double f, double sampling_rate,
                            std::size_t first, std::size_t last) {
  std::complex<double> sum = 0;
  for (std::size_t k = first; k < last; ++k)
    sum += series[k] * std::polar(1.0, -2 * pi * f * static_cast<double>(k) / sampling_rate);
  return sum * std::complex<double>(0, 2) / static_cast<double>(last - first);
}

TEST(Butterworth, IsZeroAtDcOneAtNyquistAndDownByThreeDecibelsAtTheCutOff) {
  double worst = 0;
  for (unsigned int order = 1; order <= signal::highest_order; ++order)
    for (const double cutoff : {0.08, 1.0, 8.0, 50.0, 200.0, 320.0, 390.0}) {
      const Sections sections = signal::butterworth_highpass(order, cutoff, 800);
      EXPECT_EQ(std::abs(transfer(sections, 0, 800)), 0);
      EXPECT_NEAR(std::abs(transfer(sections, 400, 800)), 1, 1e-12) << order << ", " << cutoff;
      // A rounding error of the coefficients counts 1/c² times at a low cut-off, up to 1e7 times
      // here. Measured: 2e-9 at 0.08 Hz, 2e-14 from 8 Hz on.
      const double c = std::tan(pi * cutoff / 800);
      const double error = std::abs(transfer(sections, cutoff, 800)) * std::numbers::sqrt2 - 1;
      worst = std::max(worst, std::abs(error) / std::max(1.0, 1 / (c * c)));
      EXPECT_LE(std::abs(error), 1e-15 * std::max(1000.0, 1 / (c * c))) << order << ", " << cutoff;
    }
  std::printf("at the cut-off: %.1e\n", worst);
}

// Oracle: the closed form. Measured: 3e-12 of it.
TEST(Butterworth, HasTheAnalyticMagnitude) {
  double worst = 0;
  for (unsigned int order = 1; order <= signal::highest_order; ++order)
    for (const double cutoff : {8.0, 50.0, 200.0, 320.0, 390.0})
      for (const double part : {0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 0.9, 0.99}) {
        const double f = 400 * part;
        const double magnitude =
            std::abs(transfer(signal::butterworth_highpass(order, cutoff, 800), f, 800));
        worst =
            std::max(worst, std::abs(magnitude / analytic_magnitude(order, cutoff, f, 800) - 1));
      }
  std::printf("magnitude: %.1e\n", worst);
  EXPECT_LE(worst, 2e-11);
}

// The poles of a section lie inside the unit circle if |a2| < 1 and |a1| < 1 + a2.
TEST(Butterworth, IsStable) {
  for (unsigned int order = 1; order <= signal::highest_order; ++order)
    for (const double cutoff : {1e-6, 1e-4, 0.1, 0.25, 0.4, 0.4999})
      for (const auto& section : signal::butterworth_highpass(order, cutoff, 1)) {
        EXPECT_LT(std::abs(section.a2), 1) << order << ", " << cutoff;
        EXPECT_LT(std::abs(section.a1), 1 + section.a2) << order << ", " << cutoff;
      }
}

// Oracle: the step response of H = g (1 − z⁻¹)/(1 − r z⁻¹) is g r^k, g = 1/(1 + c), r = (1 − c)/(1
// + c).
TEST(Filter, FirstOrdersStepResponseIsGeometric) {
  const double c = std::tan(pi * 3 / 100);
  const std::vector<double> response =
      signal::filter(signal::butterworth_highpass(1, 3, 100), std::vector<double>(200, 2.0), 0);
  for (std::size_t k = 0; k < response.size(); ++k)
    EXPECT_NEAR(response[k], 2 / (1 + c) * std::pow((1 - c) / (1 + c), k), 1e-14) << k;
}

// Oracle: the closed form of the magnitude. From rest, and read when the start has died away.
TEST(Filter, ASineComesOutWithTheAnalyticMagnitude) {
  for (const unsigned int order : {1U, 2U, 3U, 4U, 7U, 8U})
    for (const double f : {2.0, 4.0, 5.0, 10.0, 40.0}) {
      const std::vector<double> filtered =
          signal::filter(signal::butterworth_highpass(order, 5, 100), sine(f, 100, 2000), 0);
      EXPECT_NEAR(std::abs(phasor(filtered, f, 100, 1000, 2000)),
                  analytic_magnitude(order, 5, f, 100), 1e-12)
          << order << ", " << f;
    }
}

// Oracle: a high-pass filter does not see a constant. Exact: no digits are lost to the offset.
TEST(Filter, SteadyStartTakesTheOffsetAway) {
  std::mt19937 generator(3);  // NOLINT(cert-msc51-cpp): the same series in every run
  std::vector<double> small(500);
  for (double& value : small) value = std::ldexp(static_cast<double>(generator() >> 12), -20);
  small.front() = 0;
  std::vector<double> raised = small;
  for (double& value : raised) value += 4096;
  const Sections sections = signal::butterworth_highpass(4, 0.1, 100);
  EXPECT_EQ(signal::filter(sections, raised, raised.front()), signal::filter(sections, small, 0));
  EXPECT_EQ(signal::filter(sections, std::vector<double>(500, 0.1), 0.1),
            std::vector<double>(500, 0.0));
}

// Another filter than a high-pass one: a mean of two samples keeps the constant.
TEST(Filter, KeepsAConstantThatTheSectionsLetThrough) {
  const Sections mean{{0.5, 0.5, 0, 0, 0}, {1, 0, 0, -0.5, 0}};  // H(1) = 2
  EXPECT_EQ(signal::filter(mean, std::vector<double>(5, 3.0), 3), std::vector<double>(5, 6.0));
}

// Oracle: |H|² of the closed form, and no phase.
TEST(FilterBothWays, SquaresTheMagnitudeAndDoesNotShift) {
  for (const unsigned int order : {1U, 2U, 3U, 4U, 7U, 8U})
    for (const double f : {2.0, 4.0, 5.0, 10.0, 40.0}) {
      const std::vector<double> filtered =
          signal::filter_both_ways(signal::butterworth_highpass(order, 5, 100), sine(f, 100, 3000));
      const double magnitude = analytic_magnitude(order, 5, f, 100);
      const std::complex<double> found = phasor(filtered, f, 100, 1000, 2000);
      EXPECT_NEAR(found.real(), magnitude * magnitude, 1e-12) << order << ", " << f;
      EXPECT_NEAR(found.imag(), 0, 1e-12) << order << ", " << f;
    }
}

TEST(FilterBothWays, NeedsMoreSamplesThanItsReflection) {
  for (const unsigned int order : {1U, 2U, 3U, 4U, 20U}) {
    const Sections sections = signal::butterworth_highpass(order, 5, 100);
    const std::size_t padding = 3 * (order + 1);
    EXPECT_EQ(signal::filter_both_ways(sections, std::vector<double>(padding + 1, 7.0)),
              std::vector<double>(padding + 1, 0.0));
    try {
      signal::filter_both_ways(sections, std::vector<double>(padding, 7.0));
      ADD_FAILURE() << order;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr("more than " + std::to_string(padding) + " samples"));
    }
  }
}

TEST(Filter, BadInputsAreInputErrors) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  const auto message = [](const std::function<void()>& call) -> std::string {
    try {
      call();
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  };
  const auto design = [&](unsigned int order, double cutoff, double rate) {
    return message([=] { signal::butterworth_highpass(order, cutoff, rate); });
  };
  EXPECT_THAT(design(0, 5, 100), HasSubstr("1 to 20, not 0"));
  EXPECT_THAT(design(21, 5, 100), HasSubstr("1 to 20, not 21"));
  for (const double cutoff : {0.0, -5.0, 0.99e-4, 50.0, 60.0, nan, infinity})
    EXPECT_THAT(design(4, cutoff, 100), HasSubstr("cut-off")) << cutoff;
  for (const double rate : {0.0, -100.0, nan, infinity})
    EXPECT_THAT(design(4, 5, rate), HasSubstr("sampling rate")) << rate;
  const Sections sections = signal::butterworth_highpass(4, 5, 100);
  for (const double bad : {nan, infinity, -infinity}) {
    std::vector<double> series(100, 1.0);
    series[41] = bad;
    EXPECT_THAT(message([&] { signal::filter(sections, series, 0); }), HasSubstr("sample 42 is"));
    EXPECT_THAT(message([&] { signal::filter_both_ways(sections, series); }),
                HasSubstr("not a finite number"));
    EXPECT_THAT(message([&] { signal::filter(sections, std::vector<double>(9, 1.0), bad); }),
                HasSubstr("not a finite number"));
  }
}

}  // namespace
}  // namespace ciliaval::compare
