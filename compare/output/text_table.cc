// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/output/text_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

#include "problem/support/words.h"

namespace ciliaval::compare::output {
namespace {

/// Characters of a text in UTF-8: bytes 10xxxxxx continue one.
std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0) != 0x80;
  }));
}

std::size_t line_width = 0;

/// The columns of each block: the first one, and as many others as fit into a line.
std::vector<std::vector<std::size_t>> blocks_of(const std::vector<std::size_t>& widths) {
  constexpr std::size_t gap = 2;
  if (widths.empty()) return {};
  std::vector<std::vector<std::size_t>> blocks{{0}};
  std::size_t used = gap + widths.front();
  for (std::size_t i = 1; i < widths.size(); ++i) {
    const std::size_t needed = gap + widths[i];
    if (line_width > 0 && used + needed > line_width && blocks.back().size() > 1) {
      blocks.push_back({0});
      used = gap + widths.front();
    }
    blocks.back().push_back(i);
    used += needed;
  }
  return blocks;
}

}  // namespace

void set_line_width(std::size_t columns) {
  line_width = columns;
}

std::string text_table(const TextRows& rows, std::string_view alignment) {
  TextRows cells = rows;
  std::vector<std::size_t> widths;
  for (std::vector<std::string>& row : cells) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t i = 0; i < row.size(); ++i) {
      row[i] = support::printable(row[i], "");
      widths[i] = std::max(widths[i], width_of(row[i]));
    }
  }
  std::string text;
  for (const std::vector<std::size_t>& columns : blocks_of(widths))
    for (const std::vector<std::string>& row : cells) {
      for (const std::size_t i : columns) {
        if (i >= row.size()) break;
        const std::string padding(widths[i] - width_of(row[i]), ' ');
        const bool is_left = alignment[std::min(i, alignment.size() - 1)] == '<';
        text += "  " + (is_left ? row[i] + padding : padding + row[i]);
      }
      text.erase(text.find_last_not_of(' ') + 1);
      text += '\n';
    }
  return text;
}

std::string number_cell(std::optional<double> value, double unit, std::string_view format) {
  if (!value || !std::isfinite(*value)) return "-";
  const std::string text = fmt::format(fmt::runtime(format), *value / unit);
  const bool is_zero = text.find_first_not_of("-0.") == std::string::npos;
  return is_zero && text.starts_with('-') ? text.substr(1) : text;
}

ShownUnit shown_unit(std::string_view si) {
  if (si == "m") return {"mm", 1e-3};
  if (si == "N") return {"mN", 1e-3};
  if (si == "rad") return {"deg", std::numbers::pi / 180};
  if (si == "T") return {"uT", 1e-6};
  if (const std::size_t slash = si.find('/'); slash != si.npos && si.starts_with("T/")) {
    const ShownUnit above = shown_unit(si.substr(0, slash));
    const ShownUnit below = shown_unit(si.substr(slash + 1));
    return {fmt::format("{}/{}", above.name, below.name), above.size / below.size};
  }
  return {std::string(si), 1};
}

std::string wrapped(const std::string& text, std::string_view indent) {
  constexpr std::size_t width = 78;  // two may stand before the first line
  std::string result;
  std::string line;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    if (!line.empty() && line.size() + 1 + word.size() > width) {
      result += line + '\n';
      line = std::string(indent) + word;
    } else {
      line += (line.empty() ? "" : " ") + word;
    }
  }
  return result + line + '\n';
}

}  // namespace ciliaval::compare::output
