// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compare/input/csv.h"
#include "compare/input/external/reading_options.h"
#include "problem/types.h"

namespace ciliaval::compare::sensing::logger {

/// What one sensor read in a row of the file.
struct Row {
  input::Place place;
  std::size_t number = 0;  ///< of the row below the header, from 1
  std::size_t sensor = 0;
  std::string sample;  ///< of the column `sample`, else empty
  double azimuth = 0;  ///< rad
  /// s, to whole ns; from the first row on if the file has dates or seconds since 1970; NaN if it
  /// has no time.
  double time = std::numeric_limits<double>::quiet_NaN();
  Vector3 B = Vector3::Zero();  ///< or ΔB, T
};

/// The readings that a logger wrote.
struct File {
  bool is_change = false;  ///< the rows hold ΔB
  bool has_sample = false;
  bool has_sensor = false;  ///< a row for each sensor
  bool has_azimuth = false;
  bool has_time = false;  ///< of a known unit
  /// How well a double holds the times as the file states them, s: 0.24 us of seconds since 1970.
  /// Programs that write them have held them so.
  double time_resolution = 0;
  std::string timeless;  ///< why there is no time; empty: there is one
  std::vector<Row> rows;
  std::size_t row_count = 0;  ///< lines of readings
  std::string remark;         ///< what was read and what was not, for people
};

/// Reads a file as loggers, spreadsheets and serial monitors write it (docs/guide/sensing.md):
///
/// - UTF-8 with or without a byte order mark, or Latin-1; LF or CRLF;
/// - columns separated by commas, semicolons or tabs, numbers with a decimal point, or with a
///   decimal comma where the separator is another one; cells in double quotes (RFC 4180);
/// - any lines without numbers, then a header with the names of the columns (column_of()), or
///   a header that is a comment, as NumPy writes it; then possibly a row of units, then rows;
/// - lines that begin with #, % or // are comments; "# units: Bx uT, By uT" states units;
/// - Bx, By, Bz or dBx, dBy, dBz of one sensor, of several in columns side by side (Bx0, By0, …
///   or s0_Bx, …; from 0 or 1, or by name), or in a row for each with a column `sensor`;
/// - units by header, row of units, comment or `options.unit`; LSB with `options.scale`;
/// - a time as a number with a unit, as ISO 8601 or as hh:mm:ss; it does not go back within a
///   sample.
///
/// `options.map` names columns whose header says something else. Other columns are not read, and
/// named in `remark`. `sensors`: the case's, by name. Every fault is added with its place: no
/// header, no unit, two units that differ, two columns of one name, cells that are missing or no
/// finite number, decimal points and commas in one file, a time that goes back, fields beyond
/// 100 T. Throws InputError if an option has a fault.
File read_file(std::string_view text, std::span<const std::string> sensors,
               const input::external::ReadingOptions& options, input::Faults& faults);

}  // namespace ciliaval::compare::sensing::logger
