// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/output/output_folder.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <signal.h>  // NOLINT(modernize-deprecated-headers): kill() is POSIX
#include <stdio.h>   // NOLINT(modernize-deprecated-headers): renameat2() is Linux
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <climits>
#include <cstring>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "compare/models/registry.h"
#include "compare/output/json_file.h"
#include "compare/output/output_file.h"
#include "compare/output/results.h"
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

/// Takes away what processes of this host that are no longer alive have left. Where one was killed
/// between the two renames of a file system that cannot exchange, its old results go back to their
/// place.
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

/// The series of files that a run writes: the names in the folder of a case without step and
/// extension.
struct Series {
  std::set<std::string> csv;
  std::set<std::string> vtk{"sensors", "surface"};

  void add(const std::string& mechanics, const std::vector<std::string>& fields) {
    csv.insert(mechanics);
    for (const char* kind : {"body", "centreline", "contact", "dipoles"})
      vtk.insert(fmt::format("{}_{}", kind, mechanics));
    for (const std::string& field : fields)
      vtk.insert(fmt::format("field_{}_{}", mechanics, field));
  }
};

/// The name of the series if the file is called SERIES_STEP; else empty.
std::string series_of(const fs::path& file) {
  const std::string stem = file.stem().string();
  const std::size_t end = stem.find_last_not_of("0123456789");
  if (end == std::string::npos || stem[end] != '_' || stem.size() - end - 1 < 4) return {};
  return stem.substr(0, end);
}

/// Whether a run writes a file of this name, relative to the folder of its case.
bool is_result(const fs::path& name, const Series& series) {
  for (const char* file : {"summary.json", "report.html", "errors.csv", "fields.csv", "sweep.csv",
                           "signal.csv", "case.toml", "vtk/open.py"})
    if (name == file) return true;
  const std::string extension = name.extension().string();
  if (!name.has_parent_path()) return extension == ".csv" && series.csv.contains(series_of(name));
  if (name.parent_path() != "vtk") return false;
  if (extension == ".pvd") return series.vtk.contains(name.stem().string());
  const bool is_vtk = extension == ".vtp" || extension == ".vtu" || extension == ".vti";
  return is_vtk && series.vtk.contains(series_of(name));
}

/// The series of a run of this case with any model of the program and with the external ones that
/// its summary names; none if there is no such summary. The list of comparisons, which may be long,
/// is skipped.
std::optional<Series> series_in(const fs::path& folder, const std::string& case_name) {
  using Json = nlohmann::ordered_json;
  Json summary;
  try {
    summary = read_json(folder / "summary.json", "result", "comparisons");
  } catch (const InputError&) {  // then nothing in the folder is known to be ours
    return std::nullopt;
  }
  if (!summary.is_object() || !summary.contains("schema") ||
      !summary["schema"].is_number_integer() || summary.value("case", Json()) != case_name)
    return std::nullopt;
  std::vector<std::string> fields;
  for (const models::FieldEntry& entry : models::field_models()) fields.push_back(entry.id);
  Series series;
  for (const models::MechanicsEntry& entry : models::mechanics_models())
    series.add(entry.id, fields);
  for (const Json& step : summary.value("steps", Json::array())) {
    if (!step.is_object()) continue;
    const Json mechanics = step.value("mechanics", Json::object());
    for (const auto& [id, result] : mechanics.items()) series.add(id, fields);
  }
  return series;
}

/// The first file (in alphabetical order) in the folder of a case's results that is not one of
/// those that a run writes (docs/guide/results.md): it is the user's. Every file is, if there is no
/// summary.json of a run of this case. None in an empty folder.
std::optional<fs::path> foreign_file(const fs::path& folder, const std::string& case_name) {
  const std::optional<Series> series = series_in(folder, case_name);
  std::optional<fs::path> first;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
    const fs::path name = entry.path().lexically_relative(folder);
    const fs::file_status status = entry.symlink_status();
    const bool is_ours = series && (fs::is_directory(status)
                                        ? name == "vtk"
                                        : fs::is_regular_file(status) && is_result(name, *series));
    if (!is_ours && (!first || name < *first)) first = name;
  }
  return first;
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

/// Whether a file lies in a folder, links resolved.
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
    check_target(target_, name);
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
    check_target(target_, name);  // again: the run may have taken hours
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

}  // namespace ciliaval::compare::output
