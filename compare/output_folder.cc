// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/output_folder.h"

#include <fcntl.h>
#include <signal.h>  // NOLINT(modernize-deprecated-headers): kill() is POSIX
#include <stdio.h>   // NOLINT(modernize-deprecated-headers): renameat2() is Linux
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include "compare/results.h"
#include "problem/error.h"

namespace ciliaval::compare {
namespace {

namespace fs = std::filesystem;

std::string temporary_name(const std::string& name, std::string_view extension) {
  return "." + name + "." + std::to_string(getpid()) + std::string(extension);
}

/// The process id in `.NAME.PID.tmp` or `.NAME.PID.old`, if that is what `file` is called.
std::optional<pid_t> owner(const fs::path& file, const std::string& name) {
  const std::string text = file.filename().string();
  const std::string prefix = "." + name + ".";
  if (!text.starts_with(prefix) || !(text.ends_with(".tmp") || text.ends_with(".old")) ||
      text.size() <= prefix.size() + 4)
    return std::nullopt;
  pid_t pid = 0;
  const char* end = text.data() + text.size() - 4;
  const auto [stop, error] = std::from_chars(text.data() + prefix.size(), end, pid);
  if (error != std::errc() || stop != end || pid <= 0) return std::nullopt;
  return pid;
}

bool is_alive(pid_t pid) {
  return pid != getpid() && (kill(pid, 0) == 0 || errno != ESRCH);
}

/// Takes away what processes that are no longer alive have left. Where one was killed between the
/// two renames of a file system that cannot exchange, its old results go back to their place.
void remove_stale(const fs::path& directory, const fs::path& target, const std::string& name) {
  for (const fs::directory_entry& entry : fs::directory_iterator(directory)) {
    const auto pid = owner(entry.path(), name);
    if (!pid || is_alive(*pid)) continue;
    if (entry.path().extension() == ".old" && !fs::exists(target))
      fs::rename(entry.path(), target);
    else
      fs::remove_all(entry.path());
  }
}

}  // namespace

OutputFolder::OutputFolder(const fs::path& directory, const std::string& name)
    : target_(directory / name) {
  fs::path temporary = directory / temporary_name(name, ".tmp");
  try {
    fs::create_directories(directory);
    remove_stale(directory, target_, name);
    fs::create_directory(temporary);
    if (fs::exists(target_) && !fs::is_directory(target_))
      throw FileError("cannot write the folder `" + target_.string() + "`: a file has that name");
    write_text(temporary / "probe", "can this folder be written?");
    fs::remove(temporary / "probe");
  } catch (const fs::filesystem_error& error) {
    throw FileError("cannot write to the output folder `" + directory.string() +
                    "`: " + error.code().message() + "; choose another with -o DIR");
  } catch (const FileError&) {
    std::error_code ignored;
    fs::remove_all(temporary, ignored);
    throw;
  }
  temporary_ = std::move(temporary);
}

OutputFolder::OutputFolder(OutputFolder&& other) noexcept
    : target_(std::move(other.target_)), temporary_(std::exchange(other.temporary_, {})) {}

OutputFolder::~OutputFolder() {
  std::error_code ignored;  // nothing can be done about it here; the next run removes it
  if (!temporary_.empty()) fs::remove_all(temporary_, ignored);
}

void OutputFolder::commit() {
  const auto fail = [&](int error) {
    throw FileError("cannot put the results in place at `" + target_.string() +
                    "`: " + std::strerror(error));
  };
  if (rename(temporary_.c_str(), target_.c_str()) == 0) {  // nothing there, or an empty folder
    temporary_.clear();
    return;
  }
  if (errno != ENOTEMPTY && errno != EEXIST) fail(errno);
  if (renameat2(AT_FDCWD, temporary_.c_str(), AT_FDCWD, target_.c_str(), RENAME_EXCHANGE) != 0) {
    if (errno != EINVAL && errno != ENOSYS) fail(errno);
    const fs::path old =
        target_.parent_path() / temporary_name(target_.filename().string(), ".old");
    if (rename(target_.c_str(), old.c_str()) != 0) fail(errno);
    if (rename(temporary_.c_str(), target_.c_str()) != 0) {
      const int error = errno;
      if (rename(old.c_str(), target_.c_str()) != 0) fail(errno);
      fail(error);
    }
    temporary_ = old;
  }
  std::error_code ignored;  // the new results are in place; the next run removes the old ones
  fs::remove_all(temporary_, ignored);
  temporary_.clear();
}

}  // namespace ciliaval::compare
