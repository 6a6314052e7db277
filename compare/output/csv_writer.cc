// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/output/csv_writer.h"

#include <charconv>
#include <utility>

#include "problem/support/words.h"

namespace ciliaval::compare::output {
namespace {

/// True if a spreadsheet would compute the text when it opens the file; a number is not computed.
bool is_formula(std::string_view text) {
  if (text.empty() || std::string_view("=+-@").find(text.front()) == std::string_view::npos)
    return false;
  double number = 0;
  const char* const end = text.data() + text.size();
  return std::from_chars(text.data() + (text.front() == '+' ? 1 : 0), end, number).ptr != end;
}

}  // namespace

void CsvWriter::column(std::string_view name, std::string_view unit) {
  add(name);
  if (!unit.empty()) units_ += fmt::format("{}{} {}", units_.empty() ? "" : ", ", name, unit);
}

void CsvWriter::vector_columns(std::string_view name, std::string_view unit) {
  for (const char* axis : axis_names) column(fmt::format("{}{}", name, axis), unit);
}

void CsvWriter::add(std::string_view text) {
  const std::string shown = (is_formula(text) ? "'" : "") + support::printable(text, "\n");
  if (shown.find_first_of(",\"\n") == std::string::npos) return append(shown);
  std::string quoted = "\"";
  for (const char c : shown) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  append(quoted + '"');
}

void CsvWriter::add(const std::optional<Vector3>& v) {
  for (Eigen::Index i = 0; i < 3; ++i) add(v ? std::optional((*v)[i]) : std::nullopt);
}

void CsvWriter::append(std::string_view cell) {
  if (is_row_begun_) text_ += ',';
  text_ += cell;
  is_row_begun_ = true;
}

void CsvWriter::end_row() {
  text_ += '\n';
  if (!units_.empty())
    text_ += fmt::format("# units: {}\n", support::printable(std::exchange(units_, {}), ""));
  is_row_begun_ = false;
}

}  // namespace ciliaval::compare::output
