// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/output/output_folder.h"

#include <fmt/core.h>
#include <signal.h>  // NOLINT(modernize-deprecated-headers): kill() is POSIX
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <climits>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <optional>
#include <set>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "compare/output/output_file.h"
#include "problem/error.h"

namespace ciliaval::compare::output {
namespace {

namespace fs = std::filesystem;

/// Name of this computer as a part of a file's name, without dots, which separate the parts.
std::string host() {
  std::array<char, HOST_NAME_MAX + 1> text{};
  if (gethostname(text.data(), text.size() - 1) != 0) return "unknown";
  std::string name = text.data();
  for (char& c : name)
    if (c == '.' || c == '/') c = '_';
  return name;
}

std::string temporary_name(const std::string& name, std::string_view extension) {
  return fmt::format(".{}.{}.{}{}", name, host(), getpid(), extension);
}

/// The process id in `.NAME.HOST.PID.tmp` or `.NAME.HOST.PID.old`, if `file` is called so and this
/// host made it. A process of another host cannot be asked whether it lives: what it made stays.
std::optional<pid_t> owner(const fs::path& file, const std::string& name) {
  const std::string text = file.filename().string();
  const std::string prefix = fmt::format(".{}.{}.", name, host());
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

/// The hidden file with the names of all that a run has written, a line each.
constexpr const char* list_name = ".ciliaval";

/// Takes away what processes of this host that are no longer alive have left. Where one was killed
/// between its two renames, the new results, which are complete, go to their place.
void remove_stale(const fs::path& directory, const fs::path& target, const std::string& name) {
  for (const std::string_view extension : {".tmp", ".old"})
    for (const fs::directory_entry& entry : fs::directory_iterator(directory)) {
      const auto pid = owner(entry.path(), name);
      if (!pid || is_alive(*pid) || entry.path().extension() != extension) continue;
      if (!fs::exists(target) && fs::exists(entry.path() / list_name))
        fs::rename(entry.path(), target);
      else
        fs::remove_all(entry.path());
    }
}

/// Content of the folder, relative to it, in alphabetical order.
std::set<fs::path> contents(const fs::path& folder) {
  std::set<fs::path> names;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder))
    names.insert(entry.path().lexically_relative(folder));
  return names;
}

void write_list(const fs::path& folder) {
  std::string text;
  for (const fs::path& name : contents(folder)) text += name.generic_string() + '\n';
  write_file(folder / list_name, text);
}

/// The first file in the folder that its list does not have: it is the user's. None in an empty
/// folder. A page that `ciliaval report` has made may be made again.
std::optional<fs::path> foreign_file(const fs::path& folder) {
  std::set<fs::path> ours;
  if (std::ifstream list(folder / list_name); list.is_open()) {
    ours = {list_name, "report.html"};
    for (std::string line; std::getline(list, line);) ours.insert(line);
  }
  for (const fs::path& name : contents(folder))
    if (!ours.contains(name)) return name;
  return std::nullopt;
}

/// Throws FileError if the results may not take the place of what is there.
void check_target(const fs::path& target) {
  const fs::file_status status = fs::symlink_status(target);
  if (!fs::exists(status)) return;
  if (fs::is_symlink(status))
    throw FileError("cannot replace `" + target.string() + "`: it is a link to `" +
                    fs::read_symlink(target).string() +
                    "`; remove the link or choose another folder with -o DIR");
  if (!fs::is_directory(status))
    throw FileError("cannot write the folder `" + target.string() +
                    "`: a file has that name; remove it or choose another folder with -o DIR");
  if (const auto foreign = foreign_file(target))
    throw FileError("the results would replace the folder `" + target.string() + "`, but `" +
                    foreign->string() +
                    "` in it is not from a run of this version and would be deleted; move it away "
                    "or choose another folder with -o DIR");
}

/// True if a file lies in a folder, links resolved.
bool is_inside(const fs::path& file, const fs::path& folder) {
  const fs::path relative =
      fs::weakly_canonical(file).lexically_relative(fs::weakly_canonical(folder));
  return !relative.empty() && *relative.begin() != "..";
}

}  // namespace

OutputFolder::OutputFolder(const fs::path& directory, const std::string& name,
                           const std::vector<fs::path>& inputs)
    : target_(directory / name) {
  fs::path temporary = directory / temporary_name(name, ".tmp");
  try {
    fs::create_directories(directory);
    remove_stale(directory, target_, name);
    check_target(target_);
    for (const fs::path& input : inputs)
      if (is_inside(input, target_))
        throw InputError(fmt::format(
            "the results would replace the folder `{}`, but the command reads `{}` in it; choose "
            "another folder with -o DIR",
            target_.string(), input.string()));
    fs::create_directory(temporary);
    write_file(temporary / "probe", "can this folder be written?");
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
  const std::string name = target_.filename().string();
  const auto keep = [&](const std::string& reason) {
    // Under a name that remove_stale() does not know.
    fs::path kept = target_.parent_path() / (name + "." + std::to_string(getpid()) + ".new");
    if (rename(temporary_.c_str(), kept.c_str()) != 0) kept = temporary_;
    temporary_.clear();
    throw FileError(reason + "\nThe new results are in `" + kept.string() + "`.");
  };
  try {
    write_list(temporary_);
    check_target(target_);  // again: the run may have taken hours
    replace();
  } catch (const std::runtime_error& error) {
    keep(error.what());
  }
}

void OutputFolder::replace() {
  const auto fail = [&](int error) {
    throw FileError("cannot put the results in place at `" + target_.string() +
                    "`: " + std::strerror(error));
  };
  if (rename(temporary_.c_str(), target_.c_str()) == 0) {  // nothing there, or an empty folder
    temporary_.clear();
    return;
  }
  if (errno != ENOTEMPTY && errno != EEXIST) fail(errno);
  const fs::path old = target_.parent_path() / temporary_name(target_.filename().string(), ".old");
  if (rename(target_.c_str(), old.c_str()) != 0) fail(errno);
  if (rename(temporary_.c_str(), target_.c_str()) != 0) {
    const int error = errno;
    if (rename(old.c_str(), target_.c_str()) != 0) fail(errno);
    fail(error);
  }
  temporary_ = old;
  std::error_code ignored;  // the new results are in place; the next run removes the old ones
  fs::remove_all(temporary_, ignored);
  temporary_.clear();
}

}  // namespace ciliaval::compare::output
