// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <chrono>
#include <cstddef>
#include <mutex>
#include <string>

#include "problem/mechanics_model.h"

namespace ciliaval::compare::app {

/// Progress on stderr: nothing in the first two seconds, and nothing at all after
/// silence_progress(). A terminal shows one line that is written over and over, with the share of
/// what is under way, the time since the start and the time to go, and leaves a line behind for
/// each step of a model that is done. Elsewhere each step, or other part of the work, gives a line.
/// There is at most one such line a second. It must outlive its callback.
class ProgressLine {
 public:
  ProgressLine() = default;
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// Empty after silence_progress(). Several threads may call it.
  Progress callback();
  /// Takes the line off the terminal.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;
  /// Equal parts of work under way, such as a model's path.
  struct Work {
    Clock::time_point start;
    std::size_t done_before = 0;  ///< by an earlier run
    std::size_t done = 0;
    std::size_t parts = 0;  ///< 0: not known
  };
  void show(const ProgressReport& report);
  void follow(const ProgressReport& report, Clock::time_point now);
  /// "50 %, 12 s, about 13 s to go"
  std::string times(Clock::time_point now) const;

  Clock::time_point start_ = Clock::now();
  Clock::time_point last_ = start_;       ///< the line of the terminal was written
  Clock::time_point last_line_ = start_;  ///< a line was left behind
  Work work_;
  bool shown_ = false;
  std::mutex mutex_;
};

/// No progress from now on.
void silence_progress();
bool shows_progress();

/// True if text for this stream is coloured: the stream is a terminal and the environment's
/// NO_COLOR is empty or not set (https://no-color.org).
bool has_colours(int stream);

/// "12 s", "3 min 20 s", "2 h 5 min".
std::string duration_text(double seconds);

/// Columns of the terminal that stdout is; 0: it is none.
std::size_t terminal_columns();

/// Writes to stdout, which is the result: throws FileError if it cannot be written. Control
/// characters from users' files are shown, not obeyed.
void print(const std::string& text);

/// "ciliaval: ", red on a terminal with colours, to go before a message on stderr.
std::string message_prefix();

/// Writes "ciliaval: TEXT" and a line break to stderr, likewise.
void warn(const std::string& text);

}  // namespace ciliaval::compare::app
