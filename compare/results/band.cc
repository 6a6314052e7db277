// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/results/band.h"

#include <cmath>

#include "compare/models/errors.h"
#include "compare/results/quantity.h"

namespace ciliaval::compare::results {
namespace {

std::optional<double> numerical_of(const MechanicsStep& step, ShapeQuantity quantity) {
  switch (quantity) {
    case ShapeQuantity::tip:
      return step.tip_uncertainty;
    case ShapeQuantity::tip_angle:
      return step.deformation ? results::tip_angle_uncertainty(step) : std::nullopt;
    case ShapeQuantity::applied_force:
      return step.applied_force_uncertainty;
    case ShapeQuantity::slip_off:
      break;
  }
  return step.slip_off_uncertainty;
}

const std::optional<models::ModelPart<double>>& model_of(const models::ShapeModelParts& parts,
                                                         ShapeQuantity quantity) {
  switch (quantity) {
    case ShapeQuantity::tip:
      return parts.tip;
    case ShapeQuantity::tip_angle:
      return parts.tip_angle;
    case ShapeQuantity::applied_force:
      return parts.applied_force;
    case ShapeQuantity::slip_off:
      break;
  }
  return parts.slip_off;
}

std::optional<double> size_of(const models::ShapeShift& shift, ShapeQuantity quantity) {
  switch (quantity) {
    case ShapeQuantity::tip:
      return shift.tip ? std::optional(shift.tip->norm()) : std::nullopt;
    case ShapeQuantity::tip_angle:
      return shift.tip_angle;
    case ShapeQuantity::applied_force:
      return shift.applied_force;
    case ShapeQuantity::slip_off:
      break;
  }
  return shift.slip_off;
}

std::optional<double> input_of(const models::MechanicsRun& run, std::size_t step,
                               ShapeQuantity quantity) {
  double variance = 0;
  if (!run.input_parts.empty())
    for (const models::ShapeShift& shift : run.input_parts[step]) {
      const std::optional<double> size = size_of(shift, quantity);
      if (!size) return std::nullopt;
      variance += *size * *size;
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
  Band result;
  result.numerical = numerical_of(run.result.steps[step], quantity);
  result.input = input_of(run, step, quantity);
  if (run.model_parts.empty()) return result;
  const auto& model = model_of(run.model_parts[step], quantity);
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
  const auto& parts = change ? fields.dB_model_part : fields.B_model_part;
  for (std::size_t s = 0; s < fields.B.size(); ++s) {
    const auto numerical = models::uncertainties(result, run, step, s, change);
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
