// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/plot/gnuplot.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <sstream>
#include <utility>
#include <vector>

#include "compare/output/output_file.h"
#include "problem/error.h"
#include "problem/support/child_process.h"

namespace ciliaval::compare::plot {
namespace {

/// A file's text; empty where there is none.
std::string content(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

/// The first of gnuplot's complaints, which begins after the copy of the line and a caret.
std::string complaint(const std::string& text) {
  const std::size_t line = text.find("line ");
  const std::string message = line == std::string::npos ? text : text.substr(line);
  return message.substr(0, message.find('\n'));
}

void require_success(const support::ChildEnd& end, const std::filesystem::path& log) {
  if (end.how == support::ChildEnd::How::not_found)
    throw FileError(
        "cannot plot: there is no gnuplot; install it (apt-get install gnuplot-nox) and run the "
        "command again");
  if (end.how == support::ChildEnd::How::timed_out)
    throw FileError(fmt::format(
        "cannot plot: gnuplot {}; see that the gnuplot in PATH draws, or leave out --plot",
        end.text()));
  if (!end.succeeded())
    throw FileError(
        fmt::format("cannot plot: gnuplot {}: {}", end.text(), complaint(content(log))));
}

}  // namespace

std::string quoted(std::string_view text) {
  // In double quotes: gnuplot 5.4 misreads apostrophes in single ones. There a backslash is two.
  std::string result = "\"";
  for (const char c : text) {
    if (std::string_view("\\^_@&~{}").find(c) != std::string_view::npos) result += "\\\\";
    if (c == '`')
      result += "\\140";  // what it encloses would be run
    else if (c == '\\' || c == '"')
      result += {'\\', c};
    else
      result += c == '\n' || c == '\r' ? ' ' : c;
  }
  return result + '"';
}

std::string logarithmic_x_axis(double from, double to) {
  std::string script = fmt::format("set xrange [{}:{}]\nset logscale x\n", from, to);
  constexpr double short_axis = 1000;
  if (to > short_axis * from) return script;
  std::vector<std::string> marks;
  const int first = static_cast<int>(std::floor(std::log10(from)));
  const int last = static_cast<int>(std::floor(std::log10(1.001 * to)));
  for (int decade = first; decade <= last; ++decade)
    for (const double digit : {1, 2, 5})
      if (const double mark = digit * std::pow(10, decade);
          mark >= 0.999 * from && mark <= 1.001 * to)
        marks.push_back(fmt::format("{:.6g}", mark));
  return script + fmt::format("set xtics ({})\n", fmt::join(marks, ", "));
}

std::vector<std::string> draw_svgs(std::span<const Script> scripts, double time_limit) {
  const support::SignalPause pause;  // the folder is removed before a signal ends the program
  const support::WorkFolder folder;
  const auto drawing = [&](std::size_t i) { return folder.path() / fmt::format("{}.svg", i); };
  const std::filesystem::path input = folder.path() / "script";
  std::ofstream out(input);
  for (std::size_t i = 0; i < scripts.size(); ++i)
    out << fmt::format(
        "reset session\nset encoding utf8\n"
        "set terminal svg size {},{} font 'sans,12' background 'white'\nset output '{}.svg'\n{}\n"
        "set output\n",
        scripts[i].size.width, scripts[i].size.height, i, scripts[i].text);
  out.close();
  if (!out) throw FileError(fmt::format("cannot write `{}`: is the disk full?", input.string()));
  const std::filesystem::path log = folder.path() / "log";
  // -d: not the user's ~/.gnuplot.
  require_success(
      support::run_child({"gnuplot", {"-d", "script"}, folder.path(), log, time_limit, {}}), log);
  std::vector<std::string> drawings;
  for (std::size_t i = 0; i < scripts.size(); ++i) {
    std::string document = content(drawing(i));  // ends with an empty line
    document.erase(std::min(document.size(), document.find_last_not_of('\n') + 2));
    drawings.push_back(std::move(document));
    if (!drawings.back().ends_with("</svg>\n"))
      throw FileError("cannot plot: a script draws nothing, or the disk is full: " +
                      complaint(content(log)));
  }
  return drawings;
}

std::string draw_svg(std::string_view script, Size size) {
  const std::array<Script, 1> one{{{std::string(script), size}}};
  return std::move(draw_svgs(one).front());
}

void write_svg(const std::filesystem::path& file, std::string_view script, Size size) {
  output::write_file(file, draw_svg(script, size));
}

}  // namespace ciliaval::compare::plot
