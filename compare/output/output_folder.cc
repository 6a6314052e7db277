// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/output/output_folder.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <fmt/ranges.h>
#include <signal.h>  // NOLINT(modernize-deprecated-headers): kill() is POSIX
#include <stdio.h>   // NOLINT(modernize-deprecated-headers): renameat2() is Linux
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "compare/models/registry.h"
#include "compare/output/results.h"
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

/// `(a|b|c)`: the ids of all models of a kind.
template <class Entry>
std::string any_id(const std::vector<Entry>& entries) {
  std::vector<std::string> ids;
  ids.reserve(entries.size());
  for (const Entry& entry : entries) ids.push_back(entry.id);
  return fmt::format("({})", fmt::join(ids, "|"));
}

/// The names, relative to the folder of a case, that a run writes.
std::regex result_files() {
  const std::string mechanics = any_id(mechanics_models());
  const std::string series = fmt::format("((body|centreline|dipoles)_{0}|field_{0}_{1}|sensors)",
                                         mechanics, any_id(field_models()));
  return std::regex(
      fmt::format(R"(summary\.json|report\.html|errors\.csv|case\.toml|{}_[0-9]{{4,}}\.csv|)"
                  R"(vtk/open\.py|vtk/{}(\.pvd|_[0-9]{{4,}}\.vt[upi]))",
                  mechanics, series));
}

/// Whether a summary is that of a run of this case. Its lists are skipped: they may be long.
bool is_summary_of(const fs::path& file, const std::string& case_name) {
  using Json = nlohmann::json;
  std::ifstream stream(file);
  const auto outermost = [](int depth, Json::parse_event_t event, const Json&) {
    return depth == 0 || (event != Json::parse_event_t::object_start &&
                          event != Json::parse_event_t::array_start);
  };
  const Json summary = Json::parse(stream, outermost, false);
  return summary.is_object() && summary.contains("schema") && summary.contains("case") &&
         summary["schema"].is_number_integer() && summary["case"] == case_name;
}

/// Throws FileError if the results may not take the place of what is there.
void check_target(const fs::path& target, const std::string& name) {
  const fs::file_status status = fs::symlink_status(target);
  if (!fs::exists(status)) return;
  if (fs::is_symlink(status))
    throw FileError("cannot replace `" + target.string() + "`: it is a link to `" +
                    fs::read_symlink(target).string() +
                    "`; remove the link or choose another folder with -o DIR");
  if (!fs::is_directory(status))
    throw FileError("cannot write the folder `" + target.string() +
                    "`: a file has that name; remove it or choose another folder with -o DIR");
  if (const auto foreign = foreign_file(target, name))
    throw FileError("the results would replace the folder `" + target.string() + "`, but `" +
                    foreign->string() +
                    "` in it is not from a run of this case and would be deleted; move it away or "
                    "choose another folder with -o DIR");
}

}  // namespace

std::optional<fs::path> foreign_file(const fs::path& folder, const std::string& case_name) {
  const bool ours = is_summary_of(folder / "summary.json", case_name);
  const std::regex known = result_files();
  std::optional<fs::path> first;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
    const fs::path name = entry.path().lexically_relative(folder);
    const fs::file_status status = entry.symlink_status();
    const bool expected = fs::is_directory(status) ? name == "vtk"
                                                   : fs::is_regular_file(status) &&
                                                         std::regex_match(name.string(), known);
    if (!(ours && expected) && (!first || name < *first)) first = name;
  }
  return first;
}

OutputFolder::OutputFolder(const fs::path& directory, const std::string& name)
    : target_(directory / name) {
  fs::path temporary = directory / temporary_name(name, ".tmp");
  try {
    fs::create_directories(directory);
    remove_stale(directory, target_, name);
    check_target(target_, name);
    fs::create_directory(temporary);
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
  const std::string name = target_.filename().string();
  const auto keep = [&](const std::string& reason) {
    // Under a name that remove_stale() does not know.
    fs::path kept = target_.parent_path() / (name + "." + std::to_string(getpid()) + ".new");
    if (rename(temporary_.c_str(), kept.c_str()) != 0) kept = temporary_;
    temporary_.clear();
    throw FileError(reason + "\nThe new results are in `" + kept.string() + "`.");
  };
  try {
    check_target(target_, name);  // again: the run may have taken hours
    replace();
  } catch (const FileError& error) {
    keep(error.what());
  } catch (const fs::filesystem_error& error) {
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
