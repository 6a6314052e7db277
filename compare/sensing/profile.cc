// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/sensing/profile.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

#include "compare/models/registry.h"
#include "compare/models/run.h"
#include "compare/output/csv_writer.h"
#include "compare/output/json_file.h"
#include "compare/output/text_table.h"
#include "compare/sensing/distributions.h"
#include "problem/error.h"

namespace ciliaval::compare::sensing {
namespace {

constexpr std::size_t curve_points = 241;
constexpr double travel_of_a_step = 0.02;  ///< in lengths of the cilium: enough that it slides on
constexpr double rare = 1e-3;              ///< probability of a misfit by noise alone
constexpr std::size_t fewest_of_a_level = 5;

/// The case's cilium under a flat surface that is pressed on while it slides.
input::Case level_case(input::Case problem, const models::ModelPair& pair, double largest) {
  const surroundings::StatedSurface flat{.friction = problem.surface.value().friction};
  const SweepLoad first = problem.load_path.front().as<SweepLoad>().value();
  problem.mechanics = {pair.mechanics};
  problem.fields = {pair.field};
  problem.external.clear();  // they are of the case's own path
  problem.load_path.clear();
  problem.stated_by.clear();
  for (std::size_t i = 0; i < curve_points; ++i) {
    const double part = static_cast<double>(i) / (curve_points - 1);
    // Finer where the cilium is nearly straight: ΔB grows there with the root of the interference.
    problem.load_path.emplace_back(
        SweepLoad{largest * std::max(part * part, 1e-4),
                  static_cast<double>(i) * travel_of_a_step * problem.cilium.length(), first.speed,
                  first.azimuth});
  }
  input::set_surface(problem, flat);
  return problem;
}

/// The mean of all but an eighth at each end, where a flank begins within the noise.
Level level_of(const std::vector<HeightReading>& readings, std::size_t first, std::size_t last) {
  Level level{first, last, 0, 0};
  const std::size_t margin = (last - first + 1) / 8;
  const auto n = static_cast<double>(last - first + 1 - 2 * margin);
  double own = 0;  // m²
  double common = 0;
  for (std::size_t i = first + margin; i <= last - margin; ++i) {
    const HeightReading& reading = readings[i];
    level.interference += reading.interference / n;
    own = std::max(own, std::pow(reading.interval, 2) - std::pow(reading.common_interval, 2));
    common = std::max(common, std::pow(reading.common_interval, 2));
  }
  level.interval = std::sqrt(own / n + common);
  return level;
}

}  // namespace

LevelCurve::LevelCurve(const input::Case& sweep, const models::ModelPair& pair, double largest,
                       const Progress& progress) {
  const models::CaseResult result =
      models::run(level_case(sweep, pair, largest), models::mechanics_models(),
                  models::field_models(), progress);
  const std::vector<MechanicsStep>& steps = result.mechanics.front().result.steps;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const MechanicsStep& step = steps[i];
    if (step.status != Status::converged) {
      limit_ = fmt::format("{}: no shape under an interference of {:g} m: {}", pair.mechanics,
                           magnitude(step.load), step.message);
      break;
    }
    const std::size_t sensors = sweep.sensors.size();
    const models::FieldStep& field = result.fields.front().steps.at(i).value();
    Eigen::VectorXd change(static_cast<Eigen::Index>(3 * sensors));
    for (std::size_t s = 0; s < sensors; ++s) {
      const auto& dB = field.dB.at(s);
      if (!dB) throw SolverError(pair.name() + ": " + field.failure);
      change.segment<3>(static_cast<Eigen::Index>(3 * s)) = *dB;
    }
    interference_.push_back(magnitude(step.load));
    change_.push_back(std::move(change));
  }
  if (change_.size() < 2) throw SolverError(limit_);
}

LevelCurve::Place LevelCurve::nearest(const Eigen::VectorXd& change) const {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Place best;
  best.distance = best.other = infinity;
  std::size_t best_piece = 0;
  std::vector<std::pair<std::size_t, double>> minima;  // piece, distance
  for (std::size_t i = 0; i + 1 < change_.size(); ++i) {
    const Eigen::VectorXd along = change_[i + 1] - change_[i];
    const double t = along.dot(change - change_[i]) / along.squaredNorm();
    const double inside = std::clamp(t, 0.0, 1.0);
    const double distance = (change - change_[i] - inside * along).norm();
    if (t == inside) minima.emplace_back(i, distance);
    if (distance >= best.distance) continue;
    const double width = interference_[i + 1] - interference_[i];
    best = {interference_[i] + inside * width, distance, along.norm() / width,
            i + 2 == change_.size() && t > 1, infinity};
    best_piece = i;
  }
  for (const auto& [piece, distance] : minima)
    if (piece + 1 < best_piece || piece > best_piece + 1)
      best.other = std::min(best.other, distance);
  return best;
}

std::string_view to_string(HeightReading::Status status) {
  switch (status) {
    case HeightReading::Status::level:
      return "level";
    case HeightReading::Status::off_curve:
      return "off the curve";
    case HeightReading::Status::ambiguous:
      return "ambiguous";
    case HeightReading::Status::beyond:
      break;
  }
  return "beyond range";
}

