// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/sensing/sensing.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

namespace ciliaval::compare {
namespace {

using Json = nlohmann::ordered_json;

constexpr double degree = std::numbers::pi / 180;
constexpr double unlikely = 1e-3;

/// The velocities at the ends of the interval of q.
std::pair<double, double> velocities(const FlowLaw& flow, const SensedLoad& sensed) {
  return {flow.velocity(sensed.magnitude() - sensed.magnitude_interval()),
          flow.velocity(sensed.magnitude() + sensed.magnitude_interval())};
}

std::string azimuth_text(const SensedLoad& sensed) {
  if (sensed.azimuth_interval() >= std::numbers::pi) return fmt::format("{:>9} {:>7}", "-", "");
  return fmt::format("{:>9.2f} {:>7.2f}", sensed.azimuth() / degree,
                     sensed.azimuth_interval() / degree);
}

/// A millinewton reads better than a newton.
std::pair<double, std::string> display_unit(const std::string& unit) {
  if (unit == "N") return {1e3, "mN"};
  if (unit == "m") return {1e3, "mm"};
  return {1, unit};
}

}  // namespace

std::string_view to_string(SenseStatus status) {
  switch (status) {
    case SenseStatus::found:
      return "found";
    case SenseStatus::nothing:
      return "nothing";
    case SenseStatus::beyond_range:
      return "beyond range";
    case SenseStatus::misfit:
      return "misfit";
    case SenseStatus::failed:
      break;
  }
  return "failed";
}

SenseStatus status_of(const SensedLoad& sensed) {
  if (!sensed.converged) return SenseStatus::failed;
  if (sensed.beyond_range) return SenseStatus::beyond_range;
  if (sensed.misfit_probability < unlikely) return SenseStatus::misfit;
  if (sensed.magnitude_interval() >= sensed.magnitude()) return SenseStatus::nothing;
  return SenseStatus::found;
}

double FlowLaw::velocity(double force_per_height) const {
  return std::sqrt(2 * std::max(0.0, force_per_height) / (density * diameter * drag_coefficient));
}

double FlowLaw::force_per_height(double velocity) const {
  return density * velocity * velocity * drag_coefficient * diameter / 2;
}

std::optional<FlowLaw> flow_law(const Case& problem) {
  if (problem.flow_velocity.empty()) return std::nullopt;
  return FlowLaw{problem.flow_density.front(), problem.flow_drag_coefficient.front(),
                 problem.cilium.diameter};
}

std::string sensing_text(const Sensing& s) {
  const auto [factor, unit] = display_unit(s.unit);
  std::string text = fmt::format(
      "{}: loads up to {:.4g} {} from readings, by {}; noise {:.3g}, {:.3g}, {:.3g} uT; response "
      "interpolated to {:.1g} of the largest |dB|, {:.4g} uT\n",
      s.case_name, s.largest * factor, unit, s.models.name(), s.noise.x() * 1e6, s.noise.y() * 1e6,
      s.noise.z() * 1e6, s.interpolation_error / s.largest_change, s.largest_change * 1e6);
  if (!s.measured_offset)
    text +=
        "There is no reading of the unloaded cilium: the model's own B is taken off instead. Add "
        "rows with the sample `unloaded`.\n";
  text += fmt::format("  {:<16} {:>12} {:>9}  {:>9} {:>7}{}  status\n", "sample",
                      "load (" + unit + ")", "+-", "azimuth", "+- deg",
                      s.flow ? fmt::format("  {:>8} {:>17}", "v (m/s)", "95 %") : "");
  for (const auto& [name, sensed] : s.samples) {
    std::string velocity;
    if (s.flow) {
      const auto [low, high] = velocities(*s.flow, sensed);
      velocity = fmt::format("  {:>8.4f} {:>8.4f} {:>8.4f}", s.flow->velocity(sensed.magnitude()),
                             low, high);
    }
    text += fmt::format("  {:<16} {:>12.5g} {:>9.2g}  {}{}  {}\n", name,
                        sensed.magnitude() * factor, sensed.magnitude_interval() * factor,
                        azimuth_text(sensed), velocity, to_string(status_of(sensed)));
  }
  return text + "Intervals of 95 %, of the noise of reading and offset alone.\n";
}

std::string sensing_json(const Sensing& s, const Provenance& provenance) {
  Json json{{"schema", 1},
            {"case", s.case_name},
            {"provenance", to_json(provenance)},
            {"models", s.models.name()},
            {"noise", {s.noise.x(), s.noise.y(), s.noise.z()}},
            {"unit", s.unit},
            {"largest", s.largest},
            {"interpolation_error", s.interpolation_error},
            {"offset", s.measured_offset ? "measured" : "of the model"},
            {"samples", Json::array()}};
  for (const auto& [name, sensed] : s.samples) {
    const Eigen::Matrix2d& c = sensed.covariance;
    Json sample{{"sample", name},
                {"status", to_string(status_of(sensed))},
                {"load", {sensed.load.x(), sensed.load.y()}},
                {"magnitude", sensed.magnitude()},
                {"magnitude_interval", sensed.magnitude_interval()},
                {"azimuth", sensed.azimuth()},
                {"azimuth_interval", sensed.azimuth_interval()},
                {"covariance", {{c(0, 0), c(0, 1)}, {c(1, 0), c(1, 1)}}},
                {"chi_squared", sensed.chi_squared},
                {"misfit_probability", sensed.misfit_probability}};
    if (s.flow) {
      const auto [low, high] = velocities(*s.flow, sensed);
      sample["velocity"] = s.flow->velocity(sensed.magnitude());
      sample["velocity_interval"] = {low, high};
    }
    json["samples"].push_back(std::move(sample));
  }
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + '\n';
}

std::string sensing_csv(const Sensing& s) {
  std::string text = fmt::format(
      "sample,status,load_x [{0}],load_y [{0}],magnitude [{0}],magnitude_interval [{0}],azimuth "
      "[rad],azimuth_interval [rad],chi_squared,misfit_probability{1}\n",
      s.unit, s.flow ? ",velocity [m/s],velocity_low [m/s],velocity_high [m/s]" : "");
  for (const auto& [name, sensed] : s.samples) {
    text += fmt::format("\"{}\",{},{},{},{},{},{},{},{},{}", name, to_string(status_of(sensed)),
                        sensed.load.x(), sensed.load.y(), sensed.magnitude(),
                        sensed.magnitude_interval(), sensed.azimuth(), sensed.azimuth_interval(),
                        sensed.chi_squared, sensed.misfit_probability);
    if (s.flow) {
      const auto [low, high] = velocities(*s.flow, sensed);
      text += fmt::format(",{},{},{}", s.flow->velocity(sensed.magnitude()), low, high);
    }
    text += '\n';
  }
  return text;
}

}  // namespace ciliaval::compare
