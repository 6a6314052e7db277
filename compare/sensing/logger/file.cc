// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/sensing/logger/file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <boost/locale/encoding_utf.hpp>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <utility>

#include "compare/input/external/background.h"
#include "compare/input/units.h"
#include "compare/sensing/logger/header.h"
#include "compare/sensing/logger/time.h"
#include "problem/error.h"

namespace ciliaval::compare::sensing::logger {
namespace {

using input::CsvCell;
using input::Faults;
using input::in_quotes;
using input::external::ReadingOptions;

/// The text in UTF-8; one that is not is taken for Latin-1, whose bytes are the code points.
std::string in_utf8(std::string_view text) {
  namespace conv = boost::locale::conv;
  try {
    return conv::utf_to_utf<char>(text.data(), text.data() + text.size(), conv::stop);
  } catch (const conv::conversion_error&) {
    std::u32string points(text.size(), U' ');
    std::ranges::transform(text, points.begin(),
                           [](char c) { return static_cast<unsigned char>(c); });
    return conv::utf_to_utf<char>(points);
  }
}

std::string_view name_of(char separator) {
  if (separator == ';') return "semicolons";
  return separator == '\t' ? "tabs" : "commas";
}

class Reader {
 public:
  Reader(std::span<const std::string> sensors, const ReadingOptions& options, Faults& faults)
      : sensors_(sensors), options_(options), faults_(faults) {}

  File read(std::string_view text) {
    if (!input::take_byte_order_mark(text, faults_)) return {};
    auto header = take_header(text, line_, sensors_, options_, faults_);
    if (!header) return {};
    header_ = std::move(*header);
    choose_columns(header_, sensors_, options_, faults_);
    if (!faults_.empty()) return {};
    bool first = true;
    while (!text.empty() && faults_.size() < input::most_csv_faults) {
      const std::string_view line = input::take_line(text);
      ++line_;
      if (line.find_first_not_of(" \t\r") == std::string_view::npos) continue;
      if (is_comment(line)) {
        if (first) header_.units.merge(input::csv_units(line));
        continue;
      }
      const std::vector<CsvCell> cells = input::csv_cells(line, line_, header_.separator);
      if (std::exchange(first, false)) {
        const bool units = is_unit_row(header_, cells);
        begin(units ? cells : std::vector<CsvCell>());
        if (!faults_.empty()) return {};
        if (units) continue;
      }
      if (file_.row_count == input::most_csv_rows) {
        faults_.add({line_, 1}, fmt::format("there are more than {} rows", input::most_csv_rows));
        return {};
      }
      read_row(cells, text.find_first_not_of(" \t\r\n") == std::string_view::npos);
    }
    if (file_.row_count == 0 && faults_.empty())
      faults_.add({line_, 1}, "there are no rows below the header");
    if (faults_.empty()) file_.remark = remark();
    return std::move(file_);
  }

 private:
  /// Reads what the header and the row of units say.
  void begin(const std::vector<CsvCell>& unit_row) {
    find_units(header_, unit_row, options_, faults_);
    file_.is_change = header_.is_change;
    file_.has_sample = header_.sample.has_value();
    file_.has_sensor = header_.sensor.has_value();
    file_.has_azimuth = header_.azimuth.has_value();
    if (file_.has_sensor && header_.is_wide)
      faults_.add(header_.columns[*header_.sensor].place,
                  "the columns are of several sensors already: the column 'sensor' is too much");
    if (header_.azimuth) find_angle_unit();
    if (!header_.time) file_.timeless = "there is no column 'time'";
    last_time_.assign(sensors_.size(), {});
  }

  void find_angle_unit() {
    const Column& column = header_.columns[*header_.azimuth];
    if (!column.unit) {
      faults_.add(column.place,
                  "the column 'azimuth' needs the unit of an angle: write \"azimuth [deg]\"");
      return;
    }
    try {
      angle_ = input::parse_quantity("1 " + *column.unit, quantity::angle);
    } catch (const InputError& fault) {
      faults_.add(column.place, fmt::format("the column 'azimuth': {}", fault.what()));
    }
  }

