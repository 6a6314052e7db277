// SPDX-License-Identifier: LGPL-2.1-or-later
#include "problem/cilium.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "problem/error.h"

namespace ciliaval {

double Cilium::area() const {
  return std::numbers::pi * diameter * diameter / 4;
}

double Cilium::second_moment() const {
  return std::numbers::pi * std::pow(diameter, 4) / 64;
}

double Cilium::length() const {
  return interfaces().back();
}

std::vector<double> Cilium::interfaces() const {
  std::vector<double> ends{0.0};
  for (const Segment& segment : segments) ends.push_back(ends.back() + segment.length);
  return ends;
}

std::size_t Cilium::segment_at(double S) const {
  const std::vector<double> ends = interfaces();
  const auto above = std::upper_bound(ends.begin(), ends.end(), S);
  const auto index = std::max<std::ptrdiff_t>(above - ends.begin() - 1, 0);
  return std::min(static_cast<std::size_t>(index), segments.size() - 1);
}

void require_valid(const Cilium& cilium) {
  const auto positive = [](double value) { return std::isfinite(value) && value > 0; };
  if (!positive(cilium.diameter))
    throw InputError("the cilium's diameter must be finite and positive");
  if (cilium.segments.empty()) throw InputError("the cilium needs at least one segment");
  for (const Segment& segment : cilium.segments) {
    if (!positive(segment.length))
      throw InputError("segment '" + segment.name + "': the length must be finite and positive");
    if (!positive(segment.young_modulus))
      throw InputError("segment '" + segment.name +
                       "': Young's modulus must be finite and positive");
    if (!(segment.poisson_ratio > -1 && segment.poisson_ratio < 0.5))
      throw InputError("segment '" + segment.name +
                       "': Poisson's ratio must lie between -1 and 0.5, both excluded");
    if (!std::isfinite(segment.magnetization))
      throw InputError("segment '" + segment.name + "': the magnetization must be finite");
    if (!(std::isfinite(segment.density) && segment.density >= 0))
      throw InputError("segment '" + segment.name +
                       "': the density must be finite and not negative");
  }
}

}  // namespace ciliaval
