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
  std::vector<Place> rows;            ///< where each row begins
  std::vector<Place> header;          ///< where each column's name stands
  std::vector<std::string> not_read;  ///< names of further columns

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
/// The separator ' ' is any number of blanks.
std::vector<CsvCell> csv_cells(std::string_view line, std::size_t number, char separator = ',');

/// A number with a decimal point or comma; none if the text is another thing.
std::optional<double> csv_number(std::string text);

/// Layout of a file of columns.
struct CsvLayout {
  char separator = ',';                      ///< ',', ';', a tab, or ' ' for blanks
  std::vector<CsvCell> header;               ///< as the file has it; empty: there is none
  std::map<std::string, std::string> units;  ///< by column, that a comment states
  std::size_t header_line = 0;
  std::size_t rows_begin = 0;  ///< number of the first line of numbers; 0: there are no rows
  std::string first_row{};
  bool has_index = false;  ///< the rows have a cell before those of the header: their number
};
/// The header is the line above the first row; where there is none but comments, the last of these
/// that has a name for each cell of the row, as COMSOL writes it. "# units: x m, y m" gives the
/// units of columns without brackets; COMSOL's "% Length unit: mm" that of the coordinates.
CsvLayout csv_layout(std::string_view text);

/// "x [mm]" or "x (mm)" taken apart: the name, and the unit if there is one.
std::pair<std::string, std::optional<std::string>> name_and_unit(std::string_view header);

/// The units by column that a comment states: "# units: S m, x m, theta rad".
std::map<std::string, std::string> csv_units(std::string_view comment);

/// Message on a file without a header.
std::string no_header(const CsvLayout& layout);

/// Takes the first line, without LF or CRLF, off a text.
std::string_view take_line(std::string_view& text);

/// Takes the byte order mark of UTF-8 off a text; one of UTF-16 is a fault, and false is returned.
bool take_byte_order_mark(std::string_view& text, Faults& faults);

/// Treatment of columns that were not asked for.
enum class CsvOthers { fault, not_read };

/// Reads a CSV file (csv_layout()): a header line of column names, each with its unit in brackets
/// ("x [mm]", "x (mm)"), then rows of as many cells; commas, semicolons, tabs or blanks between the
/// cells, points in the numbers, or commas where these do not separate cells; cells in double
/// quotes where they must be (RFC 4180), LF or CRLF, UTF-8 with or without a byte order mark. Empty
/// lines and lines that begin with # or % are skipped. Columns named in `ignored` are, and one
/// without a name. Every fault is added with its place: a repeated or missing column, a wrong unit,
/// a wrong number of cells, no finite number, UTF-16, no rows.
CsvTable read_csv(std::string_view text, std::span<const CsvColumn> columns,
                  std::span<const std::string_view> ignored, Faults& faults,
                  CsvOthers others = CsvOthers::fault);

/// The text of a file. Throws InputError if there is none, or of more than 100 MB.
std::string read_csv_file(const std::filesystem::path& file);

}  // namespace ciliaval::compare::input
