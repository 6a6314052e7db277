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

bool is_row(const std::vector<CsvCell>& cells) {
  return std::ranges::all_of(cells,
                             [](const CsvCell& cell) { return csv_number(cell.text).has_value(); });
}

/// Separator of the cells of a line: it occurs outside of quotes.
char separator_of(std::string_view line) {
  for (const char separator : {';', '\t', ','})
    if (csv_cells(line, 1, separator).size() > 1) return separator;
  return csv_cells(line, 1, ' ').size() > 1 ? ' ' : ',';
}

/// The names of columns that blanks separate: two blanks or more, or single ones where a unit in
/// brackets belongs to the name before it.
std::vector<CsvCell> names_between_blanks(std::string_view line, std::size_t number,
                                          std::size_t count) {
  std::vector<CsvCell> wide;
  std::size_t begin = 0;
  for (std::size_t i = 0; i <= line.size(); ++i) {
    if (i < line.size() && line.substr(i, 2) != "  ") continue;
    if (const auto text = support::trimmed(line.substr(begin, i - begin)); !text.empty())
      wide.push_back({std::string(text), {number, begin + 1}});
    begin = i;
  }
  if (wide.size() == count) return wide;
  std::vector<CsvCell> names;
  for (CsvCell& cell : csv_cells(line, number, ' '))
    if (!names.empty() && (cell.text.starts_with('[') || cell.text.starts_with('(')))
      names.back().text += ' ' + cell.text;
    else
      names.push_back(std::move(cell));
  return names;
}

std::vector<CsvCell> names_of(std::string_view line, std::size_t number, char separator,
                              std::size_t count) {
  return separator == ' ' ? names_between_blanks(line, number, count)
                          : csv_cells(line, number, separator);
}

/// The unit of COMSOL's "% Length unit: mm"; empty if the comment is another one.
std::string length_unit(std::string_view comment) {
  constexpr std::string_view key = "Length unit";
  comment = support::trimmed(comment.substr(comment.find_first_not_of("%# \t")));
  if (!comment.starts_with(key)) return {};
  std::string unit(comment.substr(key.size()));
  std::erase_if(unit,
                [](char c) { return std::string_view(" :,;\t\"").find(c) != std::string::npos; });
  return unit;
}

class Reader {
 public:
  Reader(std::span<const CsvColumn> columns, std::span<const std::string_view> ignored,
         CsvOthers others, Faults& faults)
      : columns_(columns),
        ignored_(ignored),
        others_(others),
        faults_(faults),
        index_(columns.size()),
        factor_(columns.size(), 1) {
    table_.numbers.resize(columns.size());
    table_.words.resize(columns.size());
    table_.header.resize(columns.size());
  }

  CsvTable read(std::string_view text) {
    if (!take_byte_order_mark(text, faults_)) return table_;
    layout_ = csv_layout(text);
    if (layout_.header.empty()) {
      faults_.add({std::max<std::size_t>(layout_.rows_begin, 1), 1}, no_header(layout_));
      return table_;
    }
    if (!read_header()) return table_;
    std::size_t number = 0;
    while (!text.empty() && faults_.size() < most_csv_faults) {
      const std::string_view line = take_line(text);
      ++number;
      const auto first = line.find_first_not_of(" \t");
      if (first == std::string_view::npos || line[first] == '#' || line[first] == '%' ||
          number <= layout_.header_line)
        continue;
      if (table_.rows.size() == most_csv_rows) {
        faults_.add({number, 1}, fmt::format("there are more than {} rows", most_csv_rows));
        return table_;
      }
      read_row(line, number);
    }
    if (table_.rows.empty() && faults_.empty())
      faults_.add({number, 1}, "there are no rows below the header");
    return table_;
  }

