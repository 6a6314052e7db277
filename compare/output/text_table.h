// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace ciliaval::compare::output {

using TextRows = std::vector<std::vector<std::string>>;

/// Rows of cells for a terminal, the columns as wide as their widest cell. `alignment` has `<` or
/// `>` for each column; its last one stands for all further columns. Rows may be shorter.
std::string text_table(const TextRows& rows, std::string_view alignment = ">");

/// A number in a unit by a format such as "{:.4f}", or a dash for an undefined one. A number that
/// rounds to zero has no sign.
std::string number_cell(std::optional<double> value, double unit, std::string_view format);

}  // namespace ciliaval::compare::output
