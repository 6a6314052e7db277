// SPDX-License-Identifier: LGPL-2.1-or-later
// Measured values from CSV files.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "compare/input/case.h"
#include "compare/input/csv.h"
#include "compare/input/measurement/load_steps.h"
#include "compare/input/measurement/measurement.h"
#include "compare/input/units.h"
#include "problem/error.h"
#include "problem/support/words.h"

namespace ciliaval::compare::input::measurement {
namespace {

constexpr std::size_t value_column = 0;
constexpr std::size_t uncertainty_column = 1;
constexpr std::size_t step_column = 2;
constexpr std::size_t own_columns = 3;  ///< others follow

/// A column's header, taken apart.
struct FileColumn {
  std::string header;  ///< as the file has it
  std::string name;    ///< as read_csv() has it
  std::optional<std::string> unit;
  Place place;
};

/// The unit behind a name, "field_mT", "B / mT": of a quantity that a case has; none if it is none.
std::optional<std::string> unit_behind(std::string_view name) {
  const auto at = name.find_last_of(" _/,");
  if (at == std::string_view::npos || at == 0) return std::nullopt;
  const std::string unit(support::trimmed(name.substr(at + 1)));
  for (const Quantity& quantity :
       {quantity::length, quantity::force, quantity::force_per_length, quantity::velocity,
        quantity::flux_density, quantity::angle, quantity::pressure, quantity::acceleration,
        quantity::density, quantity::time, quantity::frequency, quantity::magnetization})
    try {
      parse_quantity("1 " + unit, quantity);
      return unit;
    } catch (const InputError&) {  // not of this quantity
    }
  return std::nullopt;
}

/// The columns of the header, with their units. Numbers in its place are a fault.
std::vector<FileColumn> file_columns(std::string_view text, Faults& faults) {
  std::vector<FileColumn> columns;
  const CsvLayout layout = csv_layout(text);
  if (layout.header.empty()) {
    faults.add({std::max<std::size_t>(layout.rows_begin, 1), 1}, no_header(layout));
    return columns;
  }
  if (layout.has_index) {  // which may be the loads
    faults.add({layout.header_line, 1}, "the rows have a cell more than the header has names");
    return columns;
  }
  for (const CsvCell& cell : layout.header) {
    auto [name, unit] = name_and_unit(cell.text);
    columns.push_back({cell.text, std::move(name), std::move(unit), cell.place});
  }
  for (FileColumn& column : columns) {
    if (const auto found = layout.units.find(column.name);
        !column.unit && found != layout.units.end())
      column.unit = found->second;
    else if (!column.unit)
      column.unit = unit_behind(column.name);
  }
  return columns;
}

/// The steps of the rows, and what was read, for people.
struct Rows {
  std::vector<std::size_t> steps;
  std::string by;
};

/// The steps that the column `step` states.
std::vector<std::size_t> stated_steps(const CsvTable& table, std::size_t steps, Faults& faults) {
  std::vector<std::size_t> result;
  std::set<double> seen;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const double step = table.numbers[step_column][i];
    if (step != std::floor(step) || step < 0 || step >= static_cast<double>(steps))
      faults.add(table.rows[i], fmt::format("the step {:g} is none of the case's load steps, 0 to "
                                            "{}",
                                            step, steps - 1));
    else if (!seen.insert(step).second)
      faults.add(table.rows[i], fmt::format("there is a second row of step {:g}", step));
    else
      result.push_back(static_cast<std::size_t>(step));
  }
  return result;
}

/// "x [mT]" with a unit of the load; the name alone if the load is a plain number.
std::string with_unit(std::string_view name, const std::vector<LoadNumber>& numbers) {
  for (const LoadNumber& number : numbers) {
    const std::string_view example = number.quantity.example;
    if (!number.quantity.unit.empty())
      return fmt::format("{} [{}]", name, example.substr(example.find(' ') + 1));
  }
  return std::string(name);
}

/// True if the cells are 0, 1, 2, …: the rows' numbers, as pandas writes them.
bool counts_rows(const std::vector<std::string>& cells) {
  for (std::size_t i = 0; i < cells.size(); ++i)
    if (cells[i] != std::to_string(i)) return false;
  return true;
}

/// The steps in their order, one for each row. Where a column without a unit may hold the loads,
/// that is a fault: it says which one unless the case does.
Rows steps_in_order(const MeasuredFile& file, const std::vector<FileColumn>& others,
                    const CsvTable& table, const std::vector<LoadNumber>& numbers,
                    std::size_t steps, Faults& faults) {
  const std::size_t rows = table.rows.size();
  if (rows != steps)
    faults.add(table.rows.back(),
               fmt::format("the file has {} rows and the case {} load steps: a row for each, or "
                           "a column 'step' that counts them from 0",
                           rows, steps));
  for (std::size_t i = 0; i < others.size() && file.load != in_order; ++i) {
    const std::vector<std::string>& cells = table.words[own_columns + i];
    const bool is_named = !others[i].name.empty();
    const bool has_numbers = std::ranges::any_of(
        cells, [](const std::string& cell) { return csv_number(cell).has_value(); });
    if (others[i].unit || !has_numbers || (!is_named && i == 0 && counts_rows(cells))) continue;
    const std::string header = with_unit(is_named ? others[i].name : "load", numbers);
    faults.add(others[i].place,
               fmt::format("the column {} has numbers without a unit, which may be the loads: name "
                           "it with its unit, such as \"{}\"{}; where the rows are the load steps "
                           "in their order, say load = \"{}\"",
                           is_named ? in_quotes(others[i].name) : "without a name", header,
                           is_named ? fmt::format(", here or by load = \"{}\" in the case", header)
                                    : std::string(),
                           in_order));
  }
  Rows result{{}, "rows in the order of the load steps"};
  for (std::size_t i = 0; i < rows; ++i) result.steps.push_back(i);
  return result;
}

/// The column that the case names by `load`, with the unit that it states.
std::optional<std::size_t> named_column(const MeasuredFile& file, std::vector<FileColumn>& columns,
                                        Faults& faults) {
  const auto [name, unit] = name_and_unit(file.load);
  const auto found = std::ranges::find_if(columns, [&](const FileColumn& column) {
    return column.header == file.load || column.name == name;
  });
  if (found == columns.end()) {
    std::vector<std::string> headers;
    for (const FileColumn& column : columns) headers.push_back(in_quotes(column.header));
    faults.add({}, fmt::format("there is no column {}, which 'load' names (others: {})",
                               in_quotes(file.load), fmt::join(headers, ", ")));
    return std::nullopt;
  }
  if (unit && found->unit && *unit != *found->unit && found->header != file.load)
    faults.add(found->place, fmt::format("the column {} has the unit {}, and {} by 'load'",
                                         in_quotes(found->header), *found->unit, *unit));
  if (unit && !found->unit) found->unit = unit;
  return static_cast<std::size_t>(found - columns.begin());
}

/// u_D of each row.
std::vector<double> uncertainties(const MeasuredFile& file, const CsvTable& table, double factor,
                                  Faults& faults) {
  std::vector<double> result;
  if (table.has(uncertainty_column) == (file.uncertainty || file.relative_uncertainty)) {
    faults.add(table.has(uncertainty_column) ? table.header[uncertainty_column] : Place{},
               table.has(uncertainty_column)
                   ? "the column 'uncertainty' contradicts the key 'uncertainty' of the case: "
                     "leave one of them out"
                   : "the values have no uncertainty: state 'uncertainty' in the case, or add a "
                     "column of that name");
    return result;
  }
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const double value = factor * table.numbers[value_column][i];
    const double u =
        table.has(uncertainty_column)
            ? factor * table.numbers[uncertainty_column][i]
            : file.uncertainty.value_or(file.relative_uncertainty.value_or(0) * std::abs(value));
    if (!(u > 0))
      faults.add(table.rows[i],
                 fmt::format("the uncertainty is {:g} {}, but must be more than zero", u,
                             file.all.measurand.quantity().unit));
    result.push_back(u);
  }
  return result;
}

