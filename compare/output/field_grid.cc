// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/output/field_grid.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <memory>
#include <utility>

#include "compare/output/results.h"
#include "problem/error.h"

namespace ciliaval::compare::output {
namespace {

bool converged_anywhere(const models::MechanicsRun& run) {
  return std::any_of(run.result.steps.begin(), run.result.steps.end(),
                     [](const MechanicsStep& step) { return step.deformation.has_value(); });
}

/// The most detailed one: the last that converged.
const models::MechanicsRun* mechanics_to_draw(const models::CaseResult& result) {
  const auto last =
      std::find_if(result.mechanics.rbegin(), result.mechanics.rend(), converged_anywhere);
  return last == result.mechanics.rend() ? nullptr : &*last;
}

void lay_out(FieldGrid& grid, const models::CaseResult& result, const models::MechanicsRun& run) {
  Eigen::AlignedBox3d box;
  for (const MechanicsStep& step : run.result.steps)
    if (step.deformation)
      for (const double S : output_points(step.deformation->centreline))
        box.extend(step.deformation->centreline.at(S).position);
  // A sensor far away would leave no grid points at the cilium.
  const double reach = 2 * result.problem.cilium.length();
  const Eigen::AlignedBox3d cilium = box;
  for (const Vector3& sensor : result.problem.sensors)
    if (cilium.exteriorDistance(sensor) <= reach) box.extend(sensor);
  const Vector3 margin = Vector3::Constant(4 * result.problem.cilium.radius());
  grid.origin = box.min() - margin;
  const Vector3 size = box.max() + margin - grid.origin;
  for (Eigen::Index i = 0; i < 3; ++i)
    grid.spacing[i] = size[i] / (grid.points[static_cast<std::size_t>(i)] - 1);
}

/// B at some points. A model refuses all of them if B diverges at one: then they are asked again in
/// pieces of the first of the smaller sizes, and where that fails of the next.
void sample(const FieldModel& model, const Cilium& cilium, const Deformation& deformation,
            std::span<const Vector3> points, std::span<const std::size_t> smaller,
            FieldGrid::Step& step) {
  const auto add = [&](const Vector3& B) {
    const bool valid = B.allFinite();
    step.B.push_back(valid ? B : Vector3::Zero());
    step.valid.push_back(valid ? 1 : 0);
  };
  try {
    for (const Vector3& B : model.field(cilium, deformation, points).B) add(B);
  } catch (const Error&) {
    if (smaller.empty()) {
      step.B.insert(step.B.end(), points.size(), Vector3::Zero());
      step.valid.insert(step.valid.end(), points.size(), 0);
      return;
    }
    for (std::size_t i = 0; i < points.size(); i += smaller.front())
      sample(model, cilium, deformation, points.subspan(i, smaller.front()), smaller.subspan(1),
             step);
  }
}

/// All points in one call, so that the model sets up once and spreads them over its threads.
FieldGrid::Step sample_grid(const FieldGrid& grid, const FieldModel& model, const Cilium& cilium,
                            const Deformation& deformation) {
  std::vector<Vector3> points;
  for (int k = 0; k < grid.points[2]; ++k)
    for (int j = 0; j < grid.points[1]; ++j)
      for (int i = 0; i < grid.points[0]; ++i)
        points.emplace_back(grid.origin + grid.spacing.cwiseProduct(Vector3(i, j, k)));
  const auto row = static_cast<std::size_t>(grid.points[0]);
  const std::array<std::size_t, 3> smaller{row * static_cast<std::size_t>(grid.points[1]), row, 1};
  FieldGrid::Step step;
  sample(model, cilium, deformation, points, smaller, step);
  return step;
}

}  // namespace

std::optional<FieldGrid> field_grid(const models::CaseResult& result,
                                    std::span<const models::FieldEntry> fields,
                                    const Progress& progress) {
  const models::MechanicsRun* run = mechanics_to_draw(result);
  const std::vector<std::string>& asked = result.problem.fields;
  std::shared_ptr<const FieldModel> model;
  FieldGrid grid;
  for (const models::FieldEntry& entry : fields) {
    if (std::find(asked.begin(), asked.end(), entry.id) == asked.end()) continue;
    if (entry.has_body) continue;
    input::ModelOptions options = result.problem.options;
    if (entry.hasten) entry.hasten(options);
    auto candidate = entry.make(options);
    if (!candidate->pointwise()) continue;
    model = std::move(candidate);
    grid.field = entry.id;
  }
  if (run == nullptr || !model) return std::nullopt;
  grid.mechanics = run->model;
  lay_out(grid, result, *run);
  grid.sample = [layout = grid, run, model, progress, &cilium = result.problem.cilium](
                    std::size_t step) -> std::optional<FieldGrid::Step> {
    const MechanicsStep& mechanics = run->result.steps.at(step);
    if (!mechanics.deformation) return std::nullopt;
    if (progress) progress("field grid: step " + std::to_string(step + 1));
    return sample_grid(layout, *model, cilium, *mechanics.deformation);
  };
  return grid;
}

}  // namespace ciliaval::compare::output
