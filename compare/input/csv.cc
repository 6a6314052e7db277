// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/input/csv.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <map>
#include <optional>
#include <system_error>
#include <utility>

#include "problem/error.h"
#include "problem/support/words.h"

namespace ciliaval::compare::input {
namespace {

constexpr std::uintmax_t largest_file = 100'000'000;  ///< bytes

/// A column's header; no unit: none, or that of the comment.
struct Header {
  std::string name;
  std::optional<std::string> unit;
  Place place;
};
Header header_of(const CsvCell& cell, const std::map<std::string, std::string>& units) {
  auto [name, unit] = name_and_unit(cell.text);
  if (!unit)
    if (const auto found = units.find(name); found != units.end()) unit = found->second;
  return {std::move(name), std::move(unit), cell.place};
}

class Reader {
 public:
  Reader(std::span<const CsvColumn> columns, std::span<const std::string_view> ignored,
         Faults& faults)
      : columns_(columns),
        ignored_(ignored),
        faults_(faults),
        index_(columns.size()),
        factor_(columns.size(), 1) {
    table_.numbers.resize(columns.size());
    table_.words.resize(columns.size());
    table_.header.resize(columns.size());
  }

  CsvTable read(std::string_view text) {
    if (!take_byte_order_mark(text, faults_)) return table_;
    std::map<std::string, std::string> units;
    std::optional<std::pair<std::string_view, std::size_t>> header;  // the line and its number
    bool is_header_read = false;
    std::size_t number = 0;
    const auto read_once = [&] {
      return std::exchange(is_header_read, true) ||
             read_header(header->first, header->second, units);
    };
    while (!text.empty() && faults_.size() < most_csv_faults) {
      const std::string_view line = take_line(text);
      ++number;
      const auto first = line.find_first_not_of(" \t");
      if (first == std::string_view::npos) continue;
      if (line[first] == '#' || line[first] == '%') {
        units.merge(csv_units(line));
      } else if (!header) {
        header = {line, number};  // its units may stand in the comments below it
      } else if (!read_once()) {
        return table_;
      } else if (table_.rows.size() == most_csv_rows) {
        faults_.add({number, 1}, fmt::format("there are more than {} rows", most_csv_rows));
        return table_;
      } else {
        read_row(line, number);
      }
    }
    if (!header)
      faults_.add({},
                  "the file is empty: it needs a header line with the names and units of the "
                  "columns");
    else if (table_.rows.empty() && read_once())
      faults_.add({number, 1}, "there are no rows below the header");
    return table_;
  }

 private:
  bool read_header(std::string_view line, std::size_t number,
                   const std::map<std::string, std::string>& units) {
    const std::size_t before = faults_.size();
    for (const char separator : {';', '\t'})
      if (const auto at = line.find(separator); at != std::string_view::npos) {
        faults_.add({number, at + 1},
                    fmt::format("the columns are separated by {}: write commas between them, and "
                                "points, not commas, in the numbers",
                                separator == ';' ? "semicolons" : "tabs"));
        return false;
      }
    const std::vector<CsvCell> cells = csv_cells(line, number);
    width_ = cells.size();
    if (width_ > most_csv_cells) {
      faults_.add({number, 1}, fmt::format("there are more than {} columns", most_csv_cells));
      return false;
    }
    for (std::size_t i = 0; i < cells.size(); ++i) take(header_of(cells[i], units), i);
    for (std::size_t c = 0; c < columns_.size(); ++c)
      if (columns_[c].required && !index_[c])
        faults_.add({number, 1}, fmt::format("there is no column '{}'", columns_[c].name));
    return faults_.size() == before;
  }

  void take(const Header& header, std::size_t index) {
    if (std::find(ignored_.begin(), ignored_.end(), header.name) != ignored_.end()) return;
    const auto found = std::find_if(columns_.begin(), columns_.end(),
                                    [&](const CsvColumn& c) { return c.name == header.name; });
    if (found == columns_.end()) {
      std::vector<std::string_view> names;
      for (const CsvColumn& column : columns_) names.push_back(column.name);
      faults_.add(header.place, fmt::format("unknown column {} (valid: {})", in_quotes(header.name),
                                            fmt::join(names, ", ")));
      return;
    }
    const auto c = static_cast<std::size_t>(found - columns_.begin());
    if (index_[c]) {
      faults_.add(header.place, fmt::format("there is a second column '{}'", header.name));
      return;
    }
    index_[c] = index;
    table_.header[c] = header.place;
    if (found->any_unit) return;
    if (found->kind == CsvColumn::Kind::word || found->quantity.unit.empty()) {
      if (header.unit && !header.unit->empty() && *header.unit != "1")
        faults_.add(header.place, fmt::format("the column '{}' has no unit", header.name));
      return;
    }
    const std::string_view example = found->quantity.example;
    const std::string unit(example.substr(example.find(' ') + 1));
    if (!header.unit) {
      faults_.add(header.place,
                  fmt::format("the column '{0}' needs the unit of {1} {2}: write \"{0} "
                              "[{3}]\"",
                              header.name, found->quantity.article, found->quantity.name, unit));
      return;
    }
    try {
      factor_[c] = parse_quantity("1 " + *header.unit, found->quantity);
    } catch (const InputError& fault) {
      faults_.add(header.place, fmt::format("the column '{}': {}", header.name, fault.what()));
    }
  }

