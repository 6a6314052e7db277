// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/input/external/background.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>

#include "problem/support/words.h"

namespace ciliaval::compare::input::external {
namespace {

using Kind = CsvColumn::Kind;

constexpr double turn = 2 * std::numbers::pi;

/// The sensor of a name, or of a number from 0; none if there is no such sensor.
std::optional<std::size_t> sensor_index(const std::string& text,
                                        std::span<const std::string> sensors) {
  for (std::size_t s = 0; s < sensors.size(); ++s)
    if (support::equal_but_case(text, sensors[s])) return s;
  return index_in(text, sensors.size());
}

}  // namespace

Vector3 row_vector(const CsvTable& table, std::size_t first, std::size_t row) {
  return {table.numbers[first][row], table.numbers[first + 1][row], table.numbers[first + 2][row]};
}

std::optional<std::size_t> index_in(const std::string& text, std::size_t bound) {
  std::size_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value >= bound)
    return std::nullopt;
  return value;
}

std::optional<std::size_t> sensor_of(const CsvTable& table, std::size_t column, std::size_t row,
                                     std::span<const std::string> sensors, Faults& faults) {
  if (!table.has(column)) return 0;
  const auto sensor = sensor_index(table.words[column][row], sensors);
  if (!sensor)
    faults.add(table.rows[row],
               fmt::format("the sensor {} is none of the case's, {}",
                           in_quotes(table.words[column][row]), sensor_list(sensors)));
  return sensor;
}

std::string sensor_list(std::span<const std::string> sensors) {
  return sensors.front() == "0" ? fmt::format("0 to {}", sensors.size() - 1)
                                : fmt::format("{}", fmt::join(sensors, ", "));
}

std::vector<CsvColumn> with_field_columns(std::vector<CsvColumn> columns) {
  for (const std::string_view name : {"Bx", "By", "Bz", "dBx", "dBy", "dBz"})
    columns.push_back({name, Kind::quantity, quantity::flux_density, false});
  return columns;
}

void require_field_or_change(const CsvTable& table, std::size_t field, std::size_t change,
                             Faults& faults) {
  const auto count = [&](std::size_t first) {
    int n = 0;
    for (std::size_t c = first; c < first + 3; ++c) n += table.has(c) ? 1 : 0;
    return n;
  };
  const int fields = count(field);
  const int changes = count(change);
  if (fields + changes != 3 || (fields != 0 && changes != 0))
    faults.add({},
               "the columns must be either Bx, By, Bz, or dBx, dBy, dBz for the change against "
               "the undeformed cilium");
}

void require_field_range(const CsvTable& table, std::size_t first, Faults& faults) {
  constexpr double largest = 100;  // T: more than any magnet makes
  for (std::size_t i = 0; i < table.rows.size(); ++i)
    if (const double read = row_vector(table, first, i).cwiseAbs().maxCoeff(); read > largest)
      faults.add(table.rows[i],
                 fmt::format("a field of {:.3g} T was read; fields up to {:g} T are taken: is the "
                             "unit in the header right?",
                             read, largest));
}

double apart(double a, double b) {
  return std::abs(std::remainder(a - b, turn));
}

Background::Background(std::string_view text, std::span<const std::string> sensors, Faults& faults)
    : of_sensor_(sensors.size()) {
  const std::array<CsvColumn, 5> columns{{{"azimuth", Kind::quantity, quantity::angle, true},
                                          {"Bx", Kind::quantity, quantity::flux_density, true},
                                          {"By", Kind::quantity, quantity::flux_density, true},
                                          {"Bz", Kind::quantity, quantity::flux_density, true},
                                          {"sensor", Kind::word, quantity::number, false}}};
  const CsvTable table = read_csv(text, columns, {}, faults);
  if (!faults.empty()) return;
  require_field_range(table, 1, faults);
  const bool for_all = !table.has(4);
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const auto sensor = sensor_of(table, 4, i, sensors, faults);
    if (!sensor) continue;
    const double azimuth = table.numbers[0][i] - turn * std::floor(table.numbers[0][i] / turn);
    std::vector<Mean>& known = of_sensor_[*sensor];
    auto mean = std::ranges::find_if(
        known, [&](const Mean& of) { return apart(of.azimuth, azimuth) <= same_azimuth; });
    if (mean == known.end()) mean = known.insert(mean, Mean{azimuth});
    ++mean->rows;
    mean->B += (row_vector(table, 1, i) - mean->B) / static_cast<double>(mean->rows);
  }
  for (std::size_t s = 0; s < sensors.size(); ++s) {
    if (for_all) of_sensor_[s] = of_sensor_.front();
    if (of_sensor_[s].empty() && faults.empty())
      faults.add({}, fmt::format("there is no row of sensor {}", sensors[s]));
    std::ranges::sort(of_sensor_[s], {}, &Mean::azimuth);
  }
}

std::optional<Vector3> Background::at(double azimuth, std::size_t sensor) const {
  const std::vector<Mean>& means = of_sensor_.at(sensor);
  for (const Mean& mean : means)
    if (apart(mean.azimuth, azimuth) <= same_azimuth) return mean.B;
  if (means.size() < 2) return std::nullopt;
  const double phi = azimuth - turn * std::floor(azimuth / turn);
  const auto above = std::ranges::upper_bound(means, phi, {}, &Mean::azimuth);
  const Mean& next = above == means.end() ? means.front() : *above;
  const Mean& last = above == means.begin() ? means.back() : *(above - 1);
  const auto from_last = [&](double a) { return a - last.azimuth + (a < last.azimuth ? turn : 0); };
  const double t = from_last(phi) / from_last(next.azimuth);
  return Vector3((1 - t) * last.B + t * next.B);
}

}  // namespace ciliaval::compare::input::external
