// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/report/figures.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <boost/archive/iterators/base64_from_binary.hpp>
#include <boost/archive/iterators/transform_width.hpp>
#include <string>

#include "compare/report/html.h"
#include "problem/error.h"

namespace ciliaval::compare::report {
namespace {

void replace_all(std::string& text, std::string_view what, std::string_view by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at)) {
    text.replace(at, what.size(), by);
    at += by.size();
  }
}

/// A tag of gnuplot's with the ids of this drawing. Throws FileError if it would load or run
/// something, which gnuplot's do not.
std::string own_tag(std::string tag, const std::string& id) {
  std::string rest = tag;
  replace_all(rest, "href='#", "");
  for (const char* active : {"href", "<script", "<image", "<foreignObject", "<style", " on"})
    if (rest.find(active) != std::string::npos)
      throw FileError(fmt::format("cannot plot: gnuplot wrote `{}` into the SVG", tag));
  replace_all(tag, " id='", " id='" + id + "-");
  replace_all(tag, " id=\"gnuplot_", " data-part=\"");  // repeated in a drawing of several panels
  replace_all(tag, "href='#", "href='#" + id + "-");
  replace_all(tag, "url(#", "url(#" + id + "-");
  replace_all(tag, "font-family=\"sans\"", "font-family=\"sans-serif\"");
  return tag;
}

std::string base64(std::string_view bytes) {
  using namespace boost::archive::iterators;
  using Encoded = base64_from_binary<transform_width<std::string_view::const_iterator, 6, 8>>;
  std::string text(Encoded(bytes.begin()), Encoded(bytes.end()));
  text.append((3 - bytes.size() % 3) % 3, '=');
  return text;
}

/// Around the id of a figure that is not drawn yet. No text of a result can be this: its `<` is
/// escaped. Nor has a page other comments.
constexpr std::string_view place_begin = "<!--";
constexpr std::string_view place_end = "-->\n";

}  // namespace

std::string inlined(std::string_view svg, const std::string& id, std::string_view title,
                    plot::Size size) {
  const std::size_t begin = svg.find("<g id=\"gnuplot_canvas\"");
  const std::size_t end = svg.rfind("</svg>");
  if (begin == std::string_view::npos || end == std::string_view::npos || end < begin)
    throw FileError("cannot plot: what gnuplot wrote is not the SVG that was expected");
  std::string text = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" id=\"{0}\" viewBox=\"0 0 {1} {2}\" role=\"img\" "
      "aria-labelledby=\"{0}-title\" style=\"max-width:{3:.0f}px\">\n<title "
      "id=\"{0}-title\">{4}</title>\n",
      id, size.width, size.height, 1.35 * size.width, escaped(title));
  std::size_t at = begin;
  while (at < end) {
    const std::size_t open = std::min(svg.find('<', at), end);
    text += svg.substr(at, open - at);
    const std::size_t close = open < end ? std::min(svg.find('>', open), end - 1) + 1 : end;
    text += own_tag(std::string(svg.substr(open, close - open)), id);
    at = close;
  }
  return text + "</svg>\n";
}

std::string Figures::next_id() {
  return fmt::format("figure-{}", ++count_);
}

std::string Figures::add(const Drawing& drawing) {
  if (drawing.script.empty()) return {};
  added_.push_back({next_id(), drawing});
  return fmt::format("{}{}{}", place_begin, added_.back().id, place_end);
}

std::string Figures::drawn(std::string_view page) {
  std::vector<plot::Script> scripts;
  for (const Added& added : added_) scripts.push_back({added.drawing.script, added.drawing.size});
  std::vector<std::string> svgs;
  try {
    if (!scripts.empty()) svgs = draw_(scripts);
  } catch (const FileError&) {
    svgs.clear();  // one after the other, then: each says what is wrong with it
  }
  std::string text;
  std::size_t begin = 0;
  while (true) {
    const std::size_t place = page.find(place_begin, begin);
    text += page.substr(begin, place - begin);
    if (place == std::string_view::npos) break;
    const std::size_t id = place + place_begin.size();
    const std::size_t end = page.find(place_end, id);
    const auto added = std::find_if(added_.begin(), added_.end(), [&](const Added& a) {
      return a.id == page.substr(id, end - id);
    });
    const auto i = static_cast<std::size_t>(added - added_.begin());
    text += html(added_.at(i), svgs.empty() ? nullptr : &svgs.at(i));
    begin = end + place_end.size();
  }
  added_.clear();
  return text;
}

std::string Figures::html(const Added& added, const std::string* svg) {
  const Drawing& drawing = added.drawing;
  try {
    const std::array<plot::Script, 1> alone{{{drawing.script, drawing.size}}};
    return fmt::format("<figure><div class=\"plot\">{}</div><figcaption>{}</figcaption></figure>\n",
                       inlined(svg != nullptr ? *svg : draw_(alone).front(), added.id,
                               drawing.title, drawing.size),
                       escaped(drawing.caption));
  } catch (const FileError& error) {
    if (failure_.empty()) failure_ = error.what();
    return paragraph(fmt::format("No figure \"{}\": {}", drawing.title, error.what()), "bad");
  }
}

std::string Figures::row(const std::vector<Drawing>& drawings, Width width) {
  std::string text;
  for (const Drawing& drawing : drawings) text += add(drawing);
  return text.empty() ? text
                      : fmt::format("<div class=\"figures{}\">\n{}</div>\n",
                                    width == Width::wide ? " wide" : "", text);
}

std::string Figures::picture(std::string_view png, plot::Size size, const std::string& title) {
  return fmt::format(
      "<figure><div class=\"plot\"><img id=\"{}\" width=\"{}\" height=\"{}\" alt=\"{}\" "
      "style=\"max-width:{}px\" src=\"data:image/png;base64,{}\"></div>"
      "<figcaption>{}</figcaption></figure>\n",
      next_id(), size.width, size.height, escaped(title), size.width, base64(png), escaped(title));
}

}  // namespace ciliaval::compare::report
