// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/vtk/output.h"

#include <algorithm>
#include <map>
#include <string>
#include <system_error>

#include "compare/results.h"
#include "compare/vtk/datasets.h"
#include "compare/vtk/files.h"
#include "problem/error.h"

namespace ciliaval::compare::vtk {
namespace {

/// The files of a folder, each part of a series.
class Output {
 public:
  Output(const std::filesystem::path& folder, const Provenance& provenance, const LoadPath& path)
      : folder_(folder), provenance_(provenance), path_(path) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error)
      throw FileError("cannot make the folder `" + folder.string() + "`: " + error.message());
  }

  void add(const std::string& series, std::size_t step, vtkDataSet& data) {
    const std::string kind = extension(data);
    add_provenance(data, provenance_, path_[step]);
    write(data, folder_ / step_file(series, step, kind));
    series_[series] = kind;
  }

  void finish() const {
    for (const auto& [series, kind] : series_)
      write_series(folder_, series, kind, series_times(path_));
    write_text(folder_ / "open.py", open_script);
  }

 private:
  const std::filesystem::path& folder_;
  const Provenance& provenance_;
  const LoadPath& path_;
  std::map<std::string, std::string> series_;
};

/// Whether any pair of models has B at any sensor.
bool any_field(const CaseResult& result, std::size_t step) {
  return std::any_of(result.fields.begin(), result.fields.end(), [&](const FieldRun& run) {
    return run.steps[step] && run.steps[step]->any();
  });
}

}  // namespace

void write_vtk(const CaseResult& result, const std::optional<FieldGrid>& grid,
               const Provenance& provenance, const std::filesystem::path& folder) {
  const Case& problem = result.problem;
  Output output(folder, provenance, problem.load_path);
  for (std::size_t step = 0; step < problem.load_path.size(); ++step) {
    for (const MechanicsRun& run : result.mechanics) {
      const auto& deformation = run.result.steps[step].deformation;
      if (!deformation) continue;
      output.add("centreline_" + run.model, step,
                 *rod_polyline(problem.cilium, deformation->centreline));
      output.add(
          "dipoles_" + run.model, step,
          *dipoles(problem.cilium, deformation->centreline, problem.options.line.push_forward));
      if (deformation->body) output.add("body_" + run.model, step, *solid_grid(*deformation->body));
    }
    if (grid)
      if (const auto B = grid->sample(step))
        output.add("field_" + grid->mechanics + "_" + grid->field, step, *field_image(*grid, *B));
    for (const FieldRun& run : result.fields)
      if (run.steps[step] && run.steps[step]->mesh)
        output.add("field_" + run.mechanics + "_" + run.field, step,
                   *octree_grid(*run.steps[step]->mesh));
    if (any_field(result, step)) output.add("sensors", step, *sensors(result, step));
  }
  output.finish();
}

}  // namespace ciliaval::compare::vtk
