// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/input/case_syntax.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string>
#include <system_error>

#include "compare/input/case_toml.h"
#include "compare/input/units.h"
#include "problem/error.h"

namespace ciliaval::compare::input {
namespace {

constexpr int deepest_key = 32;  ///< parts of a dotted key
constexpr std::size_t none = std::string_view::npos;

/// True if the byte starts a character: bytes 10xxxxxx continue one.
bool starts_character(char c) {
  return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
}

/// Line and column of a byte of the text; columns count characters, as toml++ does.
Place place_of_byte(std::string_view text, std::size_t byte) {
  const std::string_view before = text.substr(0, byte);
  const std::size_t line_end = before.rfind('\n');
  const std::string_view line = before.substr(line_end == none ? 0 : line_end + 1);
  return {1 + static_cast<std::size_t>(std::count(before.begin(), before.end(), '\n')),
          1 + static_cast<std::size_t>(std::count_if(line.begin(), line.end(), starts_character))};
}

/// The first byte behind the TOML string that opens at `i`. One of a single line that is not closed
/// ends with the line.
std::size_t end_of_string(std::string_view text, std::size_t i) {
  const char quote = text[i];
  const std::string fence(3, quote);  // of a string of several lines
  const bool several_lines = text.substr(i).starts_with(fence);
  for (i += several_lines ? 3 : 1; i < text.size(); ++i) {
    if (text[i] == '\\' && quote == '"') {
      ++i;
    } else if (!several_lines && (text[i] == quote || text[i] == '\n')) {
      return text[i] == quote ? i + 1 : i;
    } else if (several_lines && text.substr(i).starts_with(fence)) {
      i += 3;
      // One or two more quotes belong to the string: """a""""".
      for (int more = 0; more < 2 && i < text.size() && text[i] == quote; ++more) ++i;
      return i;
    }
  }
  return text.size();
}

/// Refuses a dotted key of very many parts ("a.a.a.…"): toml++ nests a table for each, and the
/// recursion over them has no limit. Dots in comments and strings do not count. Throws InputError.
void refuse_deep_keys(std::string_view text, std::string_view file) {
  constexpr std::string_view blanks = " \t\r";
  constexpr std::string_view separators = "\n,=[{";
  int parts = 1;
  std::size_t start = none;  // of the key or value that we are in
  for (std::size_t i = 0; i < text.size();) {
    const char c = text[i];
    if (c == '#') {
      i = std::min(text.find('\n', i), text.size());
      continue;
    }
    if (separators.find(c) != none) {
      parts = 1;
      start = none;
    } else if (start == none && blanks.find(c) == none) {
      start = i;
    }
    if (c == '.' && ++parts > deepest_key) {
      const Place where = place_of_byte(text, start);
      throw InputError(fmt::format("{}:{}:{}: a dotted key of more than {} parts", file, where.line,
                                   where.column, deepest_key));
    }
    i = c == '"' || c == '\'' ? end_of_string(text, i) : i + 1;
  }
}

/// A letter as a unit starts with one: also % and every character beyond ASCII (µ, °).
bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '%' ||
         static_cast<unsigned char>(c) >= 0x80U;
}

/// The byte at which the character of this column begins, or the line's end.
std::size_t byte_at(std::string_view line, std::size_t column) {
  std::size_t byte = 0;
  for (std::size_t character = 0; byte < line.size(); ++byte)
    if (starts_character(line[byte]) && ++character == column) break;
  return byte;
}

/// True if the last comma up to the column stands between two digits, "0,49".
bool is_behind_decimal_comma(std::string_view line, std::size_t column) {
  const std::size_t comma = line.find_last_of(',', byte_at(line, column));
  return comma != none && comma > 0 && comma + 1 < line.size() && is_digit(line[comma - 1]) &&
         is_digit(line[comma + 1]);
}

/// The line's text from the start of the value that the column stands in or behind; empty if there
/// is none or it lies in a string.
std::string_view value_at(std::string_view line, std::size_t column) {
  const std::string_view before = line.substr(0, byte_at(line, column));
  const std::size_t separator = before.find_last_of("=,[");
  if (separator == none || std::count(before.begin(), before.end(), '"') % 2 != 0 ||
      std::count(before.begin(), before.end(), '\'') % 2 != 0)
    return {};
  const std::size_t value = line.find_first_not_of(" \t", separator + 1);
  return value == none ? std::string_view() : line.substr(value);
}

/// Advice on a value that TOML cannot read: a quantity without quotes, a number that is too large;
/// otherwise empty.
std::string_view advice(std::string_view value) {
  if (value.starts_with('+')) value.remove_prefix(1);
  std::string digits;  // TOML allows underscores between them
  for (const char c : value)
    if (c != '_') digits += c;
  const std::size_t sign = digits.starts_with('-') ? 1 : 0;
  if (digits.size() <= sign || (!is_digit(digits[sign]) && digits[sign] != '.')) return "";
  double real = 0;
  const char* const last = digits.data() + digits.size();
  const auto [end, error] = std::from_chars(digits.data(), last, real);
  if (error == std::errc::invalid_argument) return "";
  const char* const unit = std::find_if(end, last, [](char c) { return c != ' ' && c != '\t'; });
  if (unit != last && is_letter(*unit))
    return "; a quantity is a text: write it in quotes, such as \"3 mm\"";
  if (error == std::errc::result_out_of_range)
    return "; the number is outside the range of double precision";
  std::int64_t whole = 0;
  const auto integer = std::from_chars(digits.data(), last, whole);
  if (integer.ec == std::errc::result_out_of_range && integer.ptr == end)
    return "; the whole number is outside the range of 64 bits";
  return "";
}

/// The line of this number, from 1.
std::string_view line_of(std::string_view text, std::size_t number) {
  for (; number > 1 && text.find('\n') != none; --number) text.remove_prefix(text.find('\n') + 1);
  return text.substr(0, text.find('\n'));
}

}  // namespace

toml::table parse_toml(std::string_view text, std::string_view file) {
  refuse_deep_keys(text, file);
  try {
    return toml::parse(text);
  } catch (const toml::parse_error& error) {
    const toml::source_position& where = error.source().begin;
    const std::string_view line = line_of(text, where.line);
    throw InputError(fmt::format(
        "{}:{}:{}: {}{}", file, where.line, where.column, error.description(),
        is_behind_decimal_comma(line, where.column) ? "; a decimal number has a point, as 0.49"
                                                    : advice(value_at(line, where.column))));
  }
}

std::string read_file(const std::filesystem::path& file, std::string_view kind,
                      std::uintmax_t largest) {
  const std::string name = file.string();
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status))
    throw InputError(fmt::format("{}: the {} file does not exist", name, kind));
  if (std::filesystem::is_directory(status))
    throw InputError(fmt::format("{}: is a folder, not a {} file", name, kind));
  if (!std::filesystem::is_regular_file(status))
    throw InputError(fmt::format("{}: is not a regular file", name));
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (!error && size > largest)
    throw InputError(fmt::format("{}: {} bytes are too large for a {} file (at most {})", name,
                                 size, kind, largest));
  std::ifstream in(file, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  if (!in.is_open() || in.bad())
    throw InputError(
        fmt::format("{}: the {} file cannot be read: {}", name, kind, std::strerror(errno)));
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF"))
    throw InputError(fmt::format("{}: the {} file is in UTF-16: save it in UTF-8", name, kind));
  return text;
}

}  // namespace ciliaval::compare::input
