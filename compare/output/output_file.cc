// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/output/output_file.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <regex>
#include <string>
#include <system_error>
#include <utility>

#include "problem/error.h"

namespace ciliaval::compare::output {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& file, int error) {
  throw FileError(fmt::format("cannot write `{}`: {}", file.string(), std::strerror(error)));
}

/// A file descriptor, closed at the end of its life.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int number() const { return number_; }
  int close() { return ::close(std::exchange(number_, -1)); }

 private:
  int number_;
};

void write_all(Descriptor& out, std::string_view text, const fs::path& file) {
  while (!text.empty()) {
    const ssize_t count = ::write(out.number(), text.data(), text.size());
    if (count < 0 && errno != EINTR) fail(file, errno);
    if (count > 0) text.remove_prefix(static_cast<std::size_t>(count));
  }
  if (out.close() != 0) fail(file, errno);
}

/// The standard output or error if the file is one of them: a second opening of a regular file
/// would overwrite what the program prints.
std::optional<int> standard_stream(const fs::path& file) {
  struct stat status {};
  if (stat(file.c_str(), &status) != 0) return std::nullopt;
  for (const int stream : {STDOUT_FILENO, STDERR_FILENO}) {
    struct stat own {};
    if (fstat(stream, &own) == 0 && own.st_dev == status.st_dev && own.st_ino == status.st_ino)
      return stream;
  }
  return std::nullopt;
}

/// True if the file exists and is neither regular nor a folder: a device, a FIFO, a socket.
bool is_special(const fs::path& file) {
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

/// The regular file that a link, or a chain of links, leads to, whether it is there or not.
fs::path behind_links(fs::path file) {
  for (int i = 0; i < 40 && fs::is_symlink(fs::symlink_status(file)); ++i)
    file = file.parent_path() / fs::read_symlink(file);
  return file;
}

/// A new empty file beside `target` with its extension, and open; never one that was there.
fs::path make_temporary(const fs::path& target, const fs::path& file, int& descriptor) {
  for (int i = 0;; ++i) {
    fs::path name = target.parent_path() / fmt::format(".{}.{}.{}.tmp{}", target.stem().string(),
                                                       getpid(), i, target.extension().string());
    descriptor = open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor >= 0) return name;
    if (errno != EEXIST) fail(file, errno);
  }
}

/// Gives `write` a temporary name and its descriptor, then puts that file in the target's place.
void replace(const fs::path& file,
             const std::function<void(const fs::path& temporary, Descriptor&)>& write) {
  const fs::path target = behind_links(file);
  std::error_code error;
  if (fs::is_directory(target, error)) fail(file, EISDIR);
  int number = -1;
  const fs::path temporary = make_temporary(target, file, number);
  try {
    Descriptor out(number);
    write(temporary, out);
    if (fs::exists(target)) fs::permissions(temporary, fs::status(target).permissions());
    if (::rename(temporary.c_str(), target.c_str()) != 0) fail(file, errno);
  } catch (...) {
    fs::remove(temporary, error);
    throw;
  }
}

}  // namespace

void write_file(const fs::path& file, std::string_view text) {
  if (const auto stream = standard_stream(file)) {
    Descriptor out(fcntl(*stream, F_DUPFD_CLOEXEC, 0));
    return write_all(out, text, file);
  }
  if (is_special(file)) {
    Descriptor out(open(file.c_str(), O_WRONLY | O_CLOEXEC));
    if (out.number() < 0) fail(file, errno);
    return write_all(out, text, file);
  }
  replace(file, [&](const fs::path&, Descriptor& out) { write_all(out, text, file); });
}

void write_file(const fs::path& file, const std::function<void(const fs::path&)>& write) {
  if (is_special(file))
    throw FileError(fmt::format("cannot write `{}`: it is no regular file", file.string()));
  replace(file, [&](const fs::path& temporary, Descriptor&) { write(temporary); });
}

void remove_unfinished(const fs::path& folder) {
  // Names by make_temporary() and python/ciliaval/files.py: .study.4711.0.tmp.csv
  static const std::regex name(R"(\..+\.[0-9]+\.[0-9]+\.tmp\.[a-z]+)");
  std::error_code error;  // what cannot be taken away disturbs nobody
  for (fs::directory_iterator file(folder, error), end; file != end; file.increment(error))
    if (std::regex_match(file->path().filename().string(), name)) fs::remove(*file, error);
}

void check_outputs(std::initializer_list<std::optional<fs::path>> outputs,
                   const std::vector<fs::path>& inputs) {
  std::vector<fs::path> regular;
  for (const std::optional<fs::path>& output : outputs) {
    if (!output) continue;
    std::error_code error;
    if (is_special(*output) || standard_stream(*output)) {
      if (access(output->c_str(), W_OK) != 0) fail(*output, errno);
      continue;
    }
    const fs::path target = behind_links(*output);
    const auto is_target = [&](const fs::path& other) {
      return fs::equivalent(other, target, error) ||
             fs::weakly_canonical(other, error) == fs::weakly_canonical(target, error);
    };
    for (const fs::path& input : inputs)
      if (is_target(input))
        throw InputError(
            fmt::format("`{}` would be overwritten, but the command reads it (`{}`): "
                        "name another file to write",
                        output->string(), input.string()));
    for (const fs::path& other : regular)
      if (is_target(other))
        throw InputError(
            fmt::format("two outputs would be written to the same file `{}`", output->string()));
    regular.push_back(target);
    if (fs::is_directory(target, error)) fail(*output, EISDIR);
    if (fs::exists(target, error) && access(target.c_str(), W_OK) != 0) fail(*output, errno);
    const fs::path folder = target.has_parent_path() ? target.parent_path() : ".";
    // A file that is made and removed: access() tells root that it may write everywhere.
    std::string trial = (folder / ".ciliaval-XXXXXX").string();
    const int descriptor = mkstemp(trial.data());
    if (descriptor < 0) fail(*output, errno);
    close(descriptor);
    unlink(trial.c_str());
  }
}

}  // namespace ciliaval::compare::output
