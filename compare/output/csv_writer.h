// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <fmt/format.h>

#include <concepts>
#include <optional>
#include <string>
#include <string_view>

namespace ciliaval::compare::output {

/// The text of a CSV file (RFC 4180), whose first line names the columns. Numbers have the digits
/// that give them back, a zero has no sign, an undefined value is an empty cell. A text that a
/// spreadsheet would take for a formula gets an apostrophe in front; control characters and bytes
/// that are no UTF-8 are shown as `\x1B`.
class CsvWriter {
 public:
  /// A line that readers skip, below the row that is begun and never the first of the file: NumPy
  /// takes the names of the columns from that, whatever it is.
  void comment(std::string_view text);

  /// A whole row.
  template <class... Cells>
  void row(const Cells&... cells) {
    (add(cells), ...);
    end_row();
  }

  /// The next cell of a row.
  void add(std::string_view text);
  template <class T>
  requires std::integral<T> || std::floating_point<T>
  void add(T number) {
    if constexpr (std::same_as<T, bool>)
      append(number ? "true" : "false");
    else
      append(fmt::format("{}", number + T{}));  // −0.0 + 0.0 = 0.0
  }
  template <class T>
  void add(const std::optional<T>& value) {
    if (value)
      add(*value);
    else
      append("");
  }
  void end_row();

  const std::string& text() const { return text_; }

 private:
  void append(std::string_view cell);

  std::string text_;
  std::string comments_;  ///< for below the first row
  bool is_row_begun_ = false;
};

}  // namespace ciliaval::compare::output
