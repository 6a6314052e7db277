// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/report/html.h"

#include <fmt/core.h>

#include <nlohmann/json.hpp>
#include <string>

#include "compare/report/style.h"

namespace ciliaval::compare::report {
namespace {

using Json = nlohmann::json;

/// The text with U+FFFD in place of what is not UTF-8.
std::string valid_utf8(std::string_view text) {
  const std::string dumped = Json(text).dump(-1, ' ', false, Json::error_handler_t::replace);
  return Json::parse(dumped).get<std::string>();
}

std::string attribute(std::string_view name, std::string_view value) {
  return value.empty() ? std::string() : fmt::format(" {}=\"{}\"", name, escaped(value));
}

std::string html(const Cell& cell, bool names_the_row) {
  const std::string text = cell.link.empty() ? escaped(cell.text)
                                             : fmt::format("<a href=\"#{}\">{}</a>",
                                                           escaped(cell.link), escaped(cell.text));
  std::string attributes = attribute("class", cell.style);
  if (cell.rows > 1) attributes += fmt::format(" rowspan=\"{}\"", cell.rows);
  if (!names_the_row) return fmt::format("<td{}>{}</td>", attributes, text);
  return fmt::format("<th scope=\"{}\"{}>{}</th>", cell.rows > 1 ? "rowgroup" : "row", attributes,
                     text);
}

/// A box that scrolls and can be reached with the keyboard.
std::string scrolling(std::string_view name, const std::string& content) {
  return fmt::format(
      "<div class=\"scroll\" role=\"region\" tabindex=\"0\" aria-label=\"{}\">{}</div>\n",
      escaped(name), content);
}

}  // namespace

std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : valid_utf8(text)) switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      case '\'':
        result += "&#39;";
        break;
      default: {
        const auto byte = static_cast<unsigned char>(c);
        const bool control = (byte < 0x20 && c != '\n' && c != '\t') || byte == 0x7f;
        result += control ? ' ' : c;
      }
    }
  return result;
}

std::string identifier(std::string_view text) {
  std::string result;
  for (const char c : text) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    result += plain ? c : '-';
  }
  return result;
}

std::string html(const Table& table) {
  if (table.rows.empty()) return {};
  std::string text = fmt::format("<table><caption>{}</caption>\n", escaped(table.caption));
  if (!table.head.empty()) {
    text += "<thead><tr>";
    for (std::size_t i = 0; i < table.head.size(); ++i)  // aligned as what is below
      text += fmt::format(
          "<th scope=\"col\"{}>{}</th>",
          attribute("class", i < table.rows[0].size() ? table.rows[0][i].style : std::string()),
          escaped(table.head[i]));
    text += "</tr></thead>\n";
  }
  text += "<tbody>\n";
  for (const std::vector<Cell>& row : table.rows) {
    text += "<tr>";
    for (const Cell& cell : row) text += html(cell, &cell == &row.front());
    text += "</tr>\n";
  }
  return scrolling(table.caption, text + "</tbody></table>");
}

std::string heading(int level, std::string_view text) {
  return fmt::format("<h{0}>{1}</h{0}>\n", level, escaped(text));
}

std::string paragraph(std::string_view text, std::string_view style) {
  return fmt::format("<p{}>{}</p>\n", attribute("class", style), escaped(text));
}

std::string list(const std::vector<std::string>& items) {
  if (items.empty()) return {};
  std::string text = "<ul>\n";
  for (const std::string& item : items) text += fmt::format("<li>{}</li>\n", escaped(item));
  return text + "</ul>\n";
}

std::string verbatim(std::string_view name, std::string_view text) {
  return fmt::format("<pre tabindex=\"0\" aria-label=\"{}\">{}</pre>\n", escaped(name),
                     escaped(text));
}

std::string details(std::string_view summary, const std::string& content) {
  if (content.empty()) return {};
  return fmt::format("<details><summary>{}</summary>\n{}</details>\n", escaped(summary), content);
}

std::string page(std::string_view title, std::string_view introduction,
                 const std::vector<Section>& sections, std::string_view foot) {
  std::string text = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src "
      "'unsafe-inline'; img-src data:\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<link rel=\"icon\" href=\"data:,\">\n"
      "<title>{0}</title>\n<style>{1}</style>\n</head>\n<body>\n"
      "<a class=\"skip\" href=\"#main\">Skip the contents</a>\n"
      "<header><h1>{0}</h1>\n{2}</header>\n",
      escaped(title), style_sheet, introduction.empty() ? "" : paragraph(introduction));
  if (sections.size() > 1) {
    text += "<nav aria-label=\"Contents\"><ul>\n";
    for (const Section& section : sections)
      text += fmt::format("<li><a href=\"#{}\">{}</a></li>\n", escaped(section.id),
                          escaped(section.title));
    text += "</ul></nav>\n";
  }
  text += "<main id=\"main\" tabindex=\"-1\">\n";
  for (const Section& section : sections)
    text += fmt::format(
        "<section id=\"{0}\" aria-labelledby=\"{0}-title\">\n"
        "<h2 id=\"{0}-title\">{1}</h2>\n{2}</section>\n",
        escaped(section.id), escaped(section.title), section.content);
  return text + fmt::format("</main>\n<footer>{}</footer>\n</body>\n</html>\n", paragraph(foot));
}

}  // namespace ciliaval::compare::report