  void read_row(const std::vector<CsvCell>& cells, bool is_last) {
    const std::size_t width = header_.columns.size();
    const auto has_text = [](const CsvCell& cell) { return !cell.text.empty(); };
    if (cells.size() < width || std::ranges::any_of(std::span(cells).subspan(width), has_text)) {
      add_width_fault(cells, is_last);
      return;
    }
    if (std::ranges::equal(header_.columns, std::span(cells).first(width), {}, &Column::header,
                           &CsvCell::text)) {
      faults_.add({line_, 1},
                  "the header is repeated: the file holds two records, of which each has its own "
                  "unloaded reading; make two files of it");
      return;
    }
    ++file_.row_count;
    Row row;
    row.place = {line_, 1};
    row.number = file_.row_count;
    if (header_.sample) row.sample = cells[*header_.sample].text;
    if (header_.sensor && !read_sensor(cells[*header_.sensor], row)) return;
    if (header_.azimuth) row.azimuth = angle_ * number(cells[*header_.azimuth]);
    if (header_.time && !read_time(cells[*header_.time], row)) return;
    if (!header_.is_wide) {
      read_field(cells, std::nullopt, row);
      file_.rows.push_back(std::move(row));
      return;
    }
    for (std::size_t s = 0; s < sensors_.size(); ++s) {
      Row of_sensor = row;
      of_sensor.sensor = s;
      read_field(cells, s, of_sensor);
      file_.rows.push_back(std::move(of_sensor));
    }
  }

  void add_width_fault(const std::vector<CsvCell>& cells, bool is_last) {
    const std::size_t width = header_.columns.size();
    std::string why;
    const auto holds = [&](char c) {
      return std::ranges::any_of(
          cells, [c](const CsvCell& cell) { return cell.text.find(c) != std::string::npos; });
    };
    if (cells.size() > width)
      why = ": are there commas in the numbers?";
    else
      for (const char other : {';', '\t', ','})
        if (why.empty() && other != header_.separator && holds(other))
          why = fmt::format(": the header is separated by {}, this row by {}?",
                            name_of(header_.separator), name_of(other));
    if (why.empty() && is_last) why = ": the last row is cut off; delete it";
    faults_.add(cells[std::min(cells.size() - 1, width)].place,
                fmt::format("the row has {} cells and the header {}{}", cells.size(), width, why));
  }

  bool read_sensor(const CsvCell& cell, Row& row) {
    const auto sensor = input::external::sensor_index(cell.text, sensors_);
    if (!sensor)
      faults_.add(cell.place,
                  fmt::format("the sensor {} is none of the case's, {}", in_quotes(cell.text),
                              input::external::sensor_list(sensors_)));
    row.sensor = sensor.value_or(0);
    return sensor.has_value();
  }

  void read_field(const std::vector<CsvCell>& cells, std::optional<std::size_t> sensor, Row& row) {
    const std::size_t before = faults_.size();
    for (const FieldColumn& field : header_.fields)
      if (!sensor || field.sensor == *sensor)
        row.B[static_cast<Eigen::Index>(field.axis)] = field.factor * number(cells[field.index]);
    if (faults_.size() == before) input::external::require_field_range(row.B, row.place, faults_);
  }

  /// The number of a cell; 0 and a fault if there is none.
  double number(const CsvCell& cell) {
    const bool comma = cell.text.find(',') != std::string::npos;
    const double value = number_in(cell.text).value_or(std::numeric_limits<double>::quiet_NaN());
    std::string fault;
    if (cell.text.empty())
      fault = "the cell is empty";
    else if ((comma && header_.separator == ',') || !number_in(cell.text))
      fault = fmt::format("{} is not a number{}", in_quotes(cell.text),
                          comma ? ": write a decimal point, and nothing between thousands" : "");
    else if (!std::isfinite(value))
      fault = fmt::format("{} is not a finite number", in_quotes(cell.text));
    else if (comma || cell.text.find('.') != std::string::npos)
      fault = check_decimal(cell, comma);
    if (fault.empty()) return value;
    faults_.add(cell.place, std::move(fault));
    return 0;
  }

  /// What is wrong with a decimal point or comma that is not that of the rows above.
  std::string check_decimal(const CsvCell& cell, bool comma) {
    if (!decimal_) decimal_ = {comma ? ',' : '.', cell.place.line};
    if ((decimal_->first == ',') == comma) return {};
    return fmt::format("{} has a decimal {}, line {} the other: write the same in all numbers",
                       in_quotes(cell.text), comma ? "comma" : "point", decimal_->second);
  }

