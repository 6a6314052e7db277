// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/results/band.h"

#include <array>
#include <cmath>

#include "compare/models/errors.h"
#include "compare/results/quantity.h"

namespace ciliaval::compare::results {
namespace {

/// Places of the parts of a quantity.
struct Parts {
  std::optional<double> (*numerical)(const MechanicsStep& step);
  std::optional<models::ModelPart<double>> models::ShapeModelParts::*model;
  std::optional<double> models::ShapeShift::*input;
};

/// The parts in the order of ShapeQuantity.
constexpr std::array<Parts, shape_quantities.size()> all_parts{
    {{[](const MechanicsStep& step) { return step.tip_uncertainty; }, &models::ShapeModelParts::tip,
      &models::ShapeShift::tip},
     {results::tip_angle_uncertainty, &models::ShapeModelParts::tip_angle,
      &models::ShapeShift::tip_angle},
     {[](const MechanicsStep& step) { return step.applied_force_uncertainty; },
      &models::ShapeModelParts::applied_force, &models::ShapeShift::applied_force},
     {[](const MechanicsStep& step) { return step.slip_off_uncertainty; },
      &models::ShapeModelParts::slip_off, &models::ShapeShift::slip_off}}};

std::optional<double> input_of(const models::MechanicsRun& run, std::size_t step,
                               std::optional<double> models::ShapeShift::*member) {
  double variance = 0;
  if (!run.input_parts.empty())
    for (const models::ShapeShift& shift : run.input_parts[step]) {
      if (!(shift.*member)) return std::nullopt;
      variance += std::pow(*(shift.*member), 2);
    }
  return std::sqrt(variance);
}

std::optional<Vector3> input_of(const std::vector<models::AtSensors>& parts, std::size_t sensor) {
  Vector3 variance = Vector3::Zero();
  for (const models::AtSensors& shift : parts) {
    if (sensor >= shift.size() || !shift[sensor]) return std::nullopt;
    variance += shift[sensor]->cwiseAbs2();
  }
  return Vector3(variance.cwiseSqrt());
}

}  // namespace

Band shape_band(const models::MechanicsRun& run, std::size_t step, ShapeQuantity quantity) {
  const Parts& parts = all_parts.at(static_cast<std::size_t>(quantity));
  Band result;
  result.numerical = parts.numerical(run.result.steps[step]);
  result.input = input_of(run, step, parts.input);
  if (run.model_parts.empty()) return result;
  const auto& model = run.model_parts[step].*parts.model;
  if (!model) return result;
  result.model = model->uncertainty();
  if (result.numerical && result.input)
    result.total = model->band(*result.numerical) + two_sided_95 * *result.input;
  return result;
}

FieldBands field_bands(const models::CaseResult& result, const models::FieldRun& run,
                       std::size_t step, bool change) {
  FieldBands all;
  const models::FieldStep& fields = run.steps[step].value();
  const models::MechanicsRun& shape = models::mechanics_of(run, result);
  const auto& parts = change ? fields.dB_model_part : fields.B_model_part;
  for (std::size_t s = 0; s < fields.B.size(); ++s) {
    const auto numerical = models::uncertainties(shape, run, step, s, change);
    const models::ModelPart<Vector3>* model = s < parts.size() && parts[s] ? &*parts[s] : nullptr;
    const auto input = input_of(change ? fields.dB_input_parts : fields.B_input_parts, s);
    all.model.push_back(model != nullptr ? std::optional(model->uncertainty()) : std::nullopt);
    all.input.push_back(input);
    all.total.push_back(
        model && numerical && input
            ? std::optional<Vector3>(model->band(*numerical) + two_sided_95 * *input)
            : std::nullopt);
  }
  return all;
}

}  // namespace ciliaval::compare::results
