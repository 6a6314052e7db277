// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/app/terminal.h"

#include <fmt/core.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <utility>

#include "compare/output/table.h"
#include "problem/error.h"
#include "problem/support/words.h"

namespace ciliaval::compare::app {
namespace {

bool is_silent = false;

/// 0: no terminal.
std::size_t columns_of(int stream) {
  winsize size{};
  if (isatty(stream) == 0 || ioctl(stream, TIOCGWINSZ, &size) != 0) return 0;
  return size.ws_col;
}

/// The text without what is behind so many characters of UTF-8.
std::string_view first_characters(std::string_view text, std::size_t count) {
  std::size_t byte = 0;
  for (; byte < text.size(); ++byte) {
    const bool starts = (static_cast<unsigned char>(text[byte]) & 0xC0U) != 0x80U;
    if (starts && count-- == 0) break;
  }
  return text.substr(0, byte);
}

}  // namespace

ProgressLine::~ProgressLine() {
  clear();
}

void ProgressLine::clear() {
  const std::lock_guard lock(mutex_);
  if (!std::exchange(shown_, false)) return;
  fmt::print(stderr, "\r\033[K");
  std::fflush(stderr);
}

Progress ProgressLine::callback() {
  if (is_silent) return {};
  return [this](const ProgressReport& report) { show(report); };
}

void ProgressLine::follow(const ProgressReport& report, Clock::time_point now) {
  if (report.parts == 0) return;
  if (report.parts != work_.parts || report.done == 0)
    work_ = {work_.parts == 0 ? start_ : now, 0, 0, report.parts};
  // An earlier run did the parts that are skipped.
  if (report.done > work_.done + 1) work_.done_before += report.done - work_.done - 1;
  work_.done = std::max(work_.done, report.done);
}

std::string ProgressLine::times(Clock::time_point now) const {
  const auto seconds = [now](Clock::time_point since) {
    return std::chrono::duration<double>(now - since).count();
  };
  std::string text = duration_text(seconds(start_));
  if (work_.parts == 0) return text;
  text = fmt::format("{} %, {}", 100 * work_.done / work_.parts, text);
  const std::size_t here = work_.done - work_.done_before;
  if (here > 0 && work_.done < work_.parts)
    text +=
        fmt::format(", about {} to go",
                    duration_text(std::max(1.0, seconds(work_.start) *
                                                    static_cast<double>(work_.parts - work_.done) /
                                                    static_cast<double>(here))));
  return text;
}

void ProgressLine::show(const ProgressReport& report) {
  using namespace std::chrono_literals;
  const std::lock_guard lock(mutex_);
  const auto now = Clock::now();
  follow(report, now);
  if (now - start_ < 2s) return;
  const bool is_terminal = isatty(STDERR_FILENO) != 0;
  const bool leaves_a_line = is_terminal ? report.step != nullptr : report.done > 0;
  if (leaves_a_line && now - last_line_ >= 1s) {
    const std::string step = report.step == nullptr ? "" : ": " + output::describe(*report.step);
    fmt::print(stderr, "{}{}\n", is_terminal ? "\r\033[K" : "",
               support::printable(fmt::format("{}{} ({})", report.text, step, times(now)), ""));
    last_line_ = now;
    shown_ = false;
  } else if (is_terminal && now - last_ >= 100ms) {
    // A line that wraps could not be overwritten. The times stay.
    const std::string when = fmt::format(" ({})", times(now));
    const std::string text = support::printable(report.text, "");
    const std::size_t columns = columns_of(STDERR_FILENO);
    fmt::print(stderr, "\r\033[K{}{}",
               columns > when.size() ? first_characters(text, columns - 1 - when.size()) : text,
               when);
    last_ = now;
    shown_ = true;
  } else {
    return;
  }
  std::fflush(stderr);
}

void silence_progress() {
  is_silent = true;
}

bool shows_progress() {
  return !is_silent;
}

bool has_colours(int stream) {
  const char* no_colour = std::getenv("NO_COLOR");
  return isatty(stream) != 0 && (no_colour == nullptr || *no_colour == '\0');
}

std::string duration_text(double seconds) {
  const auto whole = static_cast<long>(std::lround(seconds));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {} s", whole / 60, whole % 60);
  return fmt::format("{} h {} min", whole / 3600, whole % 3600 / 60);
}

std::size_t terminal_columns() {
  return columns_of(STDOUT_FILENO);
}

void print(const std::string& text) {
  const std::string shown = support::printable(text);
  if (std::fwrite(shown.data(), 1, shown.size(), stdout) != shown.size() ||
      std::fflush(stdout) != 0)
    throw FileError(std::string("cannot write to the standard output: ") + std::strerror(errno));
}

std::string message_prefix() {
  return has_colours(STDERR_FILENO) ? "\033[31mciliaval:\033[0m " : "ciliaval: ";
}

void warn(const std::string& text) {
  fmt::print(stderr, "{}{}\n", message_prefix(), support::printable(text));
}

}  // namespace ciliaval::compare::app