/// Columns whose unit is that of a load, or the one that the case names.
std::vector<std::size_t> load_columns(const MeasuredFile& file, std::vector<FileColumn>& others,
                                      const std::vector<LoadNumber>& numbers, Faults& faults) {
  const auto is_load = [&](const FileColumn& column) {
    return std::ranges::any_of(
        numbers, [&](const LoadNumber& number) { return is_unit_of(column.unit, number); });
  };
  std::vector<std::size_t> result;
  if (file.load == in_order) return result;
  if (!file.load.empty()) {
    const auto named = named_column(file, others, faults);
    if (!named) return result;
    if (!is_load(others[*named])) {
      std::vector<std::string> known;
      for (const LoadNumber& number : numbers)
        known.push_back(number.quantity.unit.empty()
                            ? number.name
                            : fmt::format("{} ({})", number.name, number.quantity.unit));
      faults.add(others[*named].place,
                 fmt::format("the column {} {} is of no number of the load: {}",
                             in_quotes(others[*named].header),
                             others[*named].unit ? "in " + *others[*named].unit : "without a unit",
                             fmt::join(known, ", ")));
      return result;
    }
    return {*named};
  }
  for (std::size_t i = 0; i < others.size(); ++i)
    if (others[i].unit && is_load(others[i])) result.push_back(i);
  return result;
}

