// SPDX-License-Identifier: LGPL-2.1-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "compare/validation/validation.h"
#include "problem/cilium.h"
#include "problem/description/cilium.h"

namespace ciliaval::compare::validation {
namespace {

/// The section in the plane of the load.
struct BendingPlane {
  double stiffness = 0;  ///< E I of the softest segment, N·m²
  double extent = 0;     ///< m
};
BendingPlane bending_plane(const input::Case& c) {
  const double phi = azimuth(c.load_path.front());
  const double E = std::ranges::min(c.cilium.segments, {}, &Segment::young_modulus).young_modulus;
  return {E * c.cilium.second_moment(phi), c.cilium.extent(phi)};
}

/// Factor that makes F, q or δ dimensionless, and its formula.
struct LoadNumber {
  double factor = 0;
  std::string meaning;
};
std::optional<LoadNumber> load_number(const Load& load, double length, double stiffness) {
  const std::string_view unit = magnitude_unit(load);
  if (unit == "N") return LoadNumber{length * length / stiffness, "F L^2/(E I)"};
  if (unit == "N/m") return LoadNumber{std::pow(length, 3) / stiffness, "q L^3/(E I)"};
  if (unit == "N m") return LoadNumber{length / stiffness, "M L/(E I)"};
  if (unit == "m") return LoadNumber{1 / length, "displacement/L"};
  return std::nullopt;
}

}  // namespace

std::vector<Extent> domain_of(const input::Case& c) {
  std::vector<Extent> domain;
  const auto add = [&](std::string name, std::string meaning, std::string unit,
                       const std::vector<double>& values) {
    const auto [from, to] = std::ranges::minmax(values);
    domain.push_back({std::move(name), std::move(meaning), std::move(unit), from, to});
  };
  const auto along_path = [&](const std::function<double(const Load&)>& number) {
    std::vector<double> values;
    for (const Load& load : c.load_path) values.push_back(number(load));
    return values;
  };
  const double length = c.cilium.length();
  const Load& first = c.load_path.front();
  const BendingPlane plane = bending_plane(c);
  const auto& key = first.type().parameters.front();
  if (!first.is<EnvironmentLoad>()) {
    const auto loads = along_path([](const Load& load) { return magnitude(load); });
    add("load", fmt::format("{}, {}", type(first), key.name), std::string(magnitude_unit(first)),
        loads);
    if (const auto number = load_number(first, length, plane.stiffness))
      add("load_number", number->meaning, "",
          along_path([&](const Load& load) { return number->factor * magnitude(load); }));
  }
  const auto field =
      along_path([](const Load& load) { return acting_environment(load).uniform_field.norm(); });
  if (std::ranges::max(field) > 0) {
    double moment = 0;  // M A L of all segments
    for (const Segment& s : c.cilium.segments)
      moment += magnetization(s).norm() * c.cilium.area() * s.length;
    add("field", "|B|", "T", field);
    add("field_number", "M A L B L/(E I)", "", along_path([&](const Load& load) {
          return moment * acting_environment(load).uniform_field.norm() * length / plane.stiffness;
        }));
  }
  add("slenderness", "L over the section's extent along the azimuth", "", {length / plane.extent});
  std::vector<double> ratios;
  for (const Segment& s : c.cilium.segments) ratios.push_back(s.poisson_ratio);
  add(std::string(description::poisson_ratio_key), "nu", "", ratios);
  return domain;
}

}  // namespace ciliaval::compare::validation
