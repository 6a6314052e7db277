// SPDX-License-Identifier: LGPL-2.1-or-later
// A file of readings, less all offsets.
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "compare/input/csv.h"
#include "compare/input/external/background.h"
#include "compare/sensing/sensing.h"
#include "problem/error.h"

namespace ciliaval::compare::sensing {
namespace {

using Kind = input::CsvColumn::Kind;

constexpr std::string_view unloaded = "unloaded";

/// Columns of the file.
constexpr std::size_t sample_column = 0;
constexpr std::size_t sensor_column = 1;
constexpr std::size_t azimuth_column = 2;
constexpr std::size_t field_column = 3;
constexpr std::size_t change_column = 6;

input::CsvTable readings_table(std::string_view text, std::size_t sensors, input::Faults& faults) {
  const std::vector<input::CsvColumn> columns =
      input::external::with_field_columns({{"sample", Kind::word, quantity::number, false},
                                           {"sensor", Kind::word, quantity::number, false},
                                           {"azimuth", Kind::quantity, quantity::angle, false}});
  constexpr std::array<std::string_view, 1> ignored{"time"};
  input::CsvTable table = input::read_csv(text, columns, ignored, faults);
  if (!faults.empty()) return table;
  input::external::require_field_or_change(table, field_column, change_column, faults);
  if (!faults.empty()) return table;
  input::external::require_field_range(
      table, table.has(change_column) ? change_column : field_column, faults);
  if (sensors > 1 && !(table.has(sample_column) && table.has(sensor_column)))
    faults.add({}, fmt::format("the case has {} sensors: the file needs the columns 'sample' and "
                               "'sensor', and a row for each",
                               sensors));
  return table;
}

/// The rows of a sample, by sensor.
using Rows = std::vector<std::vector<std::size_t>>;

/// The samples in the order of the file.
std::vector<std::pair<std::string, Rows>> samples_of(const input::CsvTable& table,
                                                     std::size_t sensors, input::Faults& faults) {
  std::vector<std::pair<std::string, Rows>> samples;
  std::map<std::string, std::size_t> index;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const std::string name =
        table.has(sample_column) ? table.words[sample_column][i] : std::to_string(i + 1);
    const auto sensor = input::external::sensor_of(table, sensor_column, i, sensors, faults);
    if (!sensor) continue;
    const auto [place, is_new] = index.emplace(name, samples.size());
    if (is_new) samples.emplace_back(name, Rows(sensors));
    std::vector<std::size_t>& rows = samples[place->second].second[*sensor];
    if (!rows.empty() && name != unloaded)
      faults.add(table.rows[i], fmt::format("there is a second row of sample {}, sensor {}",
                                            input::in_quotes(name), *sensor));
    rows.push_back(i);
  }
  for (const auto& [name, rows] : samples)
    for (std::size_t s = 0; s < sensors; ++s)
      if (rows[s].empty())
        faults.add(table.rows.back(), fmt::format("there is no row of sample {}, sensor {}",
                                                  input::in_quotes(name), s));
  return samples;
}

/// The mean of each sensor's rows, each less the background at its azimuth.
Eigen::VectorXd mean_of(const input::CsvTable& table, const Rows& rows,
                        const input::external::Background* background, input::Faults& faults) {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(3 * rows.size()));
  for (std::size_t s = 0; s < rows.size(); ++s)
    for (const std::size_t row : rows[s]) {
      Vector3 B = input::external::row_vector(table, field_column, row);
      if (background != nullptr) {
        if (const auto ambient = background->at(table.numbers[azimuth_column][row], s))
          B -= *ambient;
        else
          faults.add(
              table.rows[row],
              "the background has a single azimuth, which is not this row's: measure it at more");
      }
      result.segment<3>(static_cast<Eigen::Index>(3 * s)) +=
          B / static_cast<double>(rows[s].size());
    }
  return result;
}

SensorReadings readings_of(const input::CsvTable& table,
                           const input::external::Background* background, std::size_t sensors,
                           input::Faults& faults) {
  const auto samples = samples_of(table, sensors, faults);
  SensorReadings result;
  if (!faults.empty()) return result;
  const bool change = table.has(change_column);
  Eigen::VectorXd offset = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(3 * sensors));
  for (const auto& [name, rows] : samples) {
    if (name != unloaded) continue;
    if (change) {
      faults.add(table.rows[rows.front().front()],
                 "the change dB of the unloaded cilium is zero: leave its rows out");
      return result;
    }
    offset = mean_of(table, rows, background, faults);
    std::size_t fewest = table.rows.size();
    for (const auto& of_sensor : rows) fewest = std::min(fewest, of_sensor.size());
    result.noise_factor = std::sqrt(1 + 1 / static_cast<double>(fewest));
    result.measured_offset = true;
  }
  for (const auto& [name, rows] : samples) {
    if (name == unloaded) continue;
    Sample sample{name, {}};
    if (change) {
      sample.change.resize(offset.size());
      for (std::size_t s = 0; s < sensors; ++s)
        sample.change.segment<3>(static_cast<Eigen::Index>(3 * s)) =
            input::external::row_vector(table, change_column, rows[s].front());
    } else {
      sample.change = mean_of(table, rows, background, faults) - offset;
    }
    result.samples.push_back(std::move(sample));
  }
  if (result.samples.empty() && faults.empty())
    faults.add({}, "there is no reading but of the unloaded cilium");
  result.measured_offset = result.measured_offset || change;
  return result;
}

/// Throws InputError with the faults of a file.
void require_none(const input::Faults& faults, const std::filesystem::path& file) {
  if (!faults.empty()) throw InputError(faults.report(file.string()));
}

}  // namespace

SensorReadings read_sensor_readings(const std::filesystem::path& file,
                                    const std::optional<std::filesystem::path>& background,
                                    std::size_t sensors) {
  std::optional<input::external::Background> ambient;
  if (background) {
    input::Faults faults;
    const std::string text = input::read_csv_file(*background);
    ambient.emplace(text, sensors, faults);
    require_none(faults, *background);
  }
  input::Faults faults;
  const std::string text = input::read_csv_file(file);
  const input::CsvTable table = readings_table(text, sensors, faults);
  if (faults.empty() && ambient && !table.has(azimuth_column))
    faults.add({}, "the background depends on the azimuth: the readings need a column 'azimuth'");
  if (faults.empty() && ambient && table.has(change_column))
    faults.add({}, "the change dB has no background any more: leave the background out");
  require_none(faults, file);
  SensorReadings result = readings_of(table, ambient ? &*ambient : nullptr, sensors, faults);
  require_none(faults, file);
  return result;
}

}  // namespace ciliaval::compare::sensing