/// The rows' steps: by a column `step`, by a column of loads, or in their order.
Rows rows_of(const MeasuredFile& file, const CsvTable& table, const std::vector<FileColumn>& others,
             const std::vector<std::size_t>& loads, const std::vector<LoadNumber>& numbers,
             std::size_t steps, Faults& faults) {
  if (table.has(step_column)) {
    if (!file.load.empty())
      faults.add(table.header[step_column],
                 "the column 'step' contradicts the key 'load' of the case: leave one of them out");
    return {stated_steps(table, steps, faults), "steps by 'step'"};
  }
  if (loads.empty()) return steps_in_order(file, others, table, numbers, steps, faults);
  std::vector<LoadColumn> columns;
  for (const std::size_t i : loads)
    columns.push_back(
        {others[i].header, others[i].place, others[i].unit, table.numbers[own_columns + i]});
  auto match = match_loads(columns, numbers, table.rows, faults);
  if (!match) return {};
  return {std::move(match->steps), fmt::format("steps by {}", match->by)};
}

std::vector<Measurement> values_of(const MeasuredFile& file, std::string_view text, const Case& c,
                                   std::string& remark, Faults& faults) {
  using Kind = CsvColumn::Kind;
  const Quantity& quantity = file.scale ? quantity::number : file.all.measurand.quantity();
  std::vector<CsvColumn> columns{{file.column, Kind::quantity, quantity, true},
                                 {"uncertainty", Kind::quantity, quantity, false},
                                 {"step", Kind::quantity, quantity::number, false}};
  std::string_view without_mark = text;
  if (!take_byte_order_mark(without_mark, faults)) return {};
  std::vector<FileColumn> others = file_columns(without_mark, faults);
  if (!faults.empty()) return {};
  const std::vector<FileColumn> all = others;
  std::erase_if(others, [&](const FileColumn& column) {
    return std::ranges::find(columns, column.name, &CsvColumn::name) != columns.end();
  });
  const std::vector<LoadNumber> numbers = load_numbers(c);
  const bool has_step = std::ranges::find(all, "step", &FileColumn::name) != all.end();
  const std::vector<std::size_t> loads =
      has_step ? std::vector<std::size_t>() : load_columns(file, others, numbers, faults);
  if (!faults.empty()) return {};
  // The loads are read in the units that they have, the others as words.
  for (std::size_t i = 0; i < others.size(); ++i) {
    const bool is_load = std::ranges::find(loads, i) != loads.end();
    columns.push_back(
        {others[i].name, is_load ? Kind::quantity : Kind::word, quantity::number, false, true});
  }
  const CsvTable table = read_csv(text, columns, {}, faults);
  if (!faults.empty()) return {};
  const double factor = file.scale.value_or(1);
  const Rows rows = rows_of(file, table, others, loads, numbers, c.load_path.size(), faults);
  const std::vector<double> u = uncertainties(file, table, std::abs(factor), faults);
  if (!faults.empty()) return {};
  std::vector<Measurement> result;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    result.push_back(file.all);
    result.back().step = rows.steps[i];
    result.back().value = factor * table.numbers[value_column][i];
    result.back().uncertainty = u[i];
  }
  std::vector<std::string> unread;
  for (const FileColumn& column : others)
    if (rows.by.find(in_quotes(column.header)) == std::string::npos)
      unread.push_back(in_quotes(column.header));
  remark = fmt::format(
      "{}: {} rows of {} from '{}', {}{}", file.path.filename().string(), table.rows.size(),
      file.all.measurand.name, file.column, rows.by,
      unread.empty() ? "" : fmt::format("; columns not read: {}", fmt::join(unread, ", ")));
  return result;
}

}  // namespace

void read_measured_files(const std::vector<MeasuredFile>& files, Case& c) {
  Statement& statement = c.measured;
  std::string messages;
  std::size_t added = 0;
  for (const MeasuredFile& file : files) {
    std::string message;
    std::string remark;
    try {
      Faults faults;
      const auto values = values_of(file, read_csv_file(file.path), c, remark, faults);
      if (!faults.empty()) message = faults.report(file.path.string());
      auto& all = statement.measurements;
      all.insert(all.begin() + static_cast<std::ptrdiff_t>(file.at + added), values.begin(),
                 values.end());
      added += values.size();
      statement.files.push_back(file.path);
    } catch (const InputError& fault) {
      message = fault.what();
    }
    if (!message.empty()) messages += (messages.empty() ? "" : "\n") + message;
    if (std::ranges::find(statement.remarks, remark) == statement.remarks.end())
      statement.remarks.push_back(std::move(remark));
  }
  if (messages.empty() && statement.measurements.size() > most_values)
    messages = fmt::format("there are {} measured values: state at most {}",
                           statement.measurements.size(), most_values);
  if (!messages.empty()) throw InputError(messages);
}

}  // namespace ciliaval::compare::input::measurement
