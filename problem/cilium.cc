// SPDX-License-Identifier: LGPL-2.1-or-later
#include "problem/cilium.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "problem/error.h"

namespace ciliaval {

using Shape = CrossSection::Shape;
using std::numbers::pi;

namespace {

/// Side of a rectangle that lies along the azimuth: 0 its first one, 1 its second.
int side_along(const CrossSection& section, double azimuth) {
  constexpr double rounding = 1e-9;
  const double angle = azimuth - section.orientation;
  if (std::abs(std::sin(angle)) <= rounding) return 0;
  if (std::abs(std::cos(angle)) <= rounding) return 1;
  throw InputError(
      "a rectangular cilium bends out of the load's plane unless one of its sides lies along the "
      "azimuth: turn the load or the section's orientation to a multiple of 90 deg");
}

}  // namespace

double Cilium::thickness() const {
  switch (section.shape) {
    case Shape::rectangle:
      return std::min(section.width, section.height);
    case Shape::tube:
      return (diameter - section.inner_diameter) / 2;
    default:
      return diameter;
  }
}

double Cilium::radius() const {
  return is_rectangular() ? std::hypot(section.width, section.height) / 2 : diameter / 2;
}

double Cilium::area() const {
  if (is_rectangular()) return section.width * section.height;
  return pi * (diameter * diameter - section.inner_diameter * section.inner_diameter) / 4;
}

std::array<double, 2> Cilium::second_moments() const {
  const auto [a, b] = std::pair(section.width, section.height);
  if (is_rectangular()) return {a * std::pow(b, 3) / 12, std::pow(a, 3) * b / 12};
  const double I = pi * (std::pow(diameter, 4) - std::pow(section.inner_diameter, 4)) / 64;
  return {I, I};
}

double Cilium::second_moment(double azimuth) const {
  const std::array<double, 2> moments = second_moments();
  if (!is_rectangular()) return moments[0];
  return moments.at(side_along(section, azimuth) == 0 ? 1 : 0);
}

double Cilium::extent(double azimuth) const {
  if (!is_rectangular()) return diameter;
  return side_along(section, azimuth) == 0 ? section.width : section.height;
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

Cilium turned(Cilium cilium, double angle) {
  cilium.section.orientation += angle;
  for (Segment& segment : cilium.segments) {
    auto& [x, y] = segment.transverse_magnetization;
    const Eigen::Vector2d M = Eigen::Rotation2Dd(angle) * Eigen::Vector2d(x, y);
    segment.transverse_magnetization = {M.x(), M.y()};
  }
  return cilium;
}

void require_valid(const Cilium& cilium) {
  const auto positive = [](double value) { return std::isfinite(value) && value > 0; };
  const CrossSection& section = cilium.section;
  if (cilium.is_rectangular()) {
    if (!(positive(section.width) && positive(section.height) &&
          std::isfinite(section.orientation)))
      throw InputError("a rectangle's width and height must be finite and positive");
  } else if (!positive(cilium.diameter)) {
    throw InputError("the cilium's diameter must be finite and positive");
  }
  if (section.shape == Shape::tube &&
      !(positive(section.inner_diameter) && section.inner_diameter < cilium.diameter))
    throw InputError("a tube's inner diameter must be positive and less than its outer one");
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
    if (!magnetization(segment).allFinite())
      throw InputError("segment '" + segment.name + "': the magnetization must be finite");
    if (!(std::isfinite(segment.density) && segment.density >= 0))
      throw InputError("segment '" + segment.name +
                       "': the density must be finite and not negative");
  }
}

}  // namespace ciliaval
