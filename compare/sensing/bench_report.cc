// SPDX-License-Identifier: LGPL-2.1-or-later
// The results of a simulated bench, for people and programs.
#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "compare/output/json_file.h"
#include "compare/output/text_table.h"
#include "compare/sensing/bench.h"

namespace ciliaval::compare::sensing {
namespace {

using Json = nlohmann::ordered_json;

Json errors_json(const BenchErrors& errors) {
  return {{"magnitude_rms", errors.magnitude_rms},
          {"speed_rms", errors.speed_rms},
          {"azimuth_rms", errors.azimuth_rms},
          {"azimuth_rms_interval", errors.azimuth_rms_interval},
          {"azimuth_largest", errors.azimuth_largest},
          {"below_ten_degrees", errors.below_ten_degrees},
          {"readings", errors.readings}};
}

/// "0.3 m/s", "2 mN"
std::string magnitude_text(const Bench& bench, std::size_t step) {
  const input::Case& problem = bench.problem;
  if (const auto velocity = input::stated_values(problem, "velocity"); !velocity.empty())
    return fmt::format("{:g} m/s", velocity[step]);
  const Load& load = problem.load_path[step];
  const auto [unit, size] = output::shown_unit(magnitude_unit(load));
  return fmt::format("{:g} {}", 1 / size * magnitude(load), unit);
}

}  // namespace

std::string bench_text(const Bench& bench, const BenchResult& result) {
  const bool flow = !input::stated_values(bench.problem, "velocity").empty();
  std::string text = fmt::format(
      "{}\n{}: {} loads at {} azimuths, {} sensors; read by {}, inverted by {}\n"
      "Stated errors (standard deviations): noise {:.3g} uT, digits of {:.3g} uT, sensor position "
      "{:.3g} mm, stage {:.3g} deg; ambient field {:.3g} uT, measured at each azimuth\n\n",
      bench.title, bench.problem.name, bench.problem.load_path.size(), bench.azimuths, bench.draws,
      bench.truth.name(), bench.models.name(), bench.noise * 1e6, bench.quantum * 1e6,
      bench.sensor_position * 1e3, bench.stage_azimuth / degree, bench.ambient.norm() * 1e6);
  output::TextRows rows{{"error alone", "found by", "load %"}};
  if (flow) rows[0].emplace_back("v m/s");
  rows[0].insert(rows[0].end(), {"dir deg", "largest", "<10 deg%"});
  const auto add = [&](const std::string& label, const std::string& method,
                       const BenchErrors& errors) {
    std::vector<std::string>& row = rows.emplace_back();
    row = {label, method, fmt::format("{:.2f}", 100 * errors.magnitude_rms)};
    if (flow) row.push_back(fmt::format("{:.4f}", errors.speed_rms));
    row.push_back(fmt::format("{:.2f}", errors.azimuth_rms / degree));
    row.push_back(fmt::format("{:.2f}", errors.azimuth_largest / degree));
    row.push_back(fmt::format("{:.1f}", 100 * errors.below_ten_degrees));
  };
  for (const BenchRow& row : result.rows) {
    add(std::string(to_string(row.source)), "full inversion", row.inversion);
    add("", "linear fit of dB (paper)", row.linear_fit);
  }
  for (std::size_t m = 0; m < result.by_magnitude.size(); ++m)
    add(fmt::format("all at {}", magnitude_text(bench, m)), "full inversion",
        result.by_magnitude[m]);
  return text + output::text_table(rows, "<<>") +
         fmt::format(
             "\nRoot mean squares of (found - true)/true load, speed and direction; largest error "
             "of "
             "direction; part of the readings within 10 deg.\ndB is linear in the load but for "
             "{:.2g} % over the range.\n",
             100 * result.linear_misfit);
}

std::string bench_json(const Bench& bench, const BenchResult& result,
                       const output::Provenance& provenance) {
  Json json{{"schema", 1},
            {"title", bench.title},
            {"case", bench.problem.name},
            {"provenance", to_json(provenance)},
            {"unit", magnitude_unit(bench.problem.load_path.front())},
            {"models", bench.models.name()},
            {"truth", bench.truth.name()},
            {"azimuths", bench.azimuths},
            {"draws", bench.draws},
            {"seed", bench.seed},
            {"errors",
             {{"noise", bench.noise},
              {"quantum", bench.quantum},
              {"sensor_position", bench.sensor_position},
              {"stage_azimuth", bench.stage_azimuth},
              {"ambient", {bench.ambient.x(), bench.ambient.y(), bench.ambient.z()}}}},
            {"linear_misfit", result.linear_misfit},
            {"sources", Json::array()},
            {"by_magnitude", Json::array()},
            {"first_draw", Json::array()}};
  for (const BenchRow& row : result.rows)
    json["sources"].push_back({{"source", to_string(row.source)},
                               {"inversion", errors_json(row.inversion)},
                               {"linear_fit", errors_json(row.linear_fit)}});
  for (std::size_t m = 0; m < result.by_magnitude.size(); ++m) {
    Json entry = errors_json(result.by_magnitude[m]);
    entry["magnitude"] = magnitude(bench.problem.load_path[m]);
    json["by_magnitude"].push_back(std::move(entry));
  }
  for (const BenchPoint& p : result.first_draw)
    json["first_draw"].push_back(
        {{"truth", {p.truth.x(), p.truth.y()}}, {"found", {p.found.x(), p.found.y()}}});
  return output::to_text(json);
}

}  // namespace ciliaval::compare::sensing
