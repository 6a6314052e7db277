// SPDX-License-Identifier: LGPL-2.1-or-later
// Measured values from CSV files.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

#include "compare/input/csv.h"
#include "compare/input/measurement/measurement.h"
#include "problem/error.h"

namespace ciliaval::compare::input::measurement {
namespace {

constexpr std::size_t value_column = 0;
constexpr std::size_t uncertainty_column = 1;
constexpr std::size_t step_column = 2;

/// The names in the header, so that columns about other things can be left aside.
std::vector<std::string> header_names(std::string_view text) {
  while (!text.empty()) {
    const std::string_view line = take_line(text);
    const auto first = line.find_first_not_of(" \t");
    if (first == std::string_view::npos || line[first] == '#' || line[first] == '%') continue;
    std::vector<std::string> names;
    for (const CsvCell& cell : csv_cells(line, 1)) names.push_back(name_and_unit(cell.text).first);
    return names;
  }
  return {};
}

/// The step of each row: its number, or what a column says.
std::vector<std::size_t> steps_of(const CsvTable& table, std::size_t steps, Faults& faults) {
  std::vector<std::size_t> result;
  const std::size_t rows = table.rows.size();
  if (!table.has(step_column)) {
    if (rows != steps)
      faults.add(table.rows.back(),
                 fmt::format("the file has {} rows and the case {} load steps: a row for each, or "
                             "a column 'step' that counts them from 0",
                             rows, steps));
    for (std::size_t i = 0; i < rows; ++i) result.push_back(i);
    return result;
  }
  std::set<double> seen;
  for (std::size_t i = 0; i < rows; ++i) {
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

std::vector<Measurement> values_of(const MeasuredFile& file, std::string_view text,
                                   std::size_t steps, Faults& faults) {
  using Kind = CsvColumn::Kind;
  const Quantity& quantity = file.scale ? quantity::number : file.all.measurand.quantity();
  const std::array<CsvColumn, 3> columns{{{file.column, Kind::quantity, quantity, true},
                                          {"uncertainty", Kind::quantity, quantity, false},
                                          {"step", Kind::quantity, quantity::number, false}}};
  const std::vector<std::string> names = header_names(text);
  std::vector<std::string_view> others;
  for (const std::string& name : names)
    if (std::ranges::find(columns, name, &CsvColumn::name) == columns.end()) others.push_back(name);
  const CsvTable table = read_csv(text, columns, others, faults);
  if (!faults.empty()) return {};
  const double factor = file.scale.value_or(1);
  const std::vector<std::size_t> at = steps_of(table, steps, faults);
  const std::vector<double> u = uncertainties(file, table, std::abs(factor), faults);
  if (!faults.empty()) return {};
  std::vector<Measurement> result;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    result.push_back(file.all);
    result.back().step = at[i];
    result.back().value = factor * table.numbers[value_column][i];
    result.back().uncertainty = u[i];
  }
  return result;
}

}  // namespace

void read_measured_files(const std::vector<MeasuredFile>& files, std::size_t steps,
                         Statement& statement) {
  std::string messages;
  std::size_t added = 0;
  for (const MeasuredFile& file : files) {
    std::string message;
    try {
      Faults faults;
      const auto values = values_of(file, read_csv_file(file.path), steps, faults);
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
  }
  if (messages.empty() && statement.measurements.size() > most_values)
    messages = fmt::format("there are {} measured values: state at most {}",
                           statement.measurements.size(), most_values);
  if (!messages.empty()) throw InputError(messages);
}

}  // namespace ciliaval::compare::input::measurement
