// SPDX-License-Identifier: LGPL-2.1-or-later
#include "problem/surroundings/surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <functional>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "problem/error.h"

namespace ciliaval {
using namespace surroundings;
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

TrapezoidProfile trapezoid() {
  return {.height = 2e-3, .top = 10e-3, .bottom = 8e-3, .flank = 3e-3, .radius = 1e-3};
}

RandomProfile::Parameters rough() {
  return {.rms = 30e-6, .hurst = 0.7, .longest = 20e-3, .shortest = 0.1e-3, .seed = 7};
}

std::vector<Surface> surfaces() {
  std::vector<double> x;
  std::vector<double> height;
  for (int i = 0; i <= 40; ++i) {
    x.push_back(-20e-3 + 1e-3 * i + 0.2e-3 * std::sin(i));
    height.push_back(1e-3 * std::sin(300 * x.back()));
  }
  return {{FlatProfile{}, 0.1, 0.02},
          {SineProfile{1e-3, 7e-3}, 0, 0},
          {trapezoid(), 0.3, -0.01},
          {SampledProfile(x, height), 0, 0},
          {RandomProfile(rough()), 0, 0}};
}

TEST(Surface, SlopeIsTheDerivativeOfTheHeight) {
  const double h = 2e-8;  // m
  for (const Surface& surface : surfaces())
    for (int i = 0; i < 81; ++i) {
      const double x = -15.01e-3 + 0.37e-3 * i;
      const ProfilePoint here = surface.at(x);
      const ProfilePoint before = surface.at(x - h);
      const ProfilePoint after = surface.at(x + h);
      EXPECT_NEAR(here.slope, (after.height - before.height) / (2 * h), 1e-7) << x;
    }
}

TEST(Surface, TiltIsASlope) {
  const Surface surface{FlatProfile{}, 0, 0.02};
  EXPECT_DOUBLE_EQ(surface.at(3e-3).height, 3e-3 * std::tan(0.02));
  EXPECT_DOUBLE_EQ(surface.at(3e-3).slope, std::tan(0.02));
}

TEST(TrapezoidProfile, HasItsLengthsAndRoundEdges) {
  const TrapezoidProfile t = trapezoid();
  const Surface surface{t, 0, 0};
  EXPECT_EQ(surface.at(0).height, 0);
  EXPECT_EQ(surface.at(3e-3).slope, 0);
  EXPECT_DOUBLE_EQ(surface.at(12e-3).height, t.height);         // middle of the plateau
  EXPECT_NEAR(surface.at(5.5e-3).height, t.height / 2, 1e-15);  // of the flank
  EXPECT_NEAR(surface.at(5.5e-3).slope, t.height / t.flank, 1e-15);
  EXPECT_NEAR(surface.at(18.5e-3).slope, -t.height / t.flank, 1e-12);  // down again
  EXPECT_NEAR(surface.at(24e-3 + 5.1e-3).height, surface.at(5.1e-3).height, 1e-15);
  // Around the lower corner, x = 4 mm, the points lie on the circle that touches p = 0.
  const double edge = t.radius * std::tan(std::atan(t.height / t.flank) / 2);
  for (int i = 1; i < 90; ++i) {
    const double x = 4e-3 - edge + 0.02 * i * edge;
    EXPECT_NEAR(std::hypot(x - (4e-3 - edge), surface.at(x).height - t.radius), t.radius, 1e-15);
  }
  // And no step of p or p′ where the pieces meet.
  for (int i = 0; i < 2400; ++i) {
    const double x = 1e-5 * i;
    EXPECT_NEAR(surface.at(x + 1e-9).height, surface.at(x).height, 1e-9);
    EXPECT_NEAR(surface.at(x + 1e-9).slope, surface.at(x).slope, 2e-6);
  }
}

TEST(SampledProfile, GoesThroughItsPointsAndEndsWithThem) {
  const std::vector<double> x{-1e-3, 0, 0.5e-3, 2e-3, 3e-3};
  const std::vector<double> height{0, 1e-4, 3e-4, 1e-4, 2e-4};
  const Surface surface{SampledProfile(x, height), 0, 0};
  for (std::size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(surface.at(x[i]).height, height[i], 1e-18);
  EXPECT_THROW(surface.at(3.1e-3), InputError);
  const ProfilePoint end = surface.at(3e-3);
  EXPECT_NEAR(surface.extended(3.1e-3).height, end.height + 1e-4 * end.slope, 1e-18);
  EXPECT_EQ(surface.finest_length(), 0.5e-3);
  EXPECT_THROW(surface.at(-1.1e-3), InputError);
}

/// Oracle: the discrete Fourier transform of samples over a period.
TEST(RandomProfile, HasTheSpectrumOfItsHurstExponent) {
  const Surface surface{RandomProfile(rough()), 0, 0};
  constexpr int n = 1000;
  std::vector<double> samples;
  double square = 0;
  for (int i = 0; i < n; ++i) {
    samples.push_back(surface.at(20e-3 * i / n).height);
    square += samples.back() * samples.back() / n;
  }
  EXPECT_NEAR(std::sqrt(square), 30e-6, 1e-15);
  const auto amplitude = [&](int j) {
    std::complex<double> sum = 0;
    for (int i = 0; i < n; ++i)
      sum +=
          samples[static_cast<std::size_t>(i)] * std::polar(1.0, -2 * std::numbers::pi * i * j / n);
    return 2 * std::abs(sum) / n;
  };
  for (const int j : {2, 20, 200})
    EXPECT_NEAR(amplitude(j) / amplitude(1), std::pow(j, -1.2), 1e-9) << j;
  EXPECT_LT(amplitude(201), 1e-12 * amplitude(1));  // below the shortest wavelength
  RandomProfile::Parameters other = rough();
  other.seed = 8;
  EXPECT_EQ(RandomProfile(rough()).at(1e-3).height, RandomProfile(rough()).at(1e-3).height);
  EXPECT_NE(RandomProfile(other).at(1e-3).height, RandomProfile(rough()).at(1e-3).height);
}

/// The message of the InputError that a function throws.
std::string refusal(const std::function<void()>& function) {
  try {
    function();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Surface, RefusesWhatMakesNoSense) {
  const auto of = [](const Surface& surface) { return refusal([&] { require_valid(surface); }); };
  for (const Surface& surface : surfaces()) EXPECT_EQ(of(surface), "");
  EXPECT_NE(of({FlatProfile{}, -0.1, 0}).find("friction"), std::string::npos);
  EXPECT_NE(of({FlatProfile{}, nan, 0}).find("friction"), std::string::npos);
  EXPECT_NE(of({FlatProfile{}, 0, 0.8}).find("tilt"), std::string::npos);
  EXPECT_NE(of({FlatProfile{}, 0, nan}).find("tilt"), std::string::npos);
  EXPECT_NE(of({SineProfile{nan, 1e-3}, 0, 0}).find("amplitude"), std::string::npos);
  EXPECT_NE(of({SineProfile{1e-3, 0}, 0, 0}).find("wavelength"), std::string::npos);
  TrapezoidProfile t = trapezoid();
  t.radius = 30e-3;
  EXPECT_NE(of({t, 0, 0}).find("smaller radius"), std::string::npos);
  t.radius = 0;
  EXPECT_NE(of({t, 0, 0}).find("sharp"), std::string::npos);
  t = trapezoid();
  t.flank = 0;
  EXPECT_NE(of({t, 0, 0}).find("upright"), std::string::npos);
  const auto sampled = [](std::vector<double> x, std::vector<double> height) {
    return refusal([&] { SampledProfile(std::move(x), std::move(height)); });
  };
  EXPECT_NE(sampled({0}, {0}).find("four points"), std::string::npos);
  EXPECT_NE(sampled({0, 1, 2, 3}, {0, 0, nan, 0}).find("not finite"), std::string::npos);
  EXPECT_NE(sampled({0, 2, 1, 3}, {0, 0, 0, 0}).find("increase"), std::string::npos);
  EXPECT_NE(sampled({0, 1, 1, 3}, {0, 0, 0, 0}).find("increase"), std::string::npos);
  RandomProfile::Parameters p = rough();
  p.hurst = 1.2;
  EXPECT_NE(refusal([&] { RandomProfile{p}; }).find("hurst"), std::string::npos);
  p = rough();
  p.shortest = 1;
  EXPECT_NE(refusal([&] { RandomProfile{p}; }).find("wavelengths"), std::string::npos);
  p.shortest = 1e-9;
  EXPECT_NE(refusal([&] { RandomProfile{p}; }).find("100,000"), std::string::npos);
}

}  // namespace
}  // namespace ciliaval
