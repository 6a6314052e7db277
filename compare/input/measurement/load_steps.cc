// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/input/measurement/load_steps.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include "compare/input/case.h"
#include "compare/input/units.h"
#include "problem/description/environment.h"
#include "problem/error.h"

namespace ciliaval::compare::input::measurement {
namespace {

constexpr double same_load = 1e-6;  ///< of the largest of a path

double largest_of(const std::vector<double>& values) {
  double largest = 0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  return largest;
}

bool varies(const LoadNumber& number) {
  const auto [least, most] = std::ranges::minmax(number.values);
  return most - least > same_load * largest_of(number.values);
}

/// The number of each step.
template <class Get>
LoadNumber number_of(const Case& c, std::string name, const Quantity& quantity, const Get& get) {
  LoadNumber number{std::move(name), quantity, {}};
  for (const Load& load : c.load_path) number.values.push_back(get(load));
  return number;
}

/// The three components of a vector.
template <class Get>
void add_vector(const Case& c, const std::string& name, const Quantity& quantity, const Get& get,
                std::vector<LoadNumber>& numbers) {
  for (Eigen::Index axis = 0; axis < 3; ++axis)
    numbers.push_back(number_of(c, fmt::format("{} {}", name, "xyz"[axis]), quantity,
                                [&](const Load& load) { return get(load)[axis]; }));
}

std::vector<LoadNumber> all_numbers(const Case& c) {
  std::vector<LoadNumber> numbers;
  const LoadType& type = c.load_path.front().type();
  if (!c.stated_by.empty())
    for (const auto& key : type.statement->parameters)
      numbers.push_back({std::string(key.name), key.quantity, stated_values(c, key.name)});
  for (const LoadParameter& key : type.parameters)
    numbers.push_back(number_of(c, std::string(key.name), key.quantity,
                                [&](const Load& load) { return key.number(load); }));
  for (const auto& key : description::fields<surroundings::Environment>()) {
    if (!key.is_along_path) continue;
    const auto vector = [&key](const Load& load) {
      return std::get<Vector3>(key.get(acting_environment(load)));
    };
    add_vector(c, std::string(key.name), key.quantity, vector, numbers);
    numbers.push_back(number_of(c, fmt::format("|{}|", key.name), key.quantity,
                                [&](const Load& load) { return vector(load).norm(); }));
  }
  const auto& magnets = c.load_path.front().environment().magnets;
  for (std::size_t m = 0; m < magnets.size(); ++m)
    for (const auto& key : description::fields<surroundings::magnets::Magnet>())
      if (key.is_along_path)
        add_vector(
            c, fmt::format("magnet {} {}", magnets[m].name, key.name), key.quantity,
            [&](const Load& load) {
              return std::get<Vector3>(key.get(load.environment().magnets.at(m)));
            },
            numbers);
  return numbers;
}

/// The factor from the column's unit to the number's SI unit.
std::optional<double> factor_of(const std::optional<std::string>& unit, const LoadNumber& number) {
  if (number.quantity.unit.empty() || !unit)
    return number.quantity.unit.empty() && !unit ? std::optional(1.0) : std::nullopt;
  try {
    return parse_quantity("1 " + *unit, number.quantity);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

/// A step for each row, or what is wrong.
struct Attempt {
  std::vector<std::size_t> steps;
  std::size_t matched = 0;
  std::vector<std::pair<Place, std::string>> faults;
};

Attempt attempt(const LoadColumn& column, const LoadNumber& number, double factor,
                const std::vector<Place>& rows) {
  const std::vector<double>& steps = number.values;
  const double tolerance = same_load * largest_of(steps);
  const auto same = [&](double a, double b) { return std::abs(a - b) <= tolerance; };
  const auto text = [&](double value) {
    const std::string unit = column.unit ? " " + *column.unit : std::string();
    return fmt::format("{:.10g}{}", value / factor, unit);
  };
  Attempt result;
  std::vector<double> sorted = steps;
  std::ranges::sort(sorted);
  const bool alike = std::ranges::adjacent_find(sorted, same) != sorted.end();
  std::vector<std::size_t> taken(steps.size(), rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double value = factor * column.values[i];
    std::size_t k = i;
    if (!alike || i >= steps.size() || !same(steps[i], value))
      k = static_cast<std::size_t>(
          std::ranges::find_if(steps, [&](double step) { return same(step, value); }) -
          steps.begin());
    if (k == steps.size()) {
      std::vector<std::string> known;
      for (const double step : steps) known.push_back(text(step));
      result.faults.push_back(
          {rows[i], fmt::format("{} in the column {} is the load of no step; {} of the steps: {}",
                                text(value), in_quotes(column.header), number.name,
                                fmt::join(known, ", "))});
    } else if (alike && k != i) {
      result.faults.push_back(
          {rows[i], fmt::format("several steps have one {}, so that the rows must stand in the "
                                "steps' order, or a column 'step' counts them from 0; {} in the "
                                "column {} does not stand so",
                                number.name, text(value), in_quotes(column.header))});
    } else if (taken[k] != rows.size()) {
      result.faults.push_back(
          {rows[i], fmt::format("there is a second row of the load {}", text(value))});
    } else {
      taken[k] = i;
      ++result.matched;
    }
    result.steps.push_back(k);
  }
  for (std::size_t k = 0; k < steps.size(); ++k)
    if (taken[k] == rows.size() && result.faults.empty())
      result.faults.push_back(
          {rows.back(), fmt::format("there is no row of step {}, {} {}, in the column {}", k,
                                    number.name, text(steps[k]), in_quotes(column.header))});
  return result;
}

}  // namespace

std::vector<LoadNumber> load_numbers(const Case& c) {
  std::vector<LoadNumber> numbers = all_numbers(c);
  const auto is_zero = [](const LoadNumber& number) { return largest_of(number.values) == 0; };
  const auto is_same = [](const LoadNumber& number) { return !varies(number); };
  const bool alike = std::ranges::all_of(numbers, is_same);
  std::erase_if(
      numbers, [&](const LoadNumber& number) { return alike ? is_zero(number) : is_same(number); });
  return numbers;
}

bool is_unit_of(const std::optional<std::string>& unit, const LoadNumber& number) {
  return factor_of(unit, number).has_value();
}

std::optional<LoadMatch> match_loads(const std::vector<LoadColumn>& columns,
                                     const std::vector<LoadNumber>& numbers,
                                     const std::vector<Place>& rows, Faults& faults) {
  std::optional<LoadMatch> result;
  std::optional<Attempt> nearest;
  for (const LoadColumn& column : columns)
    for (const LoadNumber& number : numbers) {
      const auto factor = factor_of(column.unit, number);
      if (!factor) continue;
      Attempt tried = attempt(column, number, *factor, rows);
      if (!tried.faults.empty()) {
        if (!nearest || tried.matched > nearest->matched) nearest = std::move(tried);
        continue;
      }
      if (!result) {
        result = {std::move(tried.steps),
                  fmt::format("{} ({})", in_quotes(column.header), number.name)};
      } else if (result->steps != tried.steps) {
        faults.add(column.place,
                   fmt::format("both {} and {} ({}) have the loads of the steps, in different "
                               "orders: say which one it is, such as load = \"{}\"",
                               result->by, in_quotes(column.header), number.name, column.header));
        return std::nullopt;
      }
    }
  if (result) return result;
  if (nearest)
    for (auto& [where, what] : nearest->faults) faults.add(where, std::move(what));
  return std::nullopt;
}

}  // namespace ciliaval::compare::input::measurement
