// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/plot/gnuplot.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <fmt/ranges.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>
#include <utility>
#include <vector>

#include "compare/output/results.h"
#include "problem/error.h"

namespace ciliaval::compare::plot {
namespace {

struct Close {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
/// Without a name: gone when it is closed.
using File = std::unique_ptr<std::FILE, Close>;

File temporary_file() {
  File file(std::tmpfile());
  if (!file)
    throw FileError(
        fmt::format("cannot make a temporary file for gnuplot: {}", std::strerror(errno)));
  return file;
}

std::string content(std::FILE* file) {
  std::string text;
  std::array<char, 65536> part{};
  std::rewind(file);
  while (const std::size_t n = std::fread(part.data(), 1, part.size(), file))
    text.append(part.data(), n);
  return text;
}

/// The first of gnuplot's complaints, which begins after the copy of the line and a caret.
std::string complaint(const std::string& text) {
  const std::size_t line = text.find("line ");
  const std::string message = line == std::string::npos ? text : text.substr(line);
  return message.substr(0, message.find('\n'));
}

/// gnuplot with the three files as its standard streams; its exit code. Files, not pipes: none of
/// the two has to read while the other one writes.
int run_gnuplot(std::FILE* in, std::FILE* out, std::FILE* err) {
  posix_spawn_file_actions_t streams;
  posix_spawn_file_actions_init(&streams);
  posix_spawn_file_actions_adddup2(&streams, fileno(in), STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&streams, fileno(out), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&streams, fileno(err), STDERR_FILENO);
  std::string program = "gnuplot";
  std::string defaults = "-d";  // not the user's ~/.gnuplot
  // By its name: standard input itself gnuplot reads byte by byte, which takes most of its time.
  std::string input = "/dev/stdin";
  const std::array<char*, 4> arguments{program.data(), defaults.data(), input.data(), nullptr};
  pid_t process = 0;
  const int error =
      posix_spawnp(&process, program.c_str(), &streams, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&streams);
  if (error == ENOENT)
    throw FileError(
        "cannot plot: there is no gnuplot; install it (apt-get install gnuplot-nox) and run the "
        "command again");
  if (error != 0)
    throw FileError(fmt::format("cannot plot: gnuplot does not start: {}", std::strerror(error)));
  int status = 0;
  while (waitpid(process, &status, 0) < 0)
    if (errno != EINTR)
      throw FileError(fmt::format("cannot plot: gnuplot is lost: {}", std::strerror(errno)));
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/// The complete SVG documents in what gnuplot wrote one after the other.
std::vector<std::string> documents(std::string_view text) {
  constexpr std::string_view head = "<?xml";
  constexpr std::string_view tail = "</svg>\n";
  std::vector<std::string> result;
  for (std::size_t begin = text.find(head); begin != std::string_view::npos;) {
    const std::size_t next = text.find(head, begin + head.size());
    std::string_view document = text.substr(begin, next - begin);
    document = document.substr(0, document.find_last_not_of('\n') + 2);
    if (document.ends_with(tail)) result.emplace_back(document);
    begin = next;
  }
  return result;
}

}  // namespace

std::string quoted(std::string_view text) {
  std::string result = "'";
  for (const char c : text) {
    if (std::string_view("\\^_@&~{}").find(c) != std::string_view::npos) result += '\\';
    if (c == '\'') result += '\'';
    result += c == '\n' || c == '\r' ? ' ' : c;
  }
  return result + '\'';
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

std::vector<std::string> draw_svgs(std::span<const Script> scripts) {
  const File in = temporary_file();
  const File out = temporary_file();
  const File err = temporary_file();
  std::string input;
  for (const Script& script : scripts)
    input += fmt::format(
        "reset session\nset encoding utf8\n"
        "set terminal svg size {},{} font 'sans,12' background 'white'\n{}\n",
        script.size.width, script.size.height, script.text);
  if (std::fwrite(input.data(), 1, input.size(), in.get()) != input.size() ||
      std::fflush(in.get()) != 0)
    throw FileError(fmt::format("cannot write a script for gnuplot: {}", std::strerror(errno)));
  std::rewind(in.get());
  const int code = run_gnuplot(in.get(), out.get(), err.get());
  std::vector<std::string> drawings = documents(content(out.get()));
  if (code != 0 || drawings.size() != scripts.size())
    throw FileError(
        fmt::format("cannot plot: gnuplot ended with {}: {}", code, complaint(content(err.get()))));
  return drawings;
}

std::string draw_svg(std::string_view script, Size size) {
  const std::array<Script, 1> one{{{std::string(script), size}}};
  return std::move(draw_svgs(one).front());
}

void write_svg(const std::filesystem::path& file, std::string_view script, Size size) {
  replace_text(file, draw_svg(script, size));
}

}  // namespace ciliaval::compare::plot
