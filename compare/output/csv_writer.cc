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

void CsvWriter::comment(std::string_view text) {
  (text_.empty() || is_row_begun_ ? comments_ : text_) +=
      fmt::format("# {}\n", support::printable(text, ""));
}

void CsvWriter::add(std::string_view text) {
  const std::string shown = (is_formula(text) ? "'" : "") + support::printable(text, "\n");
  if (shown.find_first_of(",\"\n") == std::string::npos) return append(shown);
  std::string quoted = "\"";
  for (const char c : shown) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  append(quoted + '"');
}

void CsvWriter::append(std::string_view cell) {
  if (is_row_begun_) text_ += ',';
  text_ += cell;
  is_row_begun_ = true;
}

void CsvWriter::end_row() {
  text_ += '\n' + std::exchange(comments_, {});
  is_row_begun_ = false;
}

}  // namespace ciliaval::compare::output