 private:
  bool read_header() {
    const std::size_t before = faults_.size();
    const std::vector<CsvCell>& cells = layout_.header;
    const std::size_t number = layout_.header_line;
    width_ = cells.size() + (layout_.has_index ? 1 : 0);
    if (width_ > most_csv_cells) {
      faults_.add({number, 1}, fmt::format("there are more than {} columns", most_csv_cells));
      return false;
    }
    for (std::size_t i = 0; i < cells.size(); ++i)
      if (!cells[i].text.empty() || asks_for_nameless())
        take(header_of(cells[i], layout_.units), i + (layout_.has_index ? 1 : 0));
    for (std::size_t c = 0; c < columns_.size(); ++c)
      if (columns_[c].required && !index_[c])
        faults_.add(
            {number, 1},
            fmt::format("there is no column '{}'{}", columns_[c].name,
                        table_.not_read.empty()
                            ? ""
                            : fmt::format("; there is '{}'", fmt::join(table_.not_read, "', '"))));
    return faults_.size() == before;
  }

  bool asks_for_nameless() const {
    return std::ranges::find(columns_, "", &CsvColumn::name) != columns_.end();
  }

  void take(const Header& header, std::size_t index) {
    if (std::find(ignored_.begin(), ignored_.end(), header.name) != ignored_.end()) return;
    const auto found = std::find_if(columns_.begin(), columns_.end(),
                                    [&](const CsvColumn& c) { return c.name == header.name; });
    if (found == columns_.end() && others_ == CsvOthers::not_read) {
      table_.not_read.push_back(header.name);
      return;
    }
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
    const std::vector<CsvCell> cells = csv_cells(line, number, layout_.separator);
    if (cells.size() != width_) {
      const Place where = cells[std::min(cells.size() - 1, width_)].place;
      faults_.add(where,
                  fmt::format("the row has {} cells and the header {}{}", cells.size(), width_,
                              cells.size() > width_ ? ": are there commas in the numbers?" : ""));
      return;
    }
    if (layout_.has_index) {
      if (table_.rows.empty()) first_index_ = cells[0].text == "1" ? 1 : 0;
      if (cells[0].text != std::to_string(first_index_ + table_.rows.size())) {
        faults_.add(cells[0].place, "the rows have a cell more than the header has names");
        return;
      }
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
    const std::optional<double> value = csv_number(cell.text);
    const bool has_comma = value && cell.text.find(',') != std::string::npos;
    const bool has_point = value && cell.text.find('.') != std::string::npos;
    commas_ = commas_ || has_comma;
    points_ = points_ || has_point;
    if ((has_comma || has_point) && commas_ && points_)
      faults_.add(cell.place,
                  "there are decimal points and decimal commas: write one of them, and nothing "
                  "between thousands");
    else if (cell.text.empty())
      faults_.add(cell.place, fmt::format("the cell of '{}' is empty", columns_[column].name));
    else if (!value)
      faults_.add(cell.place, fmt::format("{} is not a number", in_quotes(cell.text)));
    else if (!std::isfinite(*value))
      faults_.add(cell.place, fmt::format("{} is not a finite number", in_quotes(cell.text)));
    table_.numbers[column].push_back(value.value_or(0) * factor_[column]);
  }

  std::span<const CsvColumn> columns_;
  std::span<const std::string_view> ignored_;
  CsvOthers others_;
  Faults& faults_;
  CsvLayout layout_;
  CsvTable table_;
  std::size_t width_ = 0;
  std::size_t first_index_ = 0;
  bool commas_ = false;  ///< in the numbers
  bool points_ = false;
  std::vector<std::optional<std::size_t>> index_;  ///< of each column's cell in a row
  std::vector<double> factor_;                     ///< to SI units
};

}  // namespace