SensedProfile sense_profile(const LevelCurve& curve, const SensorReadings& readings, double noise) {
  SensedProfile profile;
  profile.noise = noise;
  for (const Sample& sample : readings.samples) {
    const double common = noise * std::sqrt(readings.common_variance(sample));
    const double sigma = std::hypot(common, noise / std::sqrt(static_cast<double>(sample.rows)));
    const LevelCurve::Place place = curve.nearest(sample.change);
    const auto freedom = static_cast<double>(sample.change.size() - 1);
    const double far = sigma * std::sqrt(chi_squared_limit(rare, freedom));
    HeightReading reading{HeightReading::Status::level, place.interference,
                          two_sided_95 * sigma / place.slope, two_sided_95 * common / place.slope};
    if (place.is_end)
      reading.status = HeightReading::Status::beyond;
    else if (place.distance > far)
      reading.status = HeightReading::Status::off_curve;
    else if (place.other <= far)
      reading.status = HeightReading::Status::ambiguous;
    profile.readings.push_back(reading);
  }
  // A level goes on while a reading is not farther from the mean so far than two may be by noise.
  const auto ends = [&](std::size_t first, std::size_t i) {
    if (profile.readings[i].status != HeightReading::Status::level) return true;
    if (i == first) return false;
    const Level level = level_of(profile.readings, first, i - 1);
    return std::abs(profile.readings[i].interference - level.interference) >
           2 * std::max(profile.readings[i].interval, profile.readings[first].interval);
  };
  std::size_t first = 0;
  for (std::size_t i = 0; i <= profile.readings.size(); ++i) {
    if (i < profile.readings.size() && !ends(first, i)) continue;
    if (i - first >= fewest_of_a_level)
      profile.levels.push_back(level_of(profile.readings, first, i - 1));
    const bool is_level =
        i < profile.readings.size() && profile.readings[i].status == HeightReading::Status::level;
    first = is_level ? i : i + 1;
  }
  return profile;
}

std::string profile_text(const SensedProfile& profile) {
  std::string text = fmt::format("{}: levels of the surface by {}, noise {:g} uT\n",
                                 profile.case_name, profile.models.name(), 1e6 * profile.noise);
  output::TextRows rows{{"rows", "", "interference", "+- (mm)", "height (mm)", "step (mm)"}};
  for (std::size_t k = 0; k < profile.levels.size(); ++k) {
    const Level& level = profile.levels[k];
    const auto height = [&](std::size_t i) {
      return profile.levels[i].interference - profile.levels[0].interference;
    };
    rows.push_back({fmt::format("{}", level.first + 1), fmt::format("- {}", level.last + 1),
                    output::number_cell(level.interference, 1e-3, "{:.4f}"),
                    output::number_cell(level.interval, 1e-3, "{:.4f}"),
                    output::number_cell(height(k), 1e-3, "{:.4f}"),
                    k == 0 ? "" : output::number_cell(height(k) - height(k - 1), 1e-3, "{:+.4f}")});
  }
  text += output::text_table(rows, "><>");
  std::size_t known = 0;
  for (const Level& level : profile.levels) known += level.last - level.first + 1;
  std::array<std::size_t, 4> count{};
  for (const HeightReading& reading : profile.readings)
    ++count.at(static_cast<std::size_t>(reading.status));
  text += fmt::format(
      "{} of {} readings belong to levels. Of the others the height is not known: there the field\n"
      "is not that of a level surface (a flank, a tip that sticks or turns back), or it changes.\n"
      "{} readings are off the curve of level surfaces, {} ambiguous, {} beyond its range.\n",
      known, profile.readings.size(), count[1], count[2], count[3]);
  return text;
}

std::string profile_json(const SensedProfile& profile, const output::Provenance& provenance) {
  using Json = nlohmann::ordered_json;
  Json json{{"schema", 1},
            {"case", profile.case_name},
            {"provenance", output::to_json(provenance)},
            {"models", profile.models.name()},
            {"noise", profile.noise},
            {"readings", Json::array()},
            {"levels", Json::array()}};
  for (const HeightReading& reading : profile.readings)
    json["readings"].push_back({{"status", to_string(reading.status)},
                                {"interference", reading.interference},
                                {"interval", reading.interval}});
  for (const Level& level : profile.levels)
    json["levels"].push_back(
        {{"first", level.first},
         {"last", level.last},
         {"interference", level.interference},
         {"interval", level.interval},
         {"height", level.interference - profile.levels.front().interference}});
  return output::to_text(json);
}

std::string profile_csv(const SensedProfile& profile) {
  output::CsvWriter csv;
  csv.row("row", "status", "interference [m]", "interval [m]");
  for (std::size_t i = 0; i < profile.readings.size(); ++i)
    csv.row(i + 1, to_string(profile.readings[i].status), profile.readings[i].interference,
            profile.readings[i].interval);
  return csv.text();
}

}  // namespace ciliaval::compare::sensing
