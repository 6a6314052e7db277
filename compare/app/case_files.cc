// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/app/case_files.h"

#include <fmt/core.h>
#include <toml++/toml.h>

#include <algorithm>
#include <map>
#include <string>
#include <system_error>

#include "compare/app/terminal.h"
#include "meshes/gmsh/gmsh_mesh.h"
#include "problem/error.h"

namespace ciliaval::compare::app {

namespace fs = std::filesystem;

namespace {

/// Reads the user's mesh of a case, if it names one and asks for the solid, and returns the remarks
/// on it. Throws InputError and FileError as meshes::gmsh::read_gmsh().
std::vector<std::string> check_case_mesh(const input::Case& problem) {
  const fem::solid::SolidOptions& options = problem.options.solid;
  const auto& ids = problem.mechanics;
  if (options.mesh.empty() || std::find(ids.begin(), ids.end(), "solid") == ids.end()) return {};
  dealii::Triangulation<3> triangulation;
  return meshes::gmsh::read_gmsh({options.mesh, options.mesh_unit}, problem.cilium, triangulation)
      .remarks;
}

}  // namespace

std::vector<input::Case> read_cases(const std::vector<fs::path>& files) {
  std::vector<input::Case> cases;
  std::string faults;
  for (const fs::path& file : files) {
    try {
      if (is_study_file(file))
        throw InputError(file.string() + ": is a study, not a case: `ciliaval study` runs it");
      if (is_bench_file(file))
        throw InputError(file.string() + ": is a test bench, not a case: `ciliaval sense` runs it");
      cases.push_back(input::read_case(file));
      for (const std::string& remark : check_case_mesh(cases.back()))
        print(fmt::format("Remark: {}: {}\n", cases.back().options.solid.mesh.string(), remark));
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
  std::vector<fs::path> files{file, problem.options.solid.mesh};
  for (const char* table : {"study", "bench"})
    if (is_study_file(file) || is_bench_file(file))
      if (const auto name = toml::parse_file(file.string())[table]["case"].value<std::string>())
        files.push_back(file.parent_path() / *name);
  for (const input::external::ExternalModel& model : problem.external) {
    files.insert(files.end(), model.centreline_files.begin(), model.centreline_files.end());
    files.insert(files.end(), {model.readings_file, model.background_file});
  }
  std::erase_if(files, [](const fs::path& name) { return name.empty(); });
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
