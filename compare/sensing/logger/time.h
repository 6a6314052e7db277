// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <limits>
#include <optional>
#include <string_view>

namespace ciliaval::compare::sensing::logger {

/// Nanoseconds since 1970 are whole numbers up to 2^64 ns in year 2554. A long double holds them
/// exactly, a double to 256 ns.
static_assert(std::numeric_limits<long double>::digits >= 64);

/// A time as a logger writes it.
struct Time {
  enum class Form {
    number,  ///< in the unit of its column
    date,    ///< ISO 8601, whole ns since 1970
    clock    ///< hh:mm:ss, whole ns since midnight
  };
  Form form = Form::number;
  long double value = 0;
};

/// A number, "2026-11-25T10:18:38.5+01:00" (date and time of day, with T or a blank between; a
/// fraction after a point or comma; Z, an offset or nothing), "2026-11-25" or "10:18:38.5"; none
/// for anything else.
std::optional<Time> time_of(std::string_view text);

}  // namespace ciliaval::compare::sensing::logger
