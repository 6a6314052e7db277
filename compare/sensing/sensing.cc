// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/sensing/sensing.h"

#include <fmt/core.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>

#include "compare/output/csv_writer.h"
#include "compare/output/json_file.h"
#include "compare/output/text_table.h"
#include "compare/sensing/distributions.h"

namespace ciliaval::compare::sensing {
namespace {

using Json = nlohmann::ordered_json;

constexpr double unlikely = 1e-3;

/// The velocity of q, and those at the ends of its interval.
std::array<double, 3> velocities(const FlowLaw& flow, const SensedLoad& sensed) {
  return {flow.velocity(sensed.magnitude()),
          flow.velocity(sensed.magnitude() - sensed.magnitude_interval()),
          flow.velocity(sensed.magnitude() + sensed.magnitude_interval())};
}

}  // namespace

std::string_view to_string(SenseStatus status) {
  constexpr std::array<std::string_view, 5> names{"found", "nothing", "beyond range", "misfit",
                                                  "failed"};
  return names.at(static_cast<std::size_t>(status));
}

SenseStatus status_of(const SensedLoad& sensed) {
  if (!sensed.converged) return SenseStatus::failed;
  if (sensed.beyond_range) return SenseStatus::beyond_range;
  if (sensed.misfit_probability < unlikely) return SenseStatus::misfit;
  if (sensed.is_nothing()) return SenseStatus::nothing;
  return SenseStatus::found;
}

double Scatter::deviation() const {
  return freedom == 0 ? 0 : std::sqrt(squares / static_cast<double>(freedom));
}

ReadingError SensorReadings::error(const Sample& sample) const {
  return {1 / static_cast<double>(sample.rows) + offset_variance, sample.background};
}

double SensorReadings::common_variance(const Sample& sample) const {
  if (sample.background.size() == 0) return offset_variance;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(sample.background,
                                                              Eigen::EigenvaluesOnly);
  return offset_variance + std::max(0.0, solver.eigenvalues().maxCoeff());
}

std::optional<std::string> range_remark(const Shapes& shapes, double asked, std::string_view unit) {
  if (shapes.limit.empty()) return std::nullopt;
  const auto [shown, size] = output::shown_unit(unit);
  return fmt::format("Loads are looked for up to {:.4g} {}, not {:.4g} {}: {}",
                     shapes.largest() / size, shown, asked / size, shown, shapes.limit);
}

std::optional<std::string> scatter_remark(const Scatter& scatter, double noise) {
  if (scatter.freedom == 0) return std::nullopt;
  const double chi_squared = scatter.squares / (noise * noise);
  if (chi_squared_above(chi_squared, static_cast<double>(scatter.freedom)) >= unlikely)
    return std::nullopt;
  return fmt::format(
      "Rows that are averaged differ by {:.3g} uT (standard deviation), more than the noise of "
      "{:.3g} "
      "uT: state --noise as the sensor has it, and see that they are of one load.",
      scatter.deviation() * 1e6, noise * 1e6);
}

double FlowLaw::velocity(double force_per_height) const {
  return std::sqrt(2 * std::max(0.0, force_per_height) / (density * diameter * drag_coefficient));
}

double FlowLaw::force_per_height(double velocity) const {
  return density * velocity * velocity * drag_coefficient * diameter / 2;
}

std::optional<FlowLaw> flow_law(const input::Case& problem) {
  if (input::stated_values(problem, "velocity").empty()) return std::nullopt;
  return FlowLaw{input::stated_values(problem, "density").front(),
                 input::stated_values(problem, "drag_coefficient").front(),
                 problem.cilium.diameter};
}

std::string sensing_text(const Sensing& s) {
  const auto [unit, size] = output::shown_unit(s.unit);
  const double factor = 1 / size;
  std::string text = fmt::format(
      "{}: loads up to {:.4g} {} from readings, by {}; noise {:.3g}, {:.3g}, {:.3g} uT; response "
      "interpolated to {:.1g} of the largest |dB|, {:.4g} uT\n",
      s.case_name, s.largest * factor, unit, s.models.name(), s.noise.x() * 1e6, s.noise.y() * 1e6,
      s.noise.z() * 1e6, s.interpolation_error / s.largest_change, s.largest_change * 1e6);
  for (const std::string& remark : s.remarks) text += remark + '\n';
  if (!s.measured_offset)
    text +=
        "There is no reading of the unloaded cilium: the model's own B is taken off instead, and "
        "the earth's field and the sensor's offset are read as load.\n";
  output::TextRows rows{{"sample", fmt::format("load ({})", unit), "+-", "azimuth", "+- deg"}};
  if (s.flow) rows[0].insert(rows[0].end(), {"v (m/s)", "from", "to"});
  rows[0].emplace_back("status");
  for (const auto& [reading, sensed] : s.samples) {
    const bool has_azimuth = sensed.azimuth_interval() < std::numbers::pi;
    std::vector<std::string>& row = rows.emplace_back();
    row = {reading.name, fmt::format("{:.5g}", sensed.magnitude() * factor),
           output::number_cell(sensed.magnitude_interval(), size, "{:.2g}"),
           has_azimuth ? fmt::format("{:.2f}", sensed.azimuth() / degree) : "-",
           has_azimuth ? fmt::format("{:.2f}", sensed.azimuth_interval() / degree) : ""};
    if (s.flow)
      for (const double v : velocities(*s.flow, sensed)) row.push_back(fmt::format("{:.4f}", v));
    row.emplace_back(to_string(status_of(sensed)));
  }
  return text + output::text_table(rows, s.flow ? "<>>>>>>><" : "<>>>><") +
         "Intervals of 95 %, of the noise of reading, offset and background alone.\n";
}

std::string sensing_json(const Sensing& s, const output::Provenance& provenance) {
  Json json{{"schema", 1},
            {"case", s.case_name},
            {"provenance", to_json(provenance)},
            {"models", s.models.name()},
            {"noise", {s.noise.x(), s.noise.y(), s.noise.z()}},
            {"unit", s.unit},
            {"largest", s.largest},
            {"interpolation_error", s.interpolation_error},
            {"offset", s.measured_offset ? "measured" : "of the model"},
            {"remarks", s.remarks},
            {"samples", Json::array()}};
  for (const auto& [reading, sensed] : s.samples) {
    const Eigen::Matrix2d& c = sensed.covariance;
    Json sample{{"sample", reading.name}, {"rows", reading.rows}};
    if (reading.time) sample["time"] = *reading.time;
    sample.update({{"status", to_string(status_of(sensed))},
                   {"load", {sensed.load.x(), sensed.load.y()}},
                   {"magnitude", sensed.magnitude()},
                   {"magnitude_interval", sensed.magnitude_interval()},
                   {"azimuth", sensed.azimuth()},
                   {"azimuth_interval", sensed.azimuth_interval()},
                   {"covariance", {{c(0, 0), c(0, 1)}, {c(1, 0), c(1, 1)}}},
                   {"chi_squared", sensed.chi_squared},
                   {"misfit_probability", sensed.misfit_probability},
                   {"nothing_probability", sensed.nothing_probability}});
    if (s.flow) {
      const auto [velocity, low, high] = velocities(*s.flow, sensed);
      sample["velocity"] = velocity;
      sample["velocity_interval"] = {low, high};
    }
    json["samples"].push_back(std::move(sample));
  }
  return output::to_text(json);
}

std::string sensing_csv(const Sensing& s) {
  output::CsvWriter csv;
  csv.add("sample");
  csv.add("status");
  for (const char* name : {"load_x", "load_y", "magnitude", "magnitude_interval"})
    csv.add(fmt::format("{} [{}]", name, s.unit));
  for (const char* name :
       {"azimuth [rad]", "azimuth_interval [rad]", "chi_squared", "misfit_probability"})
    csv.add(name);
  if (s.flow)
    for (const char* name : {"velocity [m/s]", "velocity_low [m/s]", "velocity_high [m/s]"})
      csv.add(name);
  const bool has_time = !s.samples.empty() && s.samples.front().first.time;
  if (has_time) csv.add("time [s]");
  csv.end_row();
  for (const auto& [reading, sensed] : s.samples) {
    csv.add(reading.name);
    csv.add(to_string(status_of(sensed)));
    for (const double value :
         {sensed.load.x(), sensed.load.y(), sensed.magnitude(), sensed.magnitude_interval(),
          sensed.azimuth(), sensed.azimuth_interval(), sensed.chi_squared,
          sensed.misfit_probability})
      csv.add(value);
    if (s.flow)
      for (const double v : velocities(*s.flow, sensed)) csv.add(v);
    if (has_time) csv.add(reading.time.value_or(std::numeric_limits<double>::quiet_NaN()));
    csv.end_row();
  }
  return csv.text();
}

}  // namespace ciliaval::compare::sensing
