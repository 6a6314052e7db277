// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/sensing/logger/column.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <regex>
#include <utility>
#include <vector>

#include "compare/input/units.h"
#include "problem/error.h"
#include "problem/parameter.h"
#include "problem/support/words.h"

namespace ciliaval::compare::sensing::logger {
namespace {

using Kind = ColumnRole::Kind;

constexpr std::string_view fillers = " \t_-.:/";

std::string in_lower_case(std::string_view text) {
  std::string result(text);
  std::ranges::transform(result, result.begin(), [](unsigned char c) {
    return static_cast<char>(c < 0x80 ? std::tolower(c) : c);
  });
  return result;
}

std::string replaced_all(std::string text, std::string_view part, std::string_view by) {
  for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; at += by.size())
    text.replace(at, part.size(), by);
  return text;
}

/// The letters and digits of a name alone: "Delta B_x" and "ΔBx" give "deltabx".
std::string letters_of(std::string_view name) {
  std::string text = in_lower_case(name);
  for (const std::string_view delta : {"Δ", "∆", "δ"}) text = replaced_all(text, delta, "delta");
  std::erase_if(text, [](char c) { return fillers.find(c) != std::string_view::npos; });
  return text;
}

/// A unit of time that a name implies.
std::optional<std::string> implied_unit(std::string_view letters) {
  if (letters == "millis" || letters == "milliseconds") return "ms";
  if (letters == "micros" || letters == "microseconds") return "us";
  if (letters == "seconds") return "s";
  return std::nullopt;
}

bool is_time(std::string_view letters) {
  constexpr std::string_view names[]{
      "time",      "t",     "timestamp", "elapsed",      "elapsedtime", "datetime", "date",
      "localtime", "utc",   "utctime",   "isotime",      "unixtime",    "millis",   "micros",
      "seconds",   "epoch", "timeofday", "milliseconds", "microseconds"};
  return std::ranges::find(names, letters) != std::end(names);
}

/// The role of B or ΔB that letters such as "s0bx", "magneticfieldx1" or "zaxis" have.
std::optional<ColumnRole> field_role(const std::string& letters) {
  static const std::regex pattern(
      "(?:(?:s|sensor|ch|channel|probe|mag|b)?([0-9]{1,4}))?"
      "(b|bfield|field|magneticfield|magneticfluxdensity|fluxdensity|mag|magfield|magnetometer|m|"
      "db|deltab|)"
      "([xyz])(axis|component|mag)?"
      "(?:(?:s|sensor|ch|channel|probe)?([0-9]{1,4}))?");
  std::smatch match;
  if (!std::regex_match(letters, match, pattern) || (match[1].matched && match[5].matched))
    return std::nullopt;
  ColumnRole role;
  role.family = match[2].str();
  role.kind = role.family == "db" || role.family == "deltab" ? Kind::change : Kind::field;
  if (match[4].str() == "mag" && role.family.empty()) role.family = "mag";
  role.axis = static_cast<std::size_t>(match[3].str().front() - 'x');
  role.sensor = match[1].matched ? match[1].str() : match[5].str();
  return role;
}

/// The rest of "left Bx" or "Bx_left" for the sensor `left`.
std::optional<std::string_view> without_sensor(std::string_view name, std::string_view sensor) {
  const std::size_t n = sensor.size();
  if (sensor.empty() || name.size() < n + 2) return std::nullopt;
  const auto is_filler = [](char c) { return fillers.find(c) != std::string_view::npos; };
  if (support::equal_but_case(name.substr(0, n), sensor) && is_filler(name[n]))
    return name.substr(n + 1);
  if (support::equal_but_case(name.substr(name.size() - n), sensor) &&
      is_filler(name[name.size() - n - 1]))
    return name.substr(0, name.size() - n - 1);
  return std::nullopt;
}

ColumnRole role_of(std::string_view name, std::span<const std::string> sensors) {
  for (const std::string& sensor : sensors)
    if (const auto rest = without_sensor(name, sensor))
      if (auto of_sensor = field_role(letters_of(*rest)); of_sensor && of_sensor->sensor.empty()) {
        of_sensor->sensor = sensor;
        return *of_sensor;
      }
  const std::string letters = letters_of(name);
  if (const auto role = field_role(letters)) return *role;
  ColumnRole role;
  if (is_time(letters)) role.kind = Kind::time;
  if (letters == "sample") role.kind = Kind::sample;
  if (letters == "sensor") role.kind = Kind::sensor;
  if (letters == "azimuth") role.kind = Kind::azimuth;
  return role;
}

bool is_lsb(std::string_view unit) {
  const std::string text = in_lower_case(support::trimmed(unit));
  constexpr std::string_view names[]{"lsb", "lsbs", "count", "counts", "digit", "digits",
                                     "raw", "cnt",  "adc",   "bit",    "bits"};
  return std::ranges::find(names, text) != std::end(names);
}

bool is_time_unit(std::string_view unit) {
  try {
    time_unit(unit);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

bool suits(const ColumnRole& role, std::string_view unit) {
  if (role.is_field()) return is_flux_density_unit(unit);
  return role.kind == Kind::time && is_time_unit(unit);
}

double lsb_scale_of(std::string_view text) {
  const auto slash = text.find('/');
  const std::string_view divisor =
      slash == std::string_view::npos ? "" : support::trimmed(text.substr(slash + 1));
  std::string_view head = support::trimmed(text.substr(0, slash));
  const auto blank = head.find_first_of(" \t");
  if (blank == std::string_view::npos)
    throw InputError(
        fmt::format("{} is no flux density of an LSB: write \"0.15 uT\" or "
                    "\"6842 LSB/G\"",
                    input::in_quotes(text)));
  const std::string number(head.substr(0, blank));
  const std::string_view unit = support::trimmed(head.substr(blank));
  double scale = 0;
  if (is_lsb(unit) && !divisor.empty())
    scale = input::parse_quantity(fmt::format("1 {}", divisor), quantity::flux_density) /
            input::parse_quantity(number + " T", quantity::flux_density);
  else if (divisor.empty() || is_lsb(divisor))
    scale = input::parse_quantity(fmt::format("{} {}", number, unit), quantity::flux_density);
  constexpr double least = 1e-15;  // T: less than any sensor resolves
  if (!(scale >= least && scale <= 1))
    throw InputError(
        fmt::format("{} is no flux density of an LSB between 1 fT and 1 T: write "
                    "\"0.15 uT\" or \"6842 LSB/G\"",
                    input::in_quotes(text)));
  return scale;
}

}  // namespace

std::optional<double> flux_density_unit(std::string_view unit) {
  if (is_lsb(unit)) return std::nullopt;
  return input::parse_quantity(fmt::format("1 {}", unit), quantity::flux_density);
}

bool is_flux_density_unit(std::string_view unit) {
  try {
    flux_density_unit(unit);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

double time_unit(std::string_view unit) {
  return input::parse_quantity(fmt::format("1 {}", unit), quantity::time);
}

std::array<double, 3> lsb_scale(std::string_view text) {
  const std::vector<input::CsvCell> parts = input::csv_cells(text, 1);
  if (parts.size() == 1) {
    const double scale = lsb_scale_of(parts[0].text);
    return {scale, scale, scale};
  }
  if (parts.size() != 3)
    throw InputError(
        fmt::format("{} has {} parts: write one flux density of an LSB, or three for "
                    "x, y, z",
                    input::in_quotes(text), parts.size()));
  return {lsb_scale_of(parts[0].text), lsb_scale_of(parts[1].text), lsb_scale_of(parts[2].text)};
}

Column column_of(const input::CsvCell& cell, std::span<const std::string> sensors) {
  Column column;
  column.header = cell.text;
  column.place = cell.place;
  std::tie(column.name, column.unit) = input::name_and_unit(cell.text);
  column.role = role_of(column.name, sensors);
  if (column.role.kind == Kind::other && !column.unit) {
    // "Bx_uT", "Bx / mT", "time_ms"
    const std::string_view text = cell.text;
    if (const auto at = text.find_last_of(" ,/_"); at != std::string_view::npos && at > 0) {
      std::string_view name = text.substr(0, at);
      name = name.substr(0, name.find_last_not_of(" ,/_") + 1);
      const std::string_view unit = support::trimmed(text.substr(at + 1));
      const ColumnRole role = role_of(name, sensors);
      if (role.kind != Kind::other && suits(role, unit)) {
        column.name = name;
        column.unit = unit;
        column.role = role;
      }
    }
  }
  if (column.role.kind == Kind::time && !column.unit)
    column.unit = implied_unit(letters_of(column.name));
  return column;
}

}  // namespace ciliaval::compare::sensing::logger
