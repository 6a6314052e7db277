// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/validation/validation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "compare/models/errors.h"
#include "compare/validation/computed.h"
#include "compare/validation/sensitivity.h"

namespace ciliaval::compare::validation {
namespace {

using input::measurement::Measurand;
using input::measurement::Measurement;

/// A series that is to be made: a mechanics run, and of a field its field run.
struct Planned {
  const models::MechanicsRun* mechanics;  ///< of readings, which belong to no shape, not used
  const models::FieldRun* field;          ///< null: of the shape
  Measurand measurand;
  std::vector<std::size_t> measurements;
  std::optional<Stand> stand;

  std::string model() const { return field != nullptr ? field->name() : mechanics->model; }
};

std::vector<Measurand> measurands_of(const std::vector<Measurement>& measurements) {
  std::vector<Measurand> result;
  for (const Measurement& m : measurements)
    if (std::ranges::find(result, m.measurand) == result.end()) result.push_back(m.measurand);
  return result;
}

std::vector<Planned> plan(const models::CaseResult& result, Sensitivities whose,
                          std::span<const models::MechanicsEntry> mechanics,
                          std::span<const models::FieldEntry> fields) {
  const input::Case& problem = result.problem;
  const auto& measurements = problem.measured.measurements;
  std::vector<Planned> all;
  for (const Measurand& measurand : measurands_of(measurements)) {
    std::vector<std::size_t> indices;
    for (std::size_t m = 0; m < measurements.size(); ++m)
      if (measurements[m].measurand == measurand) indices.push_back(m);
    const auto add = [&](const models::MechanicsRun* shape, const models::FieldRun* field) {
      all.push_back(
          {shape, field, measurand, indices,
           stand_in(field != nullptr ? field->mechanics : shape->model,
                    field != nullptr ? field->field : "", whose, problem, mechanics, fields)});
    };
    if (!measurand.is_field()) {
      for (const models::MechanicsRun& run : result.mechanics) add(&run, nullptr);
      continue;
    }
    for (const models::FieldRun& run : result.fields) add(&models::mechanics_of(run, result), &run);
  }
  return all;
}

Computed computed_of(const Planned& planned, const input::Case& problem, std::size_t step) {
  if (planned.field != nullptr)
    return computed(planned.measurand, *planned.field, *planned.mechanics, step);
  return computed(planned.measurand, *planned.mechanics, step, direction(problem.load_path[step]));
}

Point point_of(const Computed& model, const Measurement& measured, std::size_t index,
               const Contributions* of_inputs) {
  Point point;
  point.measured = measured;
  point.simulated = model.value;
  point.u_num = model.numerical;
  point.note = model.note;
  double variance = 0;
  bool is_known = of_inputs != nullptr;
  if (of_inputs != nullptr)
    for (const auto& row : *of_inputs) {
      point.contributions.push_back(row[index]);
      variance += std::pow(row[index].value_or(0), 2);
      is_known = is_known && row[index];
    }
  if (is_known) point.u_input = std::sqrt(variance);
  if (!point.note.empty()) return point;
  if (!point.u_num)
    point.note = "u_num is not known";
  else if (!point.u_input)
    point.note = "u_input is not known: with an input shifted, no model has a value";
  else if (point.simulated)
    point.assessment = assess(*point.simulated, measured.value,
                              {*point.u_num, *point.u_input, measured.uncertainty});
  return point;
}

/// χ² and r.m.s. of the points that are assessed.
void summarise(Series& series, std::size_t inputs) {
  std::vector<const Point*> known;
  for (const Point& point : series.points)
    if (point.assessment) known.push_back(&point);
  series.assessed = known.size();
  if (known.empty()) return;
  const auto n = static_cast<Eigen::Index>(known.size());
  Eigen::VectorXd errors(n);
  Eigen::VectorXd variances(n);
  Eigen::MatrixXd C(n, static_cast<Eigen::Index>(inputs));
  for (Eigen::Index i = 0; i < n; ++i) {
    const Point& point = *known[static_cast<std::size_t>(i)];
    errors[i] = point.assessment->error;
    variances[i] = std::pow(*point.u_num, 2) + std::pow(point.measured.uncertainty, 2);
    for (std::size_t k = 0; k < inputs; ++k)
      C(i, static_cast<Eigen::Index>(k)) = *point.contributions[k];
  }
  series.chi_squared = chi_squared(errors, variances, C);
  series.rms_error = errors.norm() / std::sqrt(static_cast<double>(n));
}

std::vector<std::string> remarks_of(const Validation& validation) {
  std::vector<std::string> remarks;
  if (validation.inputs.empty())
    remarks.emplace_back(
        "no [[input_uncertainty]] is stated: u_input is 0, and what the inputs' errors make counts "
        "as the model's");
  const Series* last = nullptr;  // the models' values are the same
  for (const Series& series : validation.series) {
    const std::size_t fitted = series.fitted();
    const bool is_first = last == nullptr || !(last->measurand() == series.measurand());
    last = &series;
    if (fitted == 0 || !is_first) continue;
    remarks.push_back(
        fmt::format("{}: parameters were fitted to {} of the {} values: there the difference says "
                    "nothing of the model's error elsewhere",
                    series.measurand().name, fitted, series.points.size()));
  }
  return remarks;
}

}  // namespace

std::size_t Series::count(Verdict verdict) const {
  return static_cast<std::size_t>(std::ranges::count_if(
      points, [&](const Point& point) { return point.verdict() == verdict; }));
}

std::size_t Series::seen_with(double factor_of_u_D, double factor_of_u_input) const {
  return static_cast<std::size_t>(std::ranges::count_if(points, [&](const Point& point) {
    return point.assessment && assess(*point.simulated, point.measured.value,
                                      {*point.u_num, factor_of_u_input * *point.u_input,
                                       factor_of_u_D * point.measured.uncertainty})
                                       .verdict == Verdict::bounded;
  }));
}

std::size_t Series::fitted() const {
  return static_cast<std::size_t>(
      std::ranges::count_if(points, [](const Point& point) { return point.measured.fitted; }));
}

std::optional<Validation> validate(const models::CaseResult& result,
                                   std::span<const models::MechanicsEntry> mechanics,
                                   std::span<const models::FieldEntry> fields,
                                   const Progress& progress, Sensitivities whose) {
  const input::Case& problem = result.problem;
  if (problem.measured.measurements.empty()) return std::nullopt;
  Validation validation;
  validation.inputs = read_inputs(problem);
  validation.domain = domain_of(problem);
  const std::vector<Planned> all = plan(result, whose, mechanics, fields);
  std::set<Stand> stands;
  for (const Planned& planned : all)
    if (planned.stand) stands.insert(*planned.stand);
  const std::map<Stand, Contributions> of_stands =
      contributions(problem, validation.inputs, stands, mechanics, fields, progress);
  const Contributions no_inputs;
  for (const Planned& planned : all) {
    Series series;
    series.model = planned.model();
    if (planned.stand && !validation.inputs.empty())
      series.sensitivities_by = planned.stand->name();
    const Contributions* of_inputs = validation.inputs.empty() ? &no_inputs
                                     : planned.stand           ? &of_stands.at(*planned.stand)
                                                               : nullptr;
    for (const std::size_t m : planned.measurements) {
      const Measurement& measured = problem.measured.measurements[m];
      series.points.push_back(
          point_of(computed_of(planned, problem, measured.step), measured, m, of_inputs));
    }
    summarise(series, validation.inputs.size());
    validation.series.push_back(std::move(series));
  }
  validation.remarks = remarks_of(validation);
  std::ranges::copy(problem.measured.remarks, std::back_inserter(validation.remarks));
  return validation;
}

}  // namespace ciliaval::compare::validation
