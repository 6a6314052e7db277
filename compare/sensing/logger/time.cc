// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/sensing/logger/time.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <system_error>

#include "compare/sensing/logger/header.h"

namespace ciliaval::compare::sensing::logger {
namespace {

constexpr long double second = 1e9L;  ///< ns

/// Takes a whole number of so many digits off the text.
std::optional<int> take_digits(std::string_view& text, std::size_t digits) {
  int value = 0;
  if (text.size() < digits || text.front() == '-') return std::nullopt;
  const auto [end, error] = std::from_chars(text.data(), text.data() + digits, value);
  if (error != std::errc() || end != text.data() + digits) return std::nullopt;
  text.remove_prefix(digits);
  return value;
}

bool take(std::string_view& text, char c) {
  if (!text.starts_with(c)) return false;
  text.remove_prefix(1);
  return true;
}

/// "10:18" or "10:18:38.5" in whole ns.
std::optional<long double> take_clock(std::string_view& text) {
  const auto hours = take_digits(text, 2);
  if (!hours || !take(text, ':')) return std::nullopt;
  const auto minutes = take_digits(text, 2);
  if (!minutes || *hours > 24 || *minutes > 59) return std::nullopt;
  long double seconds = 0;
  if (take(text, ':')) {
    const auto length = std::min(text.find_first_not_of("0123456789.,"), text.size());
    const auto value = number_in(text.substr(0, length));
    if (!value || !(*value < 61)) return std::nullopt;
    seconds = *value;
    text.remove_prefix(length);
  }
  return std::round(second * (3600 * *hours + 60 * *minutes + seconds));
}

/// "2026-11-25" in ns since 1970.
std::optional<long double> take_date(std::string_view& text) {
  const auto year = take_digits(text, 4);
  if (!year || !take(text, '-')) return std::nullopt;
  const auto month = take_digits(text, 2);
  if (!month || !take(text, '-')) return std::nullopt;
  const auto day = take_digits(text, 2);
  if (!day) return std::nullopt;
  const std::chrono::year_month_day date{std::chrono::year(*year),
                                         std::chrono::month(static_cast<unsigned>(*month)),
                                         std::chrono::day(static_cast<unsigned>(*day))};
  if (!date.ok()) return std::nullopt;
  return 86400 * second *
         static_cast<long double>(std::chrono::sys_days(date).time_since_epoch().count());
}

/// Nothing, "Z", "+01:00", "+0100" or "+01" at the end of a time, in ns.
std::optional<long double> zone(std::string_view text) {
  if (text.empty() || text == "Z" || text == "z") return 0;
  const int sign = text.front() == '-' ? -1 : 1;
  if (!take(text, '+') && !take(text, '-')) return std::nullopt;
  const auto hours = take_digits(text, 2);
  if (!hours) return std::nullopt;
  take(text, ':');
  const auto minutes = text.empty() ? std::optional(0) : take_digits(text, 2);
  if (!minutes || !text.empty()) return std::nullopt;
  return sign * second * (3600 * *hours + 60 * *minutes);
}

}  // namespace

std::optional<Time> time_of(std::string_view text) {
  using Form = Time::Form;
  if (const auto number = precise_number_in(text))
    return std::isfinite(*number) ? std::optional(Time{Form::number, *number}) : std::nullopt;
  std::string_view rest = text;
  if (const auto clock = take_clock(rest); clock && rest.empty()) return Time{Form::clock, *clock};
  rest = text;
  const auto date = take_date(rest);
  if (!date) return std::nullopt;
  if (rest.empty()) return Time{Form::date, *date};
  if (!take(rest, 'T') && !take(rest, 't') && !take(rest, ' ')) return std::nullopt;
  const auto clock = take_clock(rest);
  const auto offset = clock ? zone(rest) : std::nullopt;
  if (!offset) return std::nullopt;
  return Time{Form::date, *date + *clock - *offset};
}

}  // namespace ciliaval::compare::sensing::logger
