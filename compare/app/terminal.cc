// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/app/terminal.h"

#include <fmt/core.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <mutex>

#include "problem/error.h"

namespace ciliaval::compare {

ProgressLine::~ProgressLine() {
  if (shown_) fmt::print(stderr, "\r\033[K");
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
  fmt::print(stderr, "\r\033[K{}", text);
  std::fflush(stderr);
  last_ = now;
  shown_ = true;
}

void print(const std::string& text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
    throw FileError(std::string("cannot write to the standard output: ") + std::strerror(errno));
}

}  // namespace ciliaval::compare
