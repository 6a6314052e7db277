// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace ciliaval::compare::output {

using TextRows = std::vector<std::vector<std::string>>;

/// Width of a terminal's line, in which text_table() fits its rows; 0, as at first: no limit.
void set_line_width(std::size_t columns);

/// Rows of cells for a terminal, the columns as wide as their widest cell. `alignment` has `<` or
/// `>` for each column; its last one stands for all further columns. Rows may be shorter.
/// If the line is too short, the further columns follow below, each time after the first one.
std::string text_table(const TextRows& rows, std::string_view alignment = ">");

/// A number in a unit by a format such as "{:.4f}", or a dash for one that is undefined or not
/// finite. A number that rounds to zero has no sign.
std::string number_cell(std::optional<double> value, double unit, std::string_view format);

/// The text in lines of at most 78 bytes, broken at blanks; the second and later ones are indented.
std::string wrapped(const std::string& text, std::string_view indent);

/// A unit that people read: an SI value is divided by `size`.
struct ShownUnit {
  std::string name;  ///< "uT", "uT/mN"
  double size = 1;
};
/// "mm" for "m"; a unit without a handier one is itself.
ShownUnit shown_unit(std::string_view si);

}  // namespace ciliaval::compare::output