std::optional<double> csv_number(std::string text) {
  if (text.starts_with('+')) text.erase(0, 1);
  if (std::ranges::count(text, ',') == 1 && text.find('.') == std::string::npos)
    std::ranges::replace(text, ',', '.');
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::vector<CsvCell> csv_cells(std::string_view line, std::size_t number, char separator) {
  std::vector<CsvCell> cells{{{}, {number, 1}}};
  bool quoted = false;
  for (std::size_t i = 0; i < line.size() && cells.size() <= most_csv_cells; ++i) {
    const bool is_blank = line[i] == ' ' || line[i] == '\t';
    if (line[i] == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"') {
      cells.back().text += line[i++];
    } else if (line[i] == '"') {
      quoted = !quoted;
    } else if (!quoted && (separator == ' ' ? is_blank : line[i] == separator)) {
      if (separator != ' ' || !cells.back().text.empty())
        cells.push_back({{}, {number, i + 2}});
      else
        cells.back().place.column = i + 2;
    } else {
      cells.back().text += line[i];
    }
  }
  if (separator == ' ' && cells.size() > 1 && cells.back().text.empty()) cells.pop_back();
  for (CsvCell& cell : cells) cell.text = std::string(support::trimmed(cell.text));
  return cells;
}

std::string no_header(const CsvLayout& layout) {
  if (layout.rows_begin == 0)
    return "the file is empty: it needs a header line with the names and units of the columns";
  return fmt::format(
      "there is no header above the numbers {}: put a line with the names and units of the columns "
      "first, such as \"B [mT],tip [mm]\"",
      in_quotes(layout.first_row));
}

CsvLayout csv_layout(std::string_view text) {
  CsvLayout layout;
  std::vector<std::pair<std::string_view, std::size_t>> comments;
  std::string_view header;  // the line above the first row that is no comment
  std::string unit_of_lengths;
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::string_view line = take_line(text);
    const auto first = line.find_first_not_of(" \t");
    if (first == std::string_view::npos) continue;
    if (line[first] == '#' || line[first] == '%') {
      const std::map<std::string, std::string> stated = csv_units(line);
      const std::string of_lengths = length_unit(line);
      layout.units.insert(stated.begin(), stated.end());
      if (!of_lengths.empty()) unit_of_lengths = of_lengths;
      if (header.empty() && stated.empty() && of_lengths.empty())
        comments.emplace_back(line.substr(first + 1), number);
      continue;
    }
    const char separator = separator_of(line);
    if (header.empty() && !is_row(csv_cells(line, number, separator))) {
      header = line;
      layout.header_line = number;
      continue;
    }
    layout.rows_begin = number;
    layout.first_row = line;
    layout.separator = separator;
    break;
  }
  for (const char* coordinate : {"x", "y", "z"})
    if (!unit_of_lengths.empty()) layout.units.emplace(coordinate, unit_of_lengths);
  const std::vector<CsvCell> row = csv_cells(layout.first_row, layout.rows_begin, layout.separator);
  if (!header.empty()) {
    // Cells of text may hold what separates no others: the header's mark counts, if it has one.
    const char own = separator_of(header);
    if (layout.rows_begin == 0 || own != ' ') layout.separator = own == ' ' ? ',' : own;
    layout.header = names_of(header, layout.header_line, layout.separator, row.size());
  } else if (layout.rows_begin > 0) {
    for (const auto& [comment, number] : comments) {
      std::vector<CsvCell> names = names_of(comment, number, layout.separator, row.size());
      const bool is_header =
          names.size() == row.size() && std::ranges::none_of(names, [](const CsvCell& name) {
            return name.text.empty() || csv_number(name.text);
          });
      if (is_header) {
        layout.header = std::move(names);
        layout.header_line = number;
      }
    }
  }
  // Between commas a cell too many is rather a decimal comma.
  layout.has_index = layout.rows_begin > 0 && !layout.header.empty() && layout.separator != ',' &&
                     row.size() == layout.header.size() + 1 && !row.back().text.empty() &&
                     (row.front().text == "0" || row.front().text == "1");
  return layout;
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
                  std::span<const std::string_view> ignored, Faults& faults, CsvOthers others) {
  return Reader(columns, ignored, others, faults).read(text);
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
