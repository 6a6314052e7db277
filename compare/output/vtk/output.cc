// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/output/vtk/output.h"

#include <tbb/parallel_for.h>
#include <vtkDataSet.h>
#include <vtkImageData.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <atomic>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "analytic/rod/field_models.h"
#include "compare/output/output_file.h"
#include "compare/output/results.h"
#include "compare/output/sweep.h"
#include "compare/output/text_table.h"
#include "compare/output/vtk/datasets.h"
#include "compare/output/vtk/files.h"
#include "compare/results/band.h"
#include "problem/error.h"
#include "problem/support/evenly.h"

namespace ciliaval::compare::output::vtk {
namespace {

/// ± of a rod's shape, in the field data of its centreline.
constexpr std::pair<const char*, results::ShapeQuantity> banded[]{
    {"tip_band", results::ShapeQuantity::tip},
    {"tip_angle_band", results::ShapeQuantity::tip_angle}};

/// The files of a folder, each part of a series. Several threads may add files.
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
    const std::lock_guard lock(series_mutex_);
    series_[series] = kind;
  }

  void finish() const {
    for (const auto& [series, kind] : series_)
      write_series(folder_, series, kind, series_times(path_));
    write_file(folder_ / "open.py", open_script);
  }

 private:
  const std::filesystem::path& folder_;
  const Provenance& provenance_;
  const LoadPath& path_;
  std::map<std::string, std::string> series_;  ///< the extension of each
  std::mutex series_mutex_;
};

/// True if any pair of models has B or ΔB at any sensor.
bool any_field(const models::CaseResult& result, std::size_t step) {
  return std::any_of(result.fields.begin(), result.fields.end(), [&](const models::FieldRun& run) {
    return run.steps[step] && run.steps[step]->any();
  });
}

/// The steps whose bodies and grids, some MB each, are written: of a sweep, which has hundreds,
/// some.
std::vector<std::size_t> steps_of_large_files(const input::Case& problem,
                                              const std::vector<std::size_t>& drawn) {
  constexpr std::size_t most = 21;
  const std::size_t steps = problem.load_path.size();
  return is_sweep(problem) ? support::evenly(steps, std::min(steps, most)) : drawn;
}

/// The first files first, which are the largest: the threads then end at about the same time.
void write_in_order(const std::vector<std::function<void()>>& files) {
  std::atomic<std::size_t> next = 0;
  tbb::parallel_for(
      std::size_t{0}, files.size(), [&](std::size_t) { files[next++](); },
      tbb::simple_partitioner());
}

}  // namespace

std::vector<std::size_t> drawn_steps(std::size_t steps, bool all) {
  constexpr std::size_t most = 200;
  return support::evenly(steps, all ? steps : std::min(steps, most));
}

void write_vtk(const models::CaseResult& result, const std::optional<FieldGrid>& grid,
               const Provenance& provenance, const std::vector<std::size_t>& drawn,
               const std::filesystem::path& folder) {
  const input::Case& problem = result.problem;
  Output output(folder, provenance, problem.load_path);
  std::vector<std::function<void()>> files;
  // `make` gives the data set, or none.
  const auto add = [&](const std::string& series, std::size_t step, const auto& make) {
    files.emplace_back([&output, series, step, make] {
      if (const vtkSmartPointer<vtkDataSet> data = make()) output.add(series, step, *data);
    });
  };
  const std::vector<std::size_t> large = steps_of_large_files(problem, drawn);
  for (const std::size_t step : large)
    for (const models::MechanicsRun& run : result.mechanics) {
      const auto& deformation = run.result.steps[step].deformation;
      if (deformation && deformation->body)
        add("body_" + run.model, step, [&body = *deformation->body] { return solid_grid(body); });
    }
  for (const std::size_t step : large) {
    if (grid)
      add("field_" + grid->mechanics + "_" + grid->field, step,
          [&grid, step]() -> vtkSmartPointer<vtkDataSet> {
            const auto B = grid->sample(step);
            return B ? field_image(*grid, *B) : nullptr;
          });
    for (const models::FieldRun& run : result.fields)
      if (run.steps[step] && run.steps[step]->mesh)
        add("field_" + run.mechanics + "_" + run.field, step,
            [&mesh = *run.steps[step]->mesh] { return octree_grid(mesh); });
  }
  for (const std::size_t step : drawn) {
    for (const models::MechanicsRun& run : result.mechanics) {
      const auto& deformation = run.result.steps[step].deformation;
      if (!deformation) continue;
      add("centreline_" + run.model, step, [&problem, &run, step] {
        auto data = rod_polyline(problem.cilium, run.result.steps[step].deformation->centreline);
        for (const auto& [name, quantity] : banded)
          if (const auto band = results::shape_band(run, step, quantity).total)
            add_number(*data, name, *band);
        return data;
      });
      add("dipoles_" + run.model, step, [&problem, &centreline = deformation->centreline] {
        return dipoles(problem.cilium, centreline,
                       problem.options.of<analytic::rod::LineOptions>().push_forward);
      });
    }
    if (problem.load_path[step].surface()) {
      const Load& load = problem.load_path[step];
      add("surface", step, [&] { return surface_mesh(load, problem.cilium); });
      for (const models::MechanicsRun& run : result.mechanics)
        if (const auto& contact = run.result.steps[step].contact;
            contact && contact->state != SurfaceContact::State::open)
          add("contact_" + run.model, step, [&] { return contact_point(load, *contact); });
    }
    if (any_field(result, step)) add("sensors", step, [&, step] { return sensors(result, step); });
  }
  write_in_order(files);
  output.finish();
}

}  // namespace ciliaval::compare::output::vtk
