// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/case.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <system_error>

#include "compare/case_sections.h"
#include "problem/error.h"

namespace ciliaval::compare {
namespace {

constexpr std::uintmax_t largest_file = 1'000'000;  ///< bytes
constexpr int deepest_key = 32;                     ///< parts of a dotted key

/// The text of a regular file. Throws InputError.
std::string read_file(const std::filesystem::path& file) {
  const std::string name = file.string();
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status))
    throw InputError(fmt::format("{}: the case file does not exist", name));
  if (std::filesystem::is_directory(status))
    throw InputError(fmt::format("{}: is a folder, not a case file", name));
  if (!std::filesystem::is_regular_file(status))
    throw InputError(fmt::format("{}: is not a regular file", name));
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (!error && size > largest_file)
    throw InputError(fmt::format("{}: {} bytes are too large for a case file (at most {})", name,
                                 size, largest_file));
  std::ifstream in(file, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  if (!in.is_open() || in.bad())
    throw InputError(
        fmt::format("{}: the case file cannot be read: {}", name, std::strerror(errno)));
  return text;
}

/// Refuses a dotted key of very many parts ("a.a.a.…"): toml++ nests a table for each, and the
/// recursion over them has no limit. Throws InputError.
void refuse_deep_keys(std::string_view text, std::string_view file) {
  std::size_t line = 1;
  int parts = 1;
  char quote = 0;  // the one that opened the text we are in, on this line
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '\n') ++line;
    if (c == '\n' || (quote == 0 && (c == ',' || c == '=' || c == '[' || c == '#'))) {
      parts = 1;
      quote = 0;
    } else if (quote != 0) {
      if (c == '\\' && quote == '"') ++i;
      if (c == quote) quote = 0;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '.' && ++parts > deepest_key) {
      throw InputError(
          fmt::format("{}:{}:1: a dotted key of more than {} parts", file, line, deepest_key));
    }
  }
}

/// What to do about a syntax error, where that can be told from its line: a quantity without
/// quotes.
std::string_view advice(std::string_view text, std::size_t line_number) {
  for (; line_number > 1 && text.find('\n') != std::string_view::npos; --line_number)
    text.remove_prefix(text.find('\n') + 1);
  const std::string_view line = text.substr(0, text.find('\n'));
  const std::size_t equals = line.find('=');
  if (equals == std::string_view::npos || line.find_first_of("\"'") != std::string_view::npos)
    return "";
  const std::size_t value = line.find_first_not_of(" \t[", equals + 1);
  if (value == std::string_view::npos || line.find_first_of("+-.0123456789", value) != value)
    return "";
  return "; a quantity is a text: write it in quotes, such as \"3 mm\"";
}

toml::table parse(std::string_view text, std::string_view file) {
  refuse_deep_keys(text, file);
  try {
    return toml::parse(text);
  } catch (const toml::parse_error& error) {
    const toml::source_position& where = error.source().begin;
    throw InputError(fmt::format("{}:{}:{}: {}{}", file, where.line, where.column,
                                 error.description(), advice(text, where.line)));
  }
}

}  // namespace

Case read_case(std::string_view text, std::string_view file) {
  const toml::table table = parse(text, file);
  Faults faults;
  Section root(&table, "the case file", "", {}, faults);
  Case c;
  read_header(root, c);
  const bool cilium = read_cilium(root, c);
  const bool load = read_load(root, c);
  read_sensor(root, c);
  const bool models = read_models(root, c);
  root.finish();
  if (cilium) snap_to_interfaces(c.cilium, c.load_path);
  check_together(table, c, {cilium, load, models}, faults);
  if (!faults.empty()) throw InputError(faults.report(file));

  // What the models themselves demand; a case that comes so far has it.
  require_valid(c.cilium);
  for (const Load& step : c.load_path) require_valid(step, c.cilium);
  return c;
}

Case read_case(const std::filesystem::path& file) {
  return read_case(read_file(file), file.string());
}

}  // namespace ciliaval::compare
