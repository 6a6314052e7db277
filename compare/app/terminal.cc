// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/app/terminal.h"

#include <fmt/core.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <mutex>
#include <utility>

#include "problem/error.h"
#include "problem/support/words.h"

namespace ciliaval::compare::app {

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
  if (isatty(STDERR_FILENO) == 0) return {};
  return [this](const std::string& text) { show(text); };
}

void ProgressLine::show(const std::string& text) {
  using namespace std::chrono_literals;
  const std::lock_guard lock(mutex_);
  const auto now = Clock::now();
  if (now - start_ < 2s || now - last_ < 100ms) return;
  fmt::print(stderr, "\r\033[K{}", support::printable(text, ""));
  std::fflush(stderr);
  last_ = now;
  shown_ = true;
}

void print(const std::string& text) {
  const std::string shown = support::printable(text);
  if (std::fwrite(shown.data(), 1, shown.size(), stdout) != shown.size() ||
      std::fflush(stdout) != 0)
    throw FileError(std::string("cannot write to the standard output: ") + std::strerror(errno));
}

void warn(const std::string& text) {
  fmt::print(stderr, "ciliaval: {}\n", support::printable(text));
}

}  // namespace ciliaval::compare::app
