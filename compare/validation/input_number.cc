// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/validation/input_number.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>
#include <system_error>

#include "compare/input/case_sections.h"
#include "compare/input/units.h"
#include "problem/error.h"
#include "problem/support/words.h"

namespace ciliaval::compare::validation {
namespace {

using input::measurement::InputUncertainty;
using study::CaseNumber;

/// Calls f with the case of each load step alone.
template <class F>
void for_each_step(const input::Case& c, const F& f) {
  input::Case one = c;
  one.external.clear();
  for (std::size_t step = 0; step < c.load_path.size(); ++step) {
    one.load_path = {c.load_path[step]};
    if (!c.stated_by.empty()) one.stated_by = {c.stated_by[step]};
    f(one, step);
  }
}

/// True if the number is one of each step, not of the whole case.
bool is_of_steps(const CaseNumber& number) {
  return number.path.starts_with("load.") || number.path.starts_with("environment.");
}

/// The numbers of the case; of load and environment those of any single step, so that what tells
/// the steps apart is among them.
std::vector<CaseNumber> numbers_of(const input::Case& c) {
  std::vector<CaseNumber> all = study::case_numbers(c);
  for_each_step(c, [&](const input::Case& one, std::size_t step) {
    if (step > 0 && c.load_path[step].environment() == c.load_path[step - 1].environment()) return;
    for (CaseNumber& number : study::case_numbers(one))
      if (is_of_steps(number) &&
          std::ranges::find(all, number.path, &CaseNumber::path) == all.end())
        all.push_back(std::move(number));
  });
  return all;
}

/// The number's values that are shifted: one, or that of each step.
std::vector<double> values_of(const input::Case& c, const Input& input) {
  if (!input.at_each_step) return {input.number.number(c)};
  std::vector<double> values;
  for_each_step(
      c, [&](const input::Case& one, std::size_t) { values.push_back(input.number.number(one)); });
  return values;
}

double deviation(const Input& input, double value) {
  return input.is_relative ? input.uncertainty * std::abs(value) : input.uncertainty;
}

/// Of values that are as likely between a and b the standard deviation is (b − a)/√12.
const double end_of_range = std::sqrt(3);  ///< in standard deviations

double plain_number(const std::string& text) {
  const std::string_view digits = support::trimmed(text);
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || end != digits.data() + digits.size())
    throw InputError(fmt::format("'{}' is no plain number", text));
  return value;
}

/// A range's middle and its standard uncertainty. Throws InputError.
void read_range(const input::Case& c, const InputUncertainty& stated, Input& input) {
  const Quantity& quantity = input.number.quantity;
  std::array<double, 2> ends{};
  for (std::size_t i = 0; i < 2; ++i) {
    const std::string& text = stated.uncertainty[i];
    ends.at(i) = quantity.unit.empty() ? plain_number(text) : input::parse_quantity(text, quantity);
    if (!input.number.range.contains(ends.at(i)))
      throw InputError(fmt::format("'{}' is no value of '{}', which lies {}", text,
                                   input.number.path,
                                   input::describe(input.number.range, quantity)));
  }
  const auto [low, high] = ends;
  if (!(low < high)) throw InputError("the ends of a range must rise");
  for (const double value : values_of(c, input))
    if (value < low || value > high)
      throw InputError(
          fmt::format("the case's own '{}' lies outside the range", input.number.path));
  input.middle = (low + high) / 2;
  input.uncertainty = (high - low) / (2 * end_of_range);
  input.step = end_of_range;
}

/// Sets Input::uncertainty. Throws InputError.
void read_uncertainty(const InputUncertainty& stated, Input& input) {
  const Quantity& quantity = input.number.quantity;
  const std::string& text = stated.uncertainty.front();
  const bool is_percent = !stated.is_plain && support::trimmed(text).ends_with('%');
  if (is_percent && quantity.unit != quantity::percentage.unit) {
    input.is_relative = true;
    input.uncertainty = input::parse_quantity(text, quantity::percentage) / 100;
  } else if (stated.is_plain != quantity.unit.empty()) {
    throw InputError(fmt::format(
        "'{}' is {} {}: write {}, or a part of it, \"2 %\"", input.number.path, quantity.article,
        quantity.name,
        quantity.unit.empty()
            ? "a number without quotes"
            : fmt::format("the uncertainty with its unit, as in \"{}\"", quantity.example)));
  } else {
    input.uncertainty = stated.is_plain ? std::stod(text) : input::parse_quantity(text, quantity);
  }
  if (!(input.uncertainty > 0))
    throw InputError(
        fmt::format("the standard uncertainty must be more than zero, not {:g}; leave "
                    "out what is known exactly",
                    input.uncertainty));
}

/// Sets Input::step so that the shifted values lie in the number's range. Throws InputError.
void choose_step(const input::Case& c, Input& input) {
  constexpr double least = 1e-6;
  const std::vector<double> values = values_of(c, input);
  if (input.is_relative && std::ranges::all_of(values, [](double v) { return v == 0; }))
    throw InputError("a part of zero is zero: state the uncertainty in the number's unit");
  const auto fits = [&](double value) {
    const double shift = input.step * deviation(input, value);
    return shift == 0 || (input.number.range.contains(value - shift) &&
                          input.number.range.contains(value + shift));
  };
  while (!std::ranges::all_of(values, fits)) {
    input.step /= 2;
    if (input.step < least)
      throw InputError(fmt::format(
          "'{}' stands at the end of its range, {}: it cannot be shifted "
          "to both sides; state its uncertainty as a part of it, or leave "
          "it out",
          input.number.path, input::describe(input.number.range, input.number.quantity)));
  }
}

/// The number that is meant. Throws InputError.
CaseNumber number_of(const InputUncertainty& stated, const std::vector<CaseNumber>& known) {
  const auto found = std::ranges::find(known, stated.number, &CaseNumber::path);
  if (found != known.end() && !stated.number.starts_with("models.")) return *found;
  std::string names;
  std::vector<std::string_view> candidates;
  for (const CaseNumber& number : known) {
    if (number.path.starts_with("models.")) continue;
    names += (names.empty() ? "" : ", ") + number.path;
    candidates.emplace_back(number.path);
  }
  if (found != known.end())
    throw InputError(
        fmt::format("'{}' is an option of a model, not an input of the case (valid: "
                    "{})",
                    stated.number, names));
  throw InputError(fmt::format("the case has no number {} (valid: {}){}",
                               input::in_quotes(stated.number), names,
                               support::did_you_mean(stated.number, candidates)));
}

}  // namespace

