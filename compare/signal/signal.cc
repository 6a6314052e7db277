// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/signal/signal.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>

#include "compare/signal/butterworth.h"
#include "problem/error.h"

namespace ciliaval::compare::signal {
namespace {

constexpr double most_samples = 1e7;

void require_valid(std::span<const double> times, std::span<const Vector3> B,
                   const SignalOptions& options) {
  if (times.size() != B.size() || times.size() < 2)
    throw InputError(
        fmt::format("a record needs two times or more, each with its field: there are {} times and "
                    "{} fields",
                    times.size(), B.size()));
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (!std::isfinite(times[i]) || !B[i].allFinite())
      throw InputError(fmt::format("the field to be recorded: time or field {} of {} is not finite",
                                   i + 1, times.size()));
    if (i > 0 && !(times[i] > times[i - 1]))
      throw InputError(
          fmt::format("the field to be recorded: its times must increase, but after {:g} s comes "
                      "{:g} s (number {})",
                      times[i - 1], times[i], i + 1));
  }
  if (!(options.sampling_rate > 0 && std::isfinite(options.sampling_rate)))
    throw InputError(fmt::format("the sampling rate must be finite and positive, not {:g} Hz",
                                 options.sampling_rate));
  if (!(options.noise >= 0 && std::isfinite(options.noise)))
    throw InputError(
        fmt::format("the noise's standard deviation must be finite and not negative, not {:g} T",
                    options.noise));
}

/// t_k, up to the last time, which a rounding error must not cost its sample.
std::vector<double> sample_times(double first, double last, double sampling_rate) {
  const double intervals = (last - first) * sampling_rate * (1 + 1e-12);
  if (!(intervals >= 1))
    throw InputError(
        fmt::format("the record of {:g} s is shorter than one interval of the sampling rate of "
                    "{:g} Hz: a higher rate, or a slower sweep",
                    last - first, sampling_rate));
  if (!(intervals < most_samples))
    throw InputError(
        fmt::format("the record of {:g} s at {:g} Hz has more than {:g} samples: a lower sampling "
                    "rate, or a faster sweep",
                    last - first, sampling_rate, most_samples));
  std::vector<double> result(1 + static_cast<std::size_t>(intervals));
  for (std::size_t k = 0; k < result.size(); ++k)
    result[k] = std::min(first + static_cast<double>(k) / sampling_rate, last);
  return result;
}

/// By straight lines; both lists of times increase.
std::vector<Vector3> interpolate(std::span<const double> times, std::span<const Vector3> B,
                                 std::span<const double> at) {
  std::vector<Vector3> result;
  result.reserve(at.size());
  std::size_t i = 1;
  for (const double t : at) {
    while (times[i] < t) ++i;
    const double part = (t - times[i - 1]) / (times[i] - times[i - 1]);
    result.emplace_back((1 - part) * B[i - 1] + part * B[i]);
  }
  return result;
}

/// By Box and Muller (Ann. Math. Stat. 29, 610, 1958). Of the standard library's distributions the
/// numbers differ from machine to machine; these differ by rounding.
void add_noise(std::vector<Vector3>& B, const SignalOptions& options, std::uint32_t sensor) {
  for (const std::uint32_t component : {0U, 1U, 2U}) {
    std::seed_seq seed{options.seed, sensor, component};
    std::mt19937 generator(seed);
    const auto unit = [&] { return (static_cast<double>(generator()) + 0.5) / 4294967296.0; };
    for (Vector3& value : B) {
      const double radius = std::sqrt(-2 * std::log(unit()));
      value[component] += options.noise * radius * std::cos(2 * std::numbers::pi * unit());
    }
  }
}

std::vector<Vector3> filtered(const std::vector<Vector3>& B, const SignalOptions& options) {
  const std::vector<SecondOrderSection> sections =
      butterworth_highpass(options.order, options.cutoff, options.sampling_rate);
  std::vector<Vector3> result(B.size());
  std::vector<double> series(B.size());
  for (const int component : {0, 1, 2}) {
    std::ranges::transform(B, series.begin(), [&](const Vector3& b) { return b[component]; });
    series = options.phase == SignalOptions::Phase::zero ? filter_both_ways(sections, series)
                                                         : filter(sections, series, series.front());
    for (std::size_t k = 0; k < series.size(); ++k) result[k][component] = series[k];
  }
  return result;
}

}  // namespace

Signal record(std::span<const double> times, std::span<const Vector3> B,
              const SignalOptions& options, std::uint32_t sensor) {
  require_valid(times, B, options);
  Signal result;
  result.time = sample_times(times.front(), times.back(), options.sampling_rate);
  result.raw = interpolate(times, B, result.time);
  if (options.noise > 0) add_noise(result.raw, options, sensor);
  result.filtered = options.cutoff == 0 ? result.raw : filtered(result.raw, options);
  return result;
}

}  // namespace ciliaval::compare::signal
