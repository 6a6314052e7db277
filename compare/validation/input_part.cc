// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/validation/input_part.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "compare/models/registry.h"
#include "compare/validation/input_number.h"
#include "compare/validation/sensitivity.h"

namespace ciliaval::compare::validation {
namespace {

/// A pair's results on the two shifted cases. `field` is none for the shape alone.
struct Sides {
  std::array<models::MechanicsRun, 2> shape;
  std::map<std::string, std::array<models::FieldRun, 2>> fields{};
};

models::ShapeShift shift_of(const Sides& sides, std::size_t step, double width) {
  const MechanicsStep& a = sides.shape[0].result.steps[step];
  const MechanicsStep& b = sides.shape[1].result.steps[step];
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
  // Models in place of each run, and the models to be solved.
  std::map<std::string, std::vector<std::string>> solved;  // mechanics: their fields
  const auto stand = [&](const std::string& shape,
                         const std::string& field) -> std::optional<Stand> {
    // Measured or external results do not follow the case's numbers.
    if (std::ranges::find(mechanics, shape, &models::MechanicsEntry::id) == mechanics.end())
      return std::nullopt;
    return stand_in(shape, field, Sensitivities::quick, problem, mechanics, fields);
  };
  for (const models::MechanicsRun& run : result.mechanics)
    if (const auto by = stand(run.model, "")) solved[by->mechanics];
  for (const models::FieldRun& run : result.fields)
    if (const auto by = stand(run.mechanics, run.field); by && !run.measured) {
      auto& all = solved[by->mechanics];
      if (std::ranges::find(all, by->field) == all.end()) all.push_back(by->field);
    }
  const std::size_t steps = problem.load_path.size();
  for (models::MechanicsRun& run : result.mechanics)
    run.input_parts.assign(steps, std::vector<models::ShapeShift>(inputs.size()));
  for (models::FieldRun& run : result.fields)
    for (auto& step : run.steps)
      if (step) {
        step->B_input_parts.resize(inputs.size());
        step->dB_input_parts.resize(inputs.size());
      }
  std::size_t done = 0;
  for (std::size_t k = 0; k < inputs.size(); ++k) {
    const Input& input = inputs[k];
    const double width = 2 * input.step;
    const std::array<input::Case, 2> cases{shifted(problem, input, -input.step),
                                           shifted(problem, input, input.step)};
    std::map<std::string, Sides> sides;
    for (const auto& [id, its_fields] : solved) {
      if (progress)
        progress({fmt::format("band, {} of {}", input.number.path, id), done++,
                  inputs.size() * solved.size()});
      const auto& entry = models::entry_of(mechanics, id);
      Sides& of = sides[id];
      for (const std::size_t i : {0, 1}) {
        of.shape.at(i) = models::run_mechanics(entry, cases.at(i), fields);
        for (const std::string& field : its_fields)
          of.fields[field].at(i) =
              models::run_field(field, *models::entry_of(fields, field).make(problem.options),
                                of.shape.at(i), cases.at(i));
      }
    }
    for (models::MechanicsRun& run : result.mechanics)
      if (const auto by = stand(run.model, ""))
        for (std::size_t i = 0; i < steps; ++i)
          run.input_parts[i][k] = shift_of(sides.at(by->mechanics), i, width);
    for (models::FieldRun& run : result.fields) {
      const auto by = stand(run.mechanics, run.field);
      if (!by || run.measured) continue;
      const auto& of = sides.at(by->mechanics).fields.at(by->field);
      for (std::size_t i = 0; i < steps; ++i) {
        if (!run.steps[i]) continue;
        run.steps[i]->B_input_parts[k] = shift_of(of, i, &models::FieldStep::B, width);
        run.steps[i]->dB_input_parts[k] = shift_of(of, i, &models::FieldStep::dB, width);
      }
    }
  }
}

}  // namespace ciliaval::compare::validation
