// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/models/named_files.h"

#include "compare/models/registry.h"

namespace ciliaval::compare::models {

std::vector<std::filesystem::path> named_files(const input::Case& problem) {
  std::vector<std::filesystem::path> files;
  for (const auto& [option, mesh] : input::user_meshes(known(), problem.options))
    files.push_back(mesh);
  for (const input::external::ExternalModel& model : problem.external) {
    files.insert(files.end(), model.centreline_files.begin(), model.centreline_files.end());
    files.insert(files.end(), {model.readings_file, model.background_file});
  }
  if (problem.surface) files.push_back(problem.surface->file);
  files.insert(files.end(), problem.measured.files.begin(), problem.measured.files.end());
  std::erase_if(files, [](const std::filesystem::path& name) { return name.empty(); });
  return files;
}

}  // namespace ciliaval::compare::models