std::vector<Input> read_inputs(const input::Case& c) {
  if (c.measured.inputs.empty()) return {};
  const std::vector<CaseNumber> known = numbers_of(c);
  std::vector<Input> inputs;
  std::string faults;
  const auto refuse = [&](const std::string& place, const std::string& fault) {
    faults += fmt::format("{}{}: {}", faults.empty() ? "" : "\n", place, fault);
  };
  for (const InputUncertainty& stated : c.measured.inputs) {
    const std::string* place = &stated.number_place;
    try {
      Input input{.number = number_of(stated, known), .source = stated.source};
      for (const Input& other : inputs)
        if (other.number.sets == input.number.sets)
          throw InputError(
              fmt::format("'{}' is set by '{}' already", input.number.path, other.number.path));
      place = &stated.uncertainty_place;
      input.at_each_step = is_of_steps(input.number);
      if (stated.uncertainty.size() == 2) {
        read_range(c, stated, input);
      } else {
        read_uncertainty(stated, input);
        choose_step(c, input);
      }
      inputs.push_back(std::move(input));
    } catch (const InputError& fault) {
      refuse(*place, fault.what());
    }
  }
  if (!faults.empty()) throw InputError(faults);
  return inputs;
}

input::Case shifted(const input::Case& c, const Input& input, double deviations) {
  input::Case result = c;
  result.external.clear();
  const auto shift = [&](input::Case& x) {
    const double value = input.middle.value_or(input.number.number(x));
    input.number.set_number(x, value + deviations * deviation(input, value));
    input::set_stated_magnitudes(x);
  };
  if (!input.at_each_step) {
    shift(result);
    // A load at a segment's end stays there.
    const std::vector<double> old_ends = c.cilium.interfaces();
    const std::vector<double> ends = result.cilium.interfaces();
    for (std::size_t i = 0; i < result.load_path.size(); ++i)
      for (std::size_t p = 0; p < result.load_path[i].values().size(); ++p) {
        if (result.load_path[i].type().parameters[p].site != LoadParameter::Site::arclength)
          continue;
        const auto end = std::ranges::find(old_ends, c.load_path[i].values()[p]);
        if (end != old_ends.end())
          result.load_path[i].set_value(p, ends[static_cast<std::size_t>(end - old_ends.begin())]);
      }
    return result;
  }
  for_each_step(c, [&](input::Case& one, std::size_t step) {
    shift(one);
    result.load_path[step] = one.load_path.front();
    if (!one.stated_by.empty()) result.stated_by[step] = one.stated_by.front();
  });
  return result;
}

}  // namespace ciliaval::compare::validation
