// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/input/case_keys.h"

#include <fmt/format.h>

#include <numbers>

namespace ciliaval::compare::input {
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

}  // namespace ciliaval::compare::input
