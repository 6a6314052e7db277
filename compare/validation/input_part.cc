// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/validation/input_part.h"

#include <algorithm>
#include <array>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "compare/models/registry.h"
#include "compare/validation/input_number.h"
#include "compare/validation/sensitivity.h"

namespace ciliaval::compare::validation {
namespace {

models::ShapeShift shift_of(const std::array<models::MechanicsRun, 2>& sides, std::size_t step,
                            double width) {
  const MechanicsStep& a = sides[0].result.steps[step];
  const MechanicsStep& b = sides[1].result.steps[step];
  models::ShapeShift shift;
  const auto limits = std::array{slip_off_limit(a), slip_off_limit(b)};
  if (limits[0] && limits[1]) shift.slip_off = (*limits[1] - *limits[0]) / width;
  if (!a.deformation || !b.deformation) return shift;
  const auto tip = [](const MechanicsStep& of) {
    return of.deformation->centreline.at(of.deformation->centreline.length());
  };
  shift.tip = (tip(b).position - tip(a).position).norm() / width;
  shift.tip_angle = (tip(b).theta() - tip(a).theta()) / width;
  shift.applied_force = (b.applied_force - a.applied_force) / width;
  return shift;
}

models::AtSensors shift_of(const std::array<models::FieldRun, 2>& sides, std::size_t step,
                           models::AtSensors models::FieldStep::*values, double width) {
  models::AtSensors shift;
  const auto& [a, b] = std::tie(sides[0].steps[step], sides[1].steps[step]);
  if (!a || !b) return shift;
  for (std::size_t s = 0; s < (*a.*values).size(); ++s) {
    const auto& low = (*a.*values)[s];
    const auto& high = (*b.*values)[s];
    shift.push_back(low && high ? std::optional<Vector3>((*high - *low) / width) : std::nullopt);
  }
  return shift;
}

}  // namespace

void add_input_parts(models::CaseResult& result, std::span<const models::MechanicsEntry> mechanics,
                     std::span<const models::FieldEntry> fields, const Progress& progress) {
  const input::Case& problem = result.problem;
  const std::vector<Input> inputs = read_inputs(problem);
  for (const Input& input : inputs) result.inputs.push_back(input.number.path);
  if (inputs.empty()) return;
  const auto stand = [&](const std::string& shape,
                         const std::string& field) -> std::optional<Stand> {
    // Measured or external results do not follow the case's numbers.
    if (std::ranges::find(mechanics, shape, &models::MechanicsEntry::id) == mechanics.end())
      return std::nullopt;
    return stand_in(shape, field, Sensitivities::quick, problem, mechanics, fields);
  };
  std::set<Stand> stands;  // in place of the runs
  for (const models::MechanicsRun& run : result.mechanics)
    if (const auto by = stand(run.model, "")) stands.insert(*by);
  for (const models::FieldRun& run : result.fields)
    if (const auto by = stand(run.mechanics, run.field); by && !run.measured) stands.insert(*by);
  const std::size_t steps = problem.load_path.size();
  for (models::MechanicsRun& run : result.mechanics)
    run.input_parts.assign(steps, std::vector<models::ShapeShift>(inputs.size()));
  for (models::FieldRun& run : result.fields)
    for (auto& step : run.steps)
      if (step) {
        step->B_input_parts.resize(inputs.size());
        step->dB_input_parts.resize(inputs.size());
      }
  const auto set = [&](const Shifted& runs) {
    for (models::MechanicsRun& run : result.mechanics)
      if (const auto by = stand(run.model, ""))
        for (std::size_t i = 0; i < steps; ++i)
          run.input_parts[i][runs.input] = shift_of(runs.shapes.at(by->mechanics), i, runs.width);
    for (models::FieldRun& run : result.fields) {
      const auto by = stand(run.mechanics, run.field);
      if (!by || run.measured) continue;
      const auto& sides = runs.fields.at(*by);
      for (std::size_t i = 0; i < steps; ++i) {
        if (!run.steps[i]) continue;
        run.steps[i]->B_input_parts[runs.input] =
            shift_of(sides, i, &models::FieldStep::B, runs.width);
        run.steps[i]->dB_input_parts[runs.input] =
            shift_of(sides, i, &models::FieldStep::dB, runs.width);
      }
    }
  };
  for_each_input(problem, inputs, stands, mechanics, fields, with_prefix(progress, "band, "), set);
}

}  // namespace ciliaval::compare::validation
