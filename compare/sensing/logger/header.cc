// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/sensing/logger/header.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <set>
#include <system_error>
#include <tuple>
#include <utility>

#include "compare/input/external/background.h"
#include "problem/error.h"
#include "problem/support/words.h"

namespace ciliaval::compare::sensing::logger {
namespace {

using input::CsvCell;
using input::Faults;
using input::in_quotes;
using input::external::ReadingOptions;
using Kind = ColumnRole::Kind;

constexpr std::array<char, 3> separators{',', ';', '\t'};
constexpr std::string_view help =
    "Bx, By, Bz; say which columns they are: --map \"bx=NAME, by=NAME, bz=NAME\"";

/// An entry of `options.map`: "bx=Mag X" or "bx=Mag X [mG]".
struct MapEntry {
  ColumnRole role;
  std::string header;
  std::string name;
  std::optional<std::string> unit;
};

std::vector<MapEntry> map_entries(const ReadingOptions::Text& map,
                                  std::span<const std::string> sensors) {
  std::vector<MapEntry> entries;
  if (!map.given()) return entries;
  for (const CsvCell& cell : input::csv_cells(map.text, 1)) {
    const std::string_view text = cell.text;
    const std::size_t sign = std::min(text.find('='), text.size());
    const std::string key(support::trimmed(text.substr(0, sign)));
    Column column = column_of({key, {}}, sensors);
    if (sign == text.size() || column.role.kind == Kind::other)
      throw InputError(fmt::format(
          "{}: {} is no entry NAME=COLUMN with a name of bx, by, bz, dbx, dby, dbz (for several "
          "sensors s0_bx, …), time, sample, sensor, azimuth",
          map.where, in_quotes(text)));
    if (column.role.kind == Kind::field) column.role.family.assign(1, 'b');
    const std::string header(support::trimmed(text.substr(sign + 1)));
    auto [name, unit] = input::name_and_unit(header);
    entries.push_back({column.role, header, std::move(name), std::move(unit)});
  }
  return entries;
}

bool names(const MapEntry& entry, const Column& column) {
  return support::equal_but_case(entry.header, column.header) ||
         support::equal_but_case(entry.name, column.name);
}

Header split(std::string_view line, std::size_t number, char separator,
             std::span<const std::string> sensors) {
  Header header;
  header.separator = separator;
  header.place = {number, 1};
  for (const CsvCell& cell : input::csv_cells(line, number, separator))
    header.columns.push_back(column_of(cell, sensors));
  while (header.columns.size() > 1 && header.columns.back().header.empty())
    header.columns.pop_back();
  return header;
}

/// The number of columns that are B or ΔB, or named by the map.
std::size_t known_columns(const Header& header, const std::vector<MapEntry>& map) {
  return static_cast<std::size_t>(std::ranges::count_if(header.columns, [&](const Column& column) {
    return column.role.is_field() ||
           std::ranges::any_of(map, [&](const MapEntry& entry) { return names(entry, column); });
  }));
}

/// The line as a header, with the separator by which the most columns are known; none if it has
/// fewer than two.
std::optional<Header> header_in(std::string_view line, std::size_t number,
                                std::span<const std::string> sensors,
                                const std::vector<MapEntry>& map) {
  std::optional<Header> best;
  std::size_t most = 1;
  for (const char separator : separators) {
    Header header = split(line, number, separator, sensors);
    if (const std::size_t known = known_columns(header, map); known > most) {
      most = known;
      best = std::move(header);
    }
  }
  return best;
}

/// The number of numbers in a line, with the separator that gives the most.
std::size_t numbers_in(std::string_view line) {
  std::size_t most = 0;
  for (const char separator : separators) {
    const auto cells = input::csv_cells(line, 1, separator);
    most =
        std::max(most, static_cast<std::size_t>(std::ranges::count_if(
                           cells, [](const CsvCell& c) { return number_in(c.text).has_value(); })));
  }
  return most;
}

std::string_view without_comment_sign(std::string_view line) {
  const auto first = line.find_first_not_of("#%/ \t");
  return first == std::string_view::npos ? std::string_view() : line.substr(first);
}

std::string headers_of(const Header& header) {
  std::vector<std::string> texts;
  for (const Column& column : header.columns)
    if (!column.header.empty()) texts.push_back(in_quotes(column.header));
  return fmt::format("{}", fmt::join(texts, ", "));
}

/// A file whose numbers begin in line `number`, below the text `above` of line `above_number`.
void add_no_header(std::string_view line, std::size_t number, std::string_view above,
                   std::size_t above_number, std::span<const std::string> sensors, Faults& faults) {
  if (!above.empty()) {
    Header most = split(above, above_number, ',', sensors);
    for (const char separator : separators)
      if (Header other = split(above, above_number, separator, sensors);
          other.columns.size() > most.columns.size())
        most = std::move(other);
    if (most.columns.size() > 2) {
      faults.add({above_number, 1},
                 fmt::format("no columns {} (columns: {})", help, headers_of(most)));
      return;
    }
  }
  faults.add(
      {number, 1},
      fmt::format("there is no header above the numbers {}: put a line with the names and "
                  "units of the columns first, such as \"time [s],Bx [uT],By [uT],Bz [uT]\", "
                  "and # before lines that are no readings",
                  in_quotes(line)));
}

/// The columns that the map names get its roles; without a map, or with one of other columns, the
/// headers' own roles stay.
void apply_map(Header& header, const std::vector<MapEntry>& map, const ReadingOptions::Text& option,
               Faults& faults) {
  if (map.empty()) return;
  const bool maps_fields =
      std::ranges::any_of(map, [](const MapEntry& e) { return e.role.is_field(); });
  for (Column& column : header.columns) {
    const bool mapped = std::ranges::any_of(
        map, [&](const MapEntry& entry) { return entry.role.kind == column.role.kind; });
    if (mapped || (maps_fields && column.role.is_field())) column.role = {};
  }
  for (const MapEntry& entry : map) {
    auto found = std::ranges::find_if(header.columns, [&](const Column& c) {
      return support::equal_but_case(c.header, entry.header);
    });
    const bool whole = found != header.columns.end();
    if (!whole)
      found =
          std::ranges::find_if(header.columns, [&](const Column& c) { return names(entry, c); });
    if (found == header.columns.end()) {
      std::vector<std::string_view> headers;
      for (const Column& column : header.columns) headers.push_back(column.header);
      faults.add(header.place,
                 fmt::format("there is no column {}, which {} names{} (columns: {})",
                             in_quotes(entry.header), option.where,
                             support::did_you_mean(entry.header, headers), headers_of(header)));
      continue;
    }
    if (found->role.kind != Kind::other)
      faults.add(found->place, fmt::format("{} names the column {} twice", option.where,
                                           in_quotes(found->header)));
    found->role = entry.role;
    if (!whole && entry.unit) {
      if (found->unit && *found->unit != *entry.unit)
        faults.add(found->place,
                   fmt::format("the column {} has the unit {} here and {} in {}",
                               in_quotes(found->header), *found->unit, *entry.unit, option.where));
      found->unit = entry.unit;
    }
  }
}

/// The column of a role, the only one; of times the first that is no `date`.
std::optional<std::size_t> only_column(const Header& header, Kind kind, Faults& faults) {
  std::optional<std::size_t> result;
  for (std::size_t i = 0; i < header.columns.size(); ++i) {
    const Column& column = header.columns[i];
    if (column.role.kind != kind) continue;
    if (!result) {
      result = i;
    } else if (support::equal_but_case(header.columns[*result].name, column.name)) {
      faults.add(column.place, fmt::format("there is a second column '{}'", column.name));
    } else if (kind == Kind::time &&
               support::equal_but_case(header.columns[*result].name, "date")) {
      result = i;
    }
  }
  return result;
}

/// The family of columns that is read: with all of x, y, z before others, `b` before other names
/// before none.
std::string chosen_family(const Header& header) {
  std::map<std::string, std::set<std::size_t>> axes;
  for (const Column& column : header.columns)
    if (column.role.kind == Kind::field) axes[column.role.family].insert(column.role.axis);
  std::string best;
  std::tuple<std::size_t, int> most{0, 0};
  for (const auto& [family, of_family] : axes) {
    const int preference = family == "b" ? 2 : family.empty() ? 0 : 1;
    if (const std::tuple rank{of_family.size(), preference}; rank > most) {
      most = rank;
      best = family;
    }
  }
  return best;
}

/// The sensor of a label: its name, or its number.
std::optional<std::size_t> sensor_of(const std::string& label, std::size_t first,
                                     std::span<const std::string> sensors) {
  if (first == 0) return input::external::sensor_index(label, sensors);
  const auto number = input::external::index_in(label, sensors.size() + first);
  if (!number || *number < first) return std::nullopt;
  return *number - first;
}

/// Adds the columns of B or ΔB by sensor and axis.
void choose_fields(Header& header, std::span<const std::string> sensors, Faults& faults) {
  const std::string family = chosen_family(header);
  const auto is_chosen = [&](const Column& column) {
    return column.role.kind == Kind::change ||
           (column.role.kind == Kind::field && column.role.family == family);
  };
  std::set<std::string> labels;
  std::set<Kind> kinds;
  for (const Column& column : header.columns)
    if (is_chosen(column)) {
      labels.insert(column.role.sensor);
      kinds.insert(column.role.kind);
    }
  constexpr std::string_view either =
      "the columns must be either Bx, By, Bz, or dBx, dBy, dBz for the change against the "
      "undeformed cilium";
  if (kinds.size() != 1) {
    faults.add(header.place, fmt::format("{} (columns: {}); --map \"bx=NAME, by=NAME, bz=NAME\" "
                                         "chooses them",
                                         either, headers_of(header)));
    return;
  }
  header.is_change = kinds.contains(Kind::change);
  header.is_wide = labels.size() > 1 || (sensors.size() > 1 && !labels.begin()->empty());
  // Numbered from 1, as in "Bx1, By1, Bz1, Bx2, …": none is called 0.
  const std::size_t first = labels.size() == sensors.size() && labels.contains("1") &&
                                    labels.contains(std::to_string(sensors.size())) &&
                                    !labels.contains("0")
                                ? 1
                                : 0;
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> taken;
  for (std::size_t i = 0; i < header.columns.size(); ++i) {
    const Column& column = header.columns[i];
    if (!is_chosen(column)) continue;
    const std::string& label = column.role.sensor;
    const auto sensor = label.empty() && labels.size() == 1 ? std::optional<std::size_t>(0)
                                                            : sensor_of(label, first, sensors);
    if (!sensor) {
      faults.add(
          column.place,
          fmt::format("the column {} is of a sensor that the case does not have (it has {}); "
                      "--map \"bx=NAME, …\" chooses columns",
                      in_quotes(column.header), input::external::sensor_list(sensors)));
      return;
    }
    if (!taken.emplace(std::pair(*sensor, column.role.axis), i).second) {
      faults.add(column.place, fmt::format("there is a second column {}", in_quotes(column.name)));
      return;
    }
    header.fields.push_back({i, *sensor, column.role.axis, 1, {}});
  }
  const std::size_t wanted = header.is_wide ? sensors.size() : 1;
  for (std::size_t s = 0; s < wanted; ++s)
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (!taken.contains({s, axis})) {
        faults.add(header.place, fmt::format("{}: there is no column {}B{}{} (columns: {})", either,
                                             header.is_change ? "d" : "", "xyz"[axis],
                                             header.is_wide ? " of the sensor " + sensors[s] : "",
                                             headers_of(header)));
        return;
      }
}

/// The number of a cell with a decimal point or comma.
template <class T>
std::optional<T> number_of_type(std::string_view cell) {
  std::array<char, 64> copy{};
  if (cell.starts_with('+')) cell.remove_prefix(1);
  if (cell.empty() || cell.size() > copy.size() || std::ranges::count(cell, ',') > 1)
    return std::nullopt;
  std::ranges::replace_copy(cell, copy.begin(), ',', '.');
  T value = 0;
  const char* const last = copy.data() + cell.size();
  const auto [end, error] = std::from_chars(copy.data(), last, value);
  if (error != std::errc() || end != last) return std::nullopt;
  return value;
}

/// "[uT]" or "(uT)" without the brackets.
std::string without_brackets(const std::string& text) {
  auto [name, unit] = input::name_and_unit(text);
  return name.empty() && unit ? *unit : text;
}

}  // namespace

bool is_comment(std::string_view line) {
  const auto first = line.find_first_not_of(" \t");
  if (first == std::string_view::npos) return false;
  return line[first] == '#' || line[first] == '%' || line.substr(first).starts_with("//");
}

std::optional<double> number_in(std::string_view cell) {
  return number_of_type<double>(cell);
}

std::optional<long double> precise_number_in(std::string_view cell) {
  return number_of_type<long double>(cell);
}

std::optional<Header> take_header(std::string_view& text, std::size_t& number,
                                  std::span<const std::string> sensors,
                                  const ReadingOptions& options, Faults& faults) {
  const std::vector<MapEntry> map = map_entries(options.map, sensors);
  std::optional<Header> in_comment;
  std::map<std::string, std::string> units;
  std::string_view above;
  std::size_t above_number = 0;
  std::size_t skipped = 0;
  while (!text.empty()) {
    const std::string_view before = text;
    const std::string_view line = input::take_line(text);
    ++number;
    if (line.find_first_not_of(" \t\r") == std::string_view::npos) continue;
    if (is_comment(line)) {
      auto stated = input::csv_units(line);
      if (auto header = header_in(without_comment_sign(line), number, sensors, map);
          header && stated.empty())
        in_comment = std::move(header);
      units.merge(stated);
      continue;
    }
    std::optional<Header> header = header_in(line, number, sensors, map);
    constexpr std::size_t numbers_of_a_reading = 3;
    if (!header && numbers_in(line) >= numbers_of_a_reading) {
      if (!in_comment) {
        add_no_header(line, number, above, above_number, sensors, faults);
        return std::nullopt;
      }
      text = before;
      --number;
      header = std::move(in_comment);
    }
    if (header) {
      header->skipped = skipped;
      header->units = std::move(units);
      return header;
    }
    ++skipped;
    above = line;
    above_number = number;
  }
  if (above.empty())
    faults.add({},
               "the file is empty: it needs a header line with the names and units of the columns");
  else
    faults.add({above_number, 1},
               fmt::format("no header with {}; columns are separated by commas, semicolons or tabs",
                           help));
  return std::nullopt;
}

void choose_columns(Header& header, std::span<const std::string> sensors,
                    const ReadingOptions& options, Faults& faults) {
  if (header.columns.size() > input::most_csv_cells) {
    faults.add(header.place, fmt::format("there are more than {} columns", input::most_csv_cells));
    return;
  }
  const std::size_t before = faults.size();
  apply_map(header, map_entries(options.map, sensors), options.map, faults);
  if (faults.size() != before) return;
  header.time = only_column(header, Kind::time, faults);
  header.sample = only_column(header, Kind::sample, faults);
  header.sensor = only_column(header, Kind::sensor, faults);
  header.azimuth = only_column(header, Kind::azimuth, faults);
  choose_fields(header, sensors, faults);
}

bool is_unit_row(const Header& header, const std::vector<CsvCell>& cells) {
  bool any = false;
  for (const FieldColumn& field : header.fields) {
    if (field.index >= cells.size()) return false;
    const std::string& text = cells[field.index].text;
    if (text.empty()) continue;
    if (number_in(text) || !is_flux_density_unit(without_brackets(text))) return false;
    any = true;
  }
  return any;
}

void find_units(Header& header, const std::vector<CsvCell>& unit_row, const ReadingOptions& options,
                Faults& faults) {
  std::optional<std::array<double, 3>> scale;
  const auto parsed = [](const ReadingOptions::Text& option, const auto& parse) {
    try {
      return parse(option.text);
    } catch (const InputError& fault) {
      throw InputError(fmt::format("{}: {}", option.where, fault.what()));
    }
  };
  if (options.scale.given()) scale = parsed(options.scale, lsb_scale);
  if (options.unit.given()) parsed(options.unit, flux_density_unit);
  for (const auto& other : {header.time, header.azimuth})
    if (other && *other < unit_row.size() && !unit_row[*other].text.empty())
      if (Column& column = header.columns[*other]; !column.unit)
        column.unit = without_brackets(unit_row[*other].text);
  bool any_lsb = false;
  std::vector<std::string> without;
  for (FieldColumn& field : header.fields) {
    Column& column = header.columns[field.index];
    struct Stated {
      std::string unit;
      std::string_view by;
      input::Place place;
    };
    std::vector<Stated> all;
    if (column.unit) all.push_back({*column.unit, "the header", column.place});
    if (field.index < unit_row.size() && !unit_row[field.index].text.empty())
      all.push_back({without_brackets(unit_row[field.index].text), "the row of units",
                     unit_row[field.index].place});
    if (const auto found = header.units.find(column.name); found != header.units.end())
      all.push_back({found->second, "a comment", column.place});
    if (options.unit.given()) all.push_back({options.unit.text, options.unit.where, column.place});
    if (all.empty()) {
      without.push_back(in_quotes(column.header));
      continue;
    }
    try {
      const std::optional<double> factor = flux_density_unit(all.front().unit);
      for (const Stated& other : all)
        if (flux_density_unit(other.unit) != factor) {
          faults.add(other.place, fmt::format("the column {} has two units: {} by {}, {} by {}",
                                              in_quotes(column.header), in_quotes(all.front().unit),
                                              all.front().by, in_quotes(other.unit), other.by));
          break;
        }
      field.unit = all.front().unit;
      any_lsb = any_lsb || !factor;
      if (factor)
        field.factor = *factor;
      else if (scale)
        field.factor = (*scale)[field.axis];
      else
        faults.add(all.front().place,
                   fmt::format("the column {} is in {}: state the flux density of one, from the "
                               "sensor's data sheet: --scale \"0.15 uT\" or --scale \"6842 LSB/G\"",
                               in_quotes(column.header), in_quotes(all.front().unit)));
    } catch (const InputError& fault) {
      faults.add(all.front().place, fmt::format("the column '{}': {}", column.name, fault.what()));
    }
  }
  if (!without.empty())
    faults.add(header.place,
               fmt::format("no unit of {}: write it into the header, \"Bx [uT]\", or state it: "
                           "--unit uT (T, mT, uT, nT, G, mG; LSB with --scale \"0.15 uT\")",
                           fmt::join(without, ", ")));
  if (scale && !any_lsb && faults.empty())
    faults.add(header.place, fmt::format("no column is in LSB: leave {} out", options.scale.where));
}

}  // namespace ciliaval::compare::sensing::logger