  void read_row(std::string_view line, std::size_t number) {
    const std::vector<CsvCell> cells = csv_cells(line, number);
    if (cells.size() != width_) {
      const Place where = cells[std::min(cells.size() - 1, width_)].place;
      faults_.add(where,
                  fmt::format("the row has {} cells and the header {}{}", cells.size(), width_,
                              cells.size() > width_ ? ": are there commas in the numbers?" : ""));
      return;
    }
    table_.rows.push_back({number, 1});
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      if (!index_[c]) continue;
      if (columns_[c].kind == CsvColumn::Kind::word)
        table_.words[c].push_back(cells[*index_[c]].text);
      else
        add_number(c, cells[*index_[c]]);
    }
  }

  void add_number(std::size_t column, const CsvCell& cell) {
    std::string_view text = cell.text;
    if (text.starts_with('+')) text.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (text.empty())
      faults_.add(cell.place, fmt::format("the cell of '{}' is empty", columns_[column].name));
    else if (error != std::errc() || end != text.data() + text.size())
      faults_.add(cell.place, fmt::format("{} is not a number", in_quotes(cell.text)));
    else if (!std::isfinite(value))
      faults_.add(cell.place, fmt::format("{} is not a finite number", in_quotes(cell.text)));
    table_.numbers[column].push_back(value * factor_[column]);
  }

  std::span<const CsvColumn> columns_;
  std::span<const std::string_view> ignored_;
  Faults& faults_;
  CsvTable table_;
  std::size_t width_ = 0;
  std::vector<std::optional<std::size_t>> index_;  ///< of each column's cell in a row
  std::vector<double> factor_;                     ///< to SI units
};

}  // namespace

std::vector<CsvCell> csv_cells(std::string_view line, std::size_t number, char separator) {
  std::vector<CsvCell> cells{{{}, {number, 1}}};
  bool quoted = false;
  for (std::size_t i = 0; i < line.size() && cells.size() <= most_csv_cells; ++i) {
    if (line[i] == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"') {
      cells.back().text += line[i++];
    } else if (line[i] == '"') {
      quoted = !quoted;
    } else if (line[i] == separator && !quoted) {
      cells.push_back({{}, {number, i + 2}});
    } else {
      cells.back().text += line[i];
    }
  }
  for (CsvCell& cell : cells) cell.text = std::string(support::trimmed(cell.text));
  return cells;
}

std::pair<std::string, std::optional<std::string>> name_and_unit(std::string_view header) {
  const auto open = header.find_first_of("[(");
  if (open == std::string_view::npos || header.back() != (header[open] == '[' ? ']' : ')'))
    return {std::string(header), std::nullopt};
  return {std::string(support::trimmed(header.substr(0, open))),
          std::string(support::trimmed(header.substr(open + 1, header.size() - open - 2)))};
}

std::map<std::string, std::string> csv_units(std::string_view comment) {
  std::map<std::string, std::string> units;
  const auto begin = comment.find("units:");
  if (begin == std::string_view::npos) return units;
  for (const CsvCell& cell : csv_cells(comment.substr(begin + 6), 1))
    if (const auto blank = cell.text.find(' '); blank != std::string::npos)
      units[cell.text.substr(0, blank)] =
          support::trimmed(std::string_view(cell.text).substr(blank));
  return units;
}

std::string_view take_line(std::string_view& text) {
  const auto end = text.find('\n');
  std::string_view line = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

bool take_byte_order_mark(std::string_view& text, Faults& faults) {
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF")) {
    faults.add({}, "the file is in UTF-16: save it as UTF-8");
    return false;
  }
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  return true;
}

CsvTable read_csv(std::string_view text, std::span<const CsvColumn> columns,
                  std::span<const std::string_view> ignored, Faults& faults) {
  return Reader(columns, ignored, faults).read(text);
}

std::string read_csv_file(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error))
    throw InputError(
        fmt::format("{}:1:1: there is no such file: a name without a leading / is "
                    "looked for beside the case file",
                    file.string()));
  if (std::filesystem::file_size(file, error) > largest_file)
    throw InputError(
        fmt::format("{}:1:1: the file is larger than {} bytes", file.string(), largest_file));
  std::ifstream in(file, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  if (!in.is_open() || in.bad())
    throw InputError(fmt::format("{}:1:1: the file cannot be read", file.string()));
  return text;
}

}  // namespace ciliaval::compare::input
