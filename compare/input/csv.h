// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compare/input/case_toml.h"
#include "compare/input/units.h"

namespace ciliaval::compare::input {

/// A column that a CSV file may have.
struct CsvColumn {
  enum class Kind {
    quantity,  ///< numbers; the header gives the unit, "x [mm]"
    word       ///< texts, without a unit
  };
  std::string_view name;
  Kind kind = Kind::quantity;
  Quantity quantity = quantity::number;
  bool required = true;
  bool any_unit = false;  ///< the header's unit is left aside: the numbers are as the file has them
};

/// The columns of a CSV file in the order in which they were asked for; one that the file does not
/// have is empty.
struct CsvTable {
  std::vector<std::vector<double>> numbers;  ///< SI units
  std::vector<std::vector<std::string>> words;
  std::vector<Place> rows;    ///< where each row begins
  std::vector<Place> header;  ///< where each column's name stands

  bool has(std::size_t column) const { return !numbers[column].empty() || !words[column].empty(); }
};

/// A cell without the blanks around it, and where it begins.
struct CsvCell {
  std::string text;
  Place place;
};

// They bound the memory of a file that is no table of readings.
inline constexpr std::size_t most_csv_cells = 1000;  ///< of a line
inline constexpr std::size_t most_csv_rows = 1'000'000;
inline constexpr std::size_t most_csv_faults = 100;

/// The cells of a line, of very many the first; quotes as in RFC 4180, but not over several lines.
std::vector<CsvCell> csv_cells(std::string_view line, std::size_t number, char separator = ',');

/// "x [mm]" or "x (mm)" taken apart: the name, and the unit if there is one.
std::pair<std::string, std::optional<std::string>> name_and_unit(std::string_view header);

/// The units by column that a comment states: "# units: S m, x m, theta rad".
std::map<std::string, std::string> csv_units(std::string_view comment);

/// Takes the first line, without LF or CRLF, off a text.
std::string_view take_line(std::string_view& text);

/// Takes the byte order mark of UTF-8 off a text; one of UTF-16 is a fault, and false is returned.
bool take_byte_order_mark(std::string_view& text, Faults& faults);

/// Reads a CSV file: a header line of column names, each with its unit in brackets ("x [mm]", "x
/// (mm)"), then rows of as many cells; commas between the cells, points in the numbers, cells in
/// double quotes where they must be (RFC 4180), LF or CRLF, UTF-8 with or without a byte order
/// mark. Empty lines and lines that begin with # or % are skipped; "# units: x m, y m" above the
/// rows gives the units of columns without brackets, as in the files that `ciliaval run` writes.
/// Columns named in `ignored` are. Every fault is added with its place: an unknown, repeated or
/// missing column, a wrong unit, a wrong number of cells, no finite number, semicolons, tabs,
/// UTF-16, no rows.
CsvTable read_csv(std::string_view text, std::span<const CsvColumn> columns,
                  std::span<const std::string_view> ignored, Faults& faults);

/// The text of a file. Throws InputError if there is none, or of more than 100 MB.
std::string read_csv_file(const std::filesystem::path& file);

}  // namespace ciliaval::compare::input
