// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace ciliaval::compare::report {

/// Text as it stands between tags and in attributes in double quotes: nothing in it is markup.
/// Bytes that are not UTF-8 become U+FFFD, control characters but line breaks and tabs blanks.
std::string escaped(std::string_view text);

/// A text as a part of an id: ASCII letters and digits, anything else a hyphen.
std::string identifier(std::string_view text);

/// A cell of a table.
struct Cell {
  Cell(std::string words) : text(std::move(words)) {}  // NOLINT(google-explicit-constructor)
  Cell(const char* words) : text(words) {}             // NOLINT(google-explicit-constructor)
  Cell(std::string words, std::string its_style)
      : text(std::move(words)), style(std::move(its_style)) {}

  std::string text;
  std::string style;     ///< class of compare/report/style.h, or none
  std::string link;      ///< id in the page, or none
  std::size_t rows = 1;  ///< it spans this one and those below, which then have a cell less
};

/// A table; the first cell of a row is the row's name.
struct Table {
  std::string caption;
  std::vector<std::string> head;
  std::vector<std::vector<Cell>> rows;
};

/// The table in a box of its own, which scrolls where the page is too narrow and can be reached
/// with the keyboard. Empty without rows.
std::string html(const Table& table);

/// Elements around a text, which is escaped.
std::string heading(int level, std::string_view text);
std::string paragraph(std::string_view text, std::string_view style = "");
std::string list(const std::vector<std::string>& items);
/// Text as it is, line by line, in a box that scrolls.
std::string verbatim(std::string_view name, std::string_view text);
/// What is shown when its summary is opened; `content` is HTML. Empty without content.
std::string details(std::string_view summary, const std::string& content);

/// A part of the page with a line in its table of contents.
struct Section {
  std::string id;       ///< unique in the page
  std::string title;    ///< text
  std::string content;  ///< HTML
};

/// The whole file: head, a link past the table of contents, the table, the sections, the foot
/// (text). Nothing in it loads anything or runs: its Content-Security-Policy says so.
std::string page(std::string_view title, std::string_view introduction,
                 const std::vector<Section>& sections, std::string_view foot);

}  // namespace ciliaval::compare::report
