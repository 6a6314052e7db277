// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <chrono>
#include <mutex>
#include <string>

#include "problem/mechanics_model.h"

namespace ciliaval::compare::app {

/// One line of stderr that is written over and over, if stderr is a terminal; nothing in the first
/// two seconds. It must outlive its callback.
class ProgressLine {
 public:
  ProgressLine() = default;
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// Empty unless stderr is a terminal. Several threads may call it.
  Progress callback();
  /// Takes the line off the terminal.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;
  void show(const std::string& text);

  Clock::time_point start_ = Clock::now();
  Clock::time_point last_ = start_;
  bool shown_ = false;
  std::mutex mutex_;
};

/// Writes to stdout, which is the result: throws FileError if it cannot be written. Control
/// characters from users' files are shown, not obeyed.
void print(const std::string& text);

/// Writes "ciliaval: TEXT" and a line break to stderr, likewise.
void warn(const std::string& text);

}  // namespace ciliaval::compare::app
