// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/input/case_keys.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>
#include <type_traits>

namespace ciliaval::compare::input {
namespace {

/// A TOML string in double quotes; the text has no control characters.
std::string in_toml_quotes(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + '"';
}

}  // namespace

std::string describe(const Range& range, const Quantity& quantity) {
  const bool is_angle = quantity.unit == quantity::angle.unit;
  const std::string_view name = is_angle ? "deg" : quantity.unit;
  const double factor = is_angle ? 180 / std::numbers::pi : 1;
  const std::string unit = name.empty() ? "" : fmt::format(" {}", name);
  const std::string lower = fmt::format("{:g}{}", range.lower * factor, unit);
  const std::string upper = fmt::format("{:g}{}", range.upper * factor, unit);
  if (range.excludes_ends) return fmt::format("between {} and {}, both excluded", lower, upper);
  return fmt::format("from {} to {}", lower, upper);
}

bool belongs(const Option& option, const ModelOptions& options) {
  return !option.belongs || option.belongs(options);
}

bool Option::is_whole_number() const {
  return std::holds_alternative<unsigned int>(get({}));
}

std::optional<double> Option::number(const ModelOptions& options) const {
  const OptionValue value = get(options);
  if (const auto* whole = std::get_if<unsigned int>(&value)) return *whole;
  const auto* real = std::get_if<double>(&value);
  return real == nullptr ? std::nullopt : std::optional(*real);
}

void Option::set_number(ModelOptions& options, double value) const {
  set(options, is_whole_number() ? OptionValue(static_cast<unsigned int>(std::lround(value)))
                                 : OptionValue(value));
}

std::string to_toml(const Option& option, const OptionValue& value) {
  return std::visit(
      [&option](const auto& v) -> std::string {
        using T = std::decay_t<decltype(v)>;
        if constexpr (std::is_same_v<T, std::string>) return in_toml_quotes(v);
        if constexpr (std::is_same_v<T, bool>) return v ? "true" : "false";
        if constexpr (std::is_same_v<T, unsigned int>) return fmt::format("{}", v);
        if constexpr (std::is_same_v<T, std::array<double, 2>>)
          return fmt::format("[{}, {}]", format_number(v[0]), format_number(v[1]));
        if constexpr (std::is_same_v<T, double>)
          return option.quantity.unit.empty()
                     ? format_number(v)
                     : fmt::format("\"{}\"", format_quantity(v, option.quantity));
      },
      value);
}

}  // namespace ciliaval::compare::input
