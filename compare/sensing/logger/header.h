// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compare/input/external/reading_options.h"
#include "compare/sensing/logger/column.h"

namespace ciliaval::compare::sensing::logger {

/// A column of B or ΔB that is read.
struct FieldColumn {
  std::size_t index = 0;   ///< of the cell in a row
  std::size_t sensor = 0;  ///< of the case, from 0
  std::size_t axis = 0;    ///< 0, 1, 2 for x, y, z
  double factor = 1;       ///< to T
  std::string unit;        ///< as the file or the options state it
};

/// The header of a logger's file.
struct Header {
  char separator = ',';
  input::Place place;
  std::vector<Column> columns;
  std::size_t skipped = 0;                   ///< lines above it that are no comments
  std::map<std::string, std::string> units;  ///< of comments above it

  std::vector<FieldColumn> fields;
  bool is_change = false;                                    ///< the fields are ΔB
  bool is_wide = false;                                      ///< several sensors side by side
  std::optional<std::size_t> time, sample, sensor, azimuth;  ///< cells
};

/// Takes the lines down to the header off the text; `number` counts them. The header is the first
/// line in which two of Bx, By, Bz or of the columns that `options.map` names are found with one of
/// the separators; or the last comment before the first numbers in which they are. None is a fault.
std::optional<Header> take_header(std::string_view& text, std::size_t& number,
                                  std::span<const std::string> sensors,
                                  const input::external::ReadingOptions& options,
                                  input::Faults& faults);

/// Chooses the columns to be read. Faults: not all of Bx, By, Bz, or both B and ΔB; two columns of
/// one name; sensors that the case does not have; a name of `options.map` that is not there.
void choose_columns(Header& header, std::span<const std::string> sensors,
                    const input::external::ReadingOptions& options, input::Faults& faults);

/// Whether the cells below the header are units of the chosen columns.
bool is_unit_row(const Header& header, const std::vector<input::CsvCell>& cells);

/// Finds the factors of the chosen columns by their units: of the header, of the row of units (may
/// be empty), of comments, or of `options.unit`. Two that differ, and none, are faults.
void find_units(Header& header, const std::vector<input::CsvCell>& unit_row,
                const input::external::ReadingOptions& options, input::Faults& faults);

/// Whether the line begins with the sign of a comment: #, % or //.
bool is_comment(std::string_view line);

/// The number of a cell; none if it is none. A comma is read as the decimal point.
std::optional<double> number_in(std::string_view cell);
/// The same with the 64 bits of a long double, for times.
std::optional<long double> precise_number_in(std::string_view cell);

}  // namespace ciliaval::compare::sensing::logger
