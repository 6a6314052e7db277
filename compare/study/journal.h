// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

namespace ciliaval::compare::study {

/// A file to which lines are added, each of them durable by itself: it begins with the CRC-32 of
/// its text, so that one that a kill or a power cut has torn is known and left out. The first line
/// says what the journal is of.
///
/// A line is handed to the system by one write(): nothing that append() has returned from is lost
/// if the process is killed. Against a power cut the file is flushed to the disk where a second has
/// passed since the last time, so that at most the work of a second is lost; a flush for each line
/// would take as long as a point of the analytic models (docs/guide/studies.md).
class Journal {
 public:
  /// Opens the file, for this process alone, or makes it; `fresh` empties it first. Throws
  /// FileError if that cannot be done, if another process has it, or if it is no journal.
  explicit Journal(std::filesystem::path file, bool fresh = false);
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  /// The first line; empty if the journal is new.
  const std::string& header() const { return header_; }
  /// The undamaged lines after it that were there when it was opened.
  const std::vector<std::string>& records() const { return records_; }
  /// How many lines were damaged, a torn last one included.
  std::size_t damaged() const { return damaged_; }

  /// Adds a line, the first one to a new journal as its header; by any thread. The text has no line
  /// break. Throws FileError, and the line is then not there.
  void append(std::string_view text);
  /// Flushes what was appended to the disk. Throws FileError.
  void flush();

 private:
  void lock();
  void read();
  void cut(std::size_t length);
  [[noreturn]] void fail(std::string_view doing, int error) const;

  using Clock = std::chrono::steady_clock;
  std::filesystem::path file_;
  int descriptor_ = -1;
  std::string header_;
  std::vector<std::string> records_;
  std::size_t damaged_ = 0;
  std::size_t length_ = 0;  ///< of the file, bytes
  Clock::time_point flushed_ = Clock::now();
  std::mutex mutex_;
};

}  // namespace ciliaval::compare::study