  /// Reads the time; the first row tells its form. A column that is no time is not read at all.
  bool read_time(const CsvCell& cell, Row& row) {
    const auto time = time_of(cell.text);
    const Column& column = header_.columns[*header_.time];
    if (file_.row_count == 1) {
      if (!time) {
        file_.timeless = fmt::format(
            "{} in the column {} is no time: write ISO 8601, hh:mm:ss or "
            "a number",
            in_quotes(cell.text), in_quotes(column.header));
        header_.time.reset();
        return true;
      }
      begin_time(*time, column);
    }
    if (!time || time->form != form_) {
      faults_.add(cell.place,
                  fmt::format("{} is no time as in the rows above", in_quotes(cell.text)));
      return false;
    }
    const long double value = nanoseconds(*time);
    auto& last = last_time_[row.sensor];
    if (last && last->first == row.sample && value < last->second) {
      faults_.add(cell.place,
                  fmt::format("the time goes back at {}: sort the rows, or make a file of each "
                              "record",
                              in_quotes(cell.text)));
      return false;
    }
    if (!last) last.emplace();
    last->second = value;
    if (last->first != row.sample) last->first = row.sample;
    if (file_.has_time) row.time = static_cast<double>(value - origin_) / 1e9;
    return true;
  }

  long double nanoseconds(const Time& time) const {
    return form_ == Time::Form::number ? std::round(time.value * unit_) : time.value;
  }

  void begin_time(const Time& time, const Column& column) {
    form_ = time.form;
    if (form_ == Time::Form::number) {
      const std::string advice = fmt::format(
          "write \"{} [s]\" into the header, or --map \"time={} [s]\"", column.name, column.name);
      try {
        if (!column.unit) {
          file_.timeless =
              fmt::format("the column {} has no unit: {}", in_quotes(column.header), advice);
          return;
        }
        unit_ = 1e9L * time_unit(*column.unit);
        if (unit_ >= 1) unit_ = std::round(unit_);
      } catch (const InputError& fault) {
        file_.timeless =
            fmt::format("the column {}: {}; {}", in_quotes(column.header), fault.what(), advice);
        return;
      }
    }
    file_.has_time = true;
    constexpr long double of_dates = 1e17L;  // ns since 1970: of no record from its beginning
    if (form_ == Time::Form::number && nanoseconds(time) <= of_dates) return;
    origin_ = nanoseconds(time);
    if (form_ == Time::Form::clock) return;
    const double unit = form_ == Time::Form::number ? static_cast<double>(unit_) : 1e9;
    const double stated = static_cast<double>(origin_) / unit;
    file_.time_resolution =
        (std::nextafter(stated, std::numeric_limits<double>::infinity()) - stated) * unit / 1e9;
  }

  std::string remark() const {
    std::vector<std::string> read;
    std::set<std::size_t> used;
    for (const FieldColumn& field : header_.fields) {
      used.insert(field.index);
      const Column& column = header_.columns[field.index];
      read.push_back(column.unit == field.unit
                         ? in_quotes(column.header)
                         : fmt::format("{} in {}", in_quotes(column.header), field.unit));
    }
    constexpr std::size_t most_named = 6;
    const std::size_t more = read.size() > most_named ? read.size() - most_named : 0;
    read.resize(read.size() - more);
    std::string text = fmt::format("{} rows, {} from {}{}", file_.row_count,
                                   file_.is_change ? "dB" : "B", fmt::join(read, ", "),
                                   more > 0 ? fmt::format(" and {} more columns", more) : "");
    for (const auto& other : {header_.time, header_.sample, header_.sensor, header_.azimuth})
      if (other) used.insert(*other);
    std::vector<std::string> ignored;
    for (std::size_t i = 0; i < header_.columns.size(); ++i)
      if (!used.contains(i) && !header_.columns[i].header.empty())
        ignored.push_back(in_quotes(header_.columns[i].header));
    if (!ignored.empty()) text += fmt::format("; columns not read: {}", fmt::join(ignored, ", "));
    if (header_.skipped > 0)
      text += fmt::format("; {} lines above the header not read", header_.skipped);
    return text;
  }

  std::span<const std::string> sensors_;
  const ReadingOptions& options_;
  Faults& faults_;
  Header header_;
  File file_;
  std::size_t line_ = 0;
  double angle_ = 1;                                     ///< the azimuth's unit, rad
  std::optional<std::pair<char, std::size_t>> decimal_;  ///< the mark, and its first line
  Time::Form form_ = Time::Form::number;
  long double unit_ = 1e9L;  ///< the time's, ns
  long double origin_ = 0;   ///< ns
  /// Of each sensor: the sample and time of its last row.
  std::vector<std::optional<std::pair<std::string, long double>>> last_time_;
};

}  // namespace

File read_file(std::string_view text, std::span<const std::string> sensors,
               const ReadingOptions& options, Faults& faults) {
  const bool is_utf16 = text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF");
  const std::string utf8 = is_utf16 ? std::string(text) : in_utf8(text);
  return Reader(sensors, options, faults).read(utf8);
}

}  // namespace ciliaval::compare::sensing::logger
