// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/study/journal.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <optional>
#include <utility>

#include "fem/checkpoint_file.h"
#include "problem/error.h"

namespace ciliaval::compare::study {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t checksum_length = 8;
constexpr auto flush_interval = 1s;

std::string line_of(std::string_view text) {
  return fmt::format("{:08x} {}\n", fem::checksum(text), text);
}

/// The text of a line without its end, if the checksum is right.
std::optional<std::string> text_of(std::string_view line) {
  if (line.size() <= checksum_length || line[checksum_length] != ' ') return std::nullopt;
  const std::string_view text = line.substr(checksum_length + 1);
  if (line.substr(0, checksum_length) != fmt::format("{:08x}", fem::checksum(text)))
    return std::nullopt;
  return std::string(text);
}

/// Flushes a folder, so that a new file in it is found after a power cut. A file system that cannot
/// is used without.
void flush_folder(const std::filesystem::path& folder) {
  const int descriptor = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  fsync(descriptor);
  close(descriptor);
}

}  // namespace

Journal::Journal(std::filesystem::path file, bool fresh) : file_(std::move(file)) {
  // Not blocking: a pipe of that name would wait for ever.
  descriptor_ = open(file_.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC | O_NONBLOCK, 0666);
  if (descriptor_ < 0) fail("cannot open", errno);
  try {
    lock();
    if (fresh) cut(0);
    read();
    flush_folder(file_.parent_path());
  } catch (...) {
    close(descriptor_);
    throw;
  }
}

Journal::~Journal() {
  close(descriptor_);
}

void Journal::fail(std::string_view doing, int error) const {
  throw FileError(
      fmt::format("{} the journal `{}`: {}", doing, file_.string(), std::strerror(error)));
}

void Journal::lock() {
  struct stat status {};
  if (fstat(descriptor_, &status) != 0) fail("cannot open", errno);
  if (!S_ISREG(status.st_mode))
    throw FileError(
        fmt::format("cannot use `{}` as a journal: it is not a regular file", file_.string()));
  // A file system without locks is used without.
  if (flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
    throw FileError(
        fmt::format("another process is running this study: it writes to `{}`. Wait "
                    "until it has ended, or choose another folder with -o DIR",
                    file_.string()));
}

void Journal::cut(std::size_t length) {
  if (ftruncate(descriptor_, static_cast<off_t>(length)) != 0) fail("cannot shorten", errno);
  length_ = length;
}

void Journal::read() {
  std::string bytes;
  std::array<char, 65536> part{};
  while (const ssize_t n =
             pread(descriptor_, part.data(), part.size(), static_cast<off_t>(bytes.size()))) {
    if (n < 0 && errno != EINTR) fail("cannot read", errno);
    if (n > 0) bytes.append(part.data(), static_cast<std::size_t>(n));
  }
  length_ = bytes.size();
  const std::size_t end = bytes.rfind('\n') + 1;  // 0 if there is no whole line
  if (end < bytes.size()) ++damaged_;
  bool first = true;
  for (std::size_t from = 0; from < end;) {
    const std::size_t to = bytes.find('\n', from);
    const auto text = text_of(std::string_view(bytes).substr(from, to - from));
    from = to + 1;
    if (first && !text)
      throw FileError(
          fmt::format("`{}` is no journal of a study, or its first line is damaged; "
                      "start anew with --fresh, which empties it",
                      file_.string()));
    if (first)
      header_ = *text;
    else if (text)
      records_.push_back(*text);
    else
      ++damaged_;
    first = false;
  }
  // Last, so that a file that is no journal is left as it is.
  if (end < bytes.size()) cut(end);
}

void Journal::append(std::string_view text) {
  const std::string line = line_of(text);
  const std::lock_guard guard(mutex_);
  std::size_t written = 0;
  while (written < line.size()) {
    const ssize_t n = write(descriptor_, line.data() + written, line.size() - written);
    if (n >= 0) {
      written += static_cast<std::size_t>(n);
      continue;
    }
    if (errno == EINTR) continue;
    const int error = errno;
    // A part of the line would be dropped when the journal is read; better not to leave it.
    if (ftruncate(descriptor_, static_cast<off_t>(length_)) != 0) fail("cannot shorten", errno);
    fail("cannot write to", error);
  }
  length_ += line.size();
  const auto now = Clock::now();
  if (now - flushed_ < flush_interval) return;
  if (fdatasync(descriptor_) != 0) fail("cannot flush", errno);
  flushed_ = Clock::now();
}

void Journal::flush() {
  const std::lock_guard guard(mutex_);
  if (fdatasync(descriptor_) != 0) fail("cannot flush", errno);
  flushed_ = Clock::now();
}

}  // namespace ciliaval::compare::study
