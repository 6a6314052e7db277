// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/app/case_files.h"

#include <fmt/core.h>
#include <toml++/toml.h>

#include <algorithm>
#include <map>
#include <string>
#include <system_error>

#include "compare/app/terminal.h"
#include "compare/input/case_sections.h"
#include "compare/models/registry.h"
#include "compare/validation/input_number.h"
#include "problem/error.h"

namespace ciliaval::compare::app {

namespace fs = std::filesystem;

std::vector<input::Case> read_cases(const std::vector<fs::path>& files) {
  std::vector<input::Case> cases;
  std::string faults;
  for (const fs::path& file : files) {
    try {
      if (is_study_file(file))
        throw InputError(file.string() + ": is a study, not a case: `ciliaval study` runs it");
      if (is_bench_file(file))
        throw InputError(file.string() + ": is a test bench, not a case: `ciliaval sense` runs it");
      cases.push_back(input::read_case(file, models::known()));
      validation::read_inputs(cases.back());  // throws if a number is not the case's
      for (const std::string& id : cases.back().mechanics)
        if (const auto& entry = models::entry_of(models::mechanics_models(), id); entry.remarks)
          for (const std::string& remark : entry.remarks(cases.back()))
            print(fmt::format("Remark: {}\n", remark));
    } catch (const InputError& error) {
      faults += (faults.empty() ? "" : "\n") + std::string(error.what());
    }
  }
  if (!faults.empty()) throw InputError(faults);
  std::map<std::string, fs::path> file_of;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const auto [first, added] = file_of.emplace(cases[i].name, files[i]);
    if (!added)
      throw InputError(
          fmt::format("`{}` and `{}` both have the name \"{}\": the results of one "
                      "would replace those of the other; rename one",
                      first->second.string(), files[i].string(), cases[i].name));
  }
  return cases;
}

std::vector<fs::path> input_files(const fs::path& file, const input::Case& problem) {
  std::vector<fs::path> files = input::named_files(models::known(), problem);
  files.push_back(file);
  for (const char* table : {"study", "bench"})
    if (is_study_file(file) || is_bench_file(file))
      if (const auto name = toml::parse_file(file.string())[table]["case"].value<std::string>())
        files.push_back(file.parent_path() / *name);
  return files;
}

bool is_study_file(const fs::path& file) {
  return file.string().ends_with(".study.toml");
}

bool is_bench_file(const fs::path& file) {
  return file.string().ends_with(".sense.toml");
}

ShippedCases shipped_cases() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (error) return {};
  for (const char* data : {CILIAVAL_INSTALLED_DATA, CILIAVAL_SOURCE_DATA}) {
    ShippedCases cases{(program.parent_path() / data / "cases").lexically_normal(), {}, {}, {}};
    if (!fs::is_directory(cases.folder, error)) continue;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(cases.folder))
      if (is_study_file(entry.path()))
        cases.studies.push_back(entry.path());
      else if (is_bench_file(entry.path()))
        cases.benches.push_back(entry.path());
      else if (entry.path().extension() == ".toml")
        cases.files.push_back(entry.path());
    std::sort(cases.files.begin(), cases.files.end());
    std::sort(cases.studies.begin(), cases.studies.end());
    std::sort(cases.benches.begin(), cases.benches.end());
    return cases;
  }
  return {};
}

}  // namespace ciliaval::compare::app
