// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <fmt/format.h>

#include <concepts>
#include <optional>
#include <string>
#include <string_view>

#include "problem/types.h"

namespace ciliaval::compare::output {

/// The text of a CSV file (RFC 4180), whose first line names the columns. Numbers have the digits
/// that give them back, a zero has no sign, an undefined value is an empty cell. A text that a
/// spreadsheet would take for a formula gets an apostrophe in front; control characters and bytes
/// that are no UTF-8 are shown as `\x1B`.
class CsvWriter {
 public:
  /// The name of the next column. The units, "x m, y m", go to a line that readers skip, below the
  /// names: NumPy takes these from the first line, whatever it is.
  void column(std::string_view name, std::string_view unit = {});
  /// Three of them, the names with x, y, z behind.
  void vector_columns(std::string_view name, std::string_view unit);

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
  /// The cells of a vector's three columns.
  void add(const std::optional<Vector3>& v);
  void end_row();

  const std::string& text() const { return text_; }

 private:
  void append(std::string_view cell);

  std::string text_;
  std::string units_;  ///< for the line below the names
  bool is_row_begun_ = false;
};

}  // namespace ciliaval::compare::output
