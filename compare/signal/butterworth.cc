// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/signal/butterworth.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "problem/error.h"

namespace ciliaval::compare::signal {
namespace {

/// f_c/f_s. Rounding of the coefficients changes |H(f_c)| by 1e-6 there, and grows as (f_s/f_c)².
constexpr double lowest_cutoff = 1e-6;

void require_finite(std::span<const double> series) {
  for (std::size_t k = 0; k < series.size(); ++k)
    if (!std::isfinite(series[k]))
      throw InputError(fmt::format("the filter's input: sample {} is {}, not a finite number",
                                   k + 1, series[k]));
}

}  // namespace

std::vector<SecondOrderSection> butterworth_highpass(unsigned int order, double cutoff,
                                                     double sampling_rate) {
  if (order < 1 || order > highest_order)
    throw InputError(fmt::format("the Butterworth filter's order must be 1 to {}, not {}",
                                 highest_order, order));
  if (!std::isfinite(sampling_rate) ||
      !(cutoff > 0 && cutoff >= lowest_cutoff * sampling_rate && cutoff < sampling_rate / 2))
    throw InputError(fmt::format(
        "the cut-off of the high-pass filter must lie between a millionth and a half of the "
        "sampling rate of {:g} Hz, not at {:g} Hz",
        sampling_rate, cutoff));
  const double c = std::tan(std::numbers::pi * cutoff / sampling_rate);
  std::vector<SecondOrderSection> sections;
  double gain = 1;
  for (unsigned int m = (order + 1) % 2; m < order; m += 2) {
    if (m == 0) {
      gain /= 1 + c;
      sections.push_back({1, -2, 1, -(1 - c) / (1 + c), 0});
    } else {
      const double damping = 2 * c * std::cos(std::numbers::pi * m / (2 * order));
      const double D = 1 + damping + c * c;
      gain /= D;
      sections.push_back({1, -2, 1, -2 * (1 - c) * (1 + c) / D, (1 - damping + c * c) / D});
    }
  }
  if (order % 2 == 1) {
    // An odd order is filled up with a pole and a zero at z = 0. SciPy gives each pair of poles,
    // the last one first, the zeros nearest to it: z = 0 if the poles' real part −a1/2 is below ½.
    const auto nearest =
        std::find_if(sections.rbegin(), sections.rend() - 1,
                     [](const SecondOrderSection& section) { return section.a1 > -1; });
    nearest->b1 = -1;
    nearest->b2 = 0;
  }
  sections.front().b0 *= gain;
  sections.front().b1 *= gain;
  sections.front().b2 *= gain;
  return sections;
}

std::vector<double> filter(std::span<const SecondOrderSection> sections,
                           std::span<const double> series, double before) {
  require_finite(series);
  require_finite({&before, 1});
  // The cascade is linear: the constant goes past it, so that no digits are lost to a large offset.
  std::vector<double> values(series.begin(), series.end());
  for (double& value : values) value -= before;
  double constant = before;
  for (const auto& [b0, b1, b2, a1, a2] : sections) {
    double u = 0;
    double v = 0;
    for (double& value : values) {
      const double x = value;
      value = b0 * x + u;
      u = b1 * x - a1 * value + v;
      v = b2 * x - a2 * value;
    }
    constant *= (b0 + b1 + b2) / (1 + a1 + a2);
  }
  for (double& value : values) value += constant;
  return values;
}

std::vector<double> filter_both_ways(std::span<const SecondOrderSection> sections,
                                     std::span<const double> series) {
  using Section = SecondOrderSection;
  const auto without_b2 = std::ranges::count(sections, 0.0, &Section::b2);
  const auto without_a2 = std::ranges::count(sections, 0.0, &Section::a2);
  const std::size_t padding =
      3 * (2 * sections.size() + 1 - static_cast<std::size_t>(std::min(without_b2, without_a2)));
  if (series.size() <= padding)
    throw InputError(
        fmt::format("a zero-phase filter of {} sections needs more than {} samples; there are {}: "
                    "a longer record, a higher sampling rate or a lower order",
                    sections.size(), padding, series.size()));
  std::vector<double> values;
  values.reserve(series.size() + 2 * padding);
  for (std::size_t k = padding; k > 0; --k) values.push_back(2 * series.front() - series[k]);
  values.insert(values.end(), series.begin(), series.end());
  for (std::size_t k = 1; k <= padding; ++k)
    values.push_back(2 * series.back() - series[series.size() - 1 - k]);
  for (int pass = 0; pass < 2; ++pass) {
    values = filter(sections, values, values.front());
    std::ranges::reverse(values);
  }
  const auto first = values.begin() + static_cast<std::ptrdiff_t>(padding);
  return {first, first + static_cast<std::ptrdiff_t>(series.size())};
}

}  // namespace ciliaval::compare::signal
