// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/output/results.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <type_traits>
#include <utility>
#include <variant>

#include "compare/models/magnet_forces.h"
#include "compare/output/csv_writer.h"
#include "compare/output/json_file.h"
#include "compare/output/output_file.h"
#include "compare/output/sweep.h"
#include "compare/results/band.h"
#include "compare/results/external_field.h"
#include "compare/results/quantity.h"
#include "problem/description/environment.h"

namespace ciliaval::compare::output {
namespace {

using Json = nlohmann::ordered_json;

/// −0.0 → 0.0: the sign of a zero means nothing to a reader.
void unsign_zeros(Json& json) {
  if (json.is_structured())
    for (Json& element : json) unsign_zeros(element);
  else if (json.is_number_float() && json.get<double>() == 0)
    json = 0.0;
}

Json vector(const Vector3& v) {
  return {v.x(), v.y(), v.z()};
}

Json value(const description::Value& value) {
  return std::visit(
      [](const auto& v) -> Json {
        if constexpr (std::is_same_v<std::decay_t<decltype(v)>, Vector3>)
          return vector(v);
        else
          return v;
      },
      value);
}

/// A row for each sensor, null where there is none; null if there is none at all.
Json rows(const models::AtSensors& vectors) {
  Json result = Json::array();
  bool any = false;
  for (const std::optional<Vector3>& v : vectors) {
    result.push_back(v ? vector(*v) : Json(nullptr));
    any = any || v;
  }
  return any ? result : Json(nullptr);
}

Json load_json(const Load& load) {
  Json json{{"type", type(load)}};
  for (std::size_t i = 0; i < load.values().size(); ++i)
    json[std::string(load.type().parameters[i].name)] = load.values()[i];
  for (const auto& setting : load.type().settings)
    if (setting.get(load) != setting.initial)
      json[std::string(setting.name)] = value(setting.get(load));
  for (const LoadTable& table : load.type().tables)
    for (const auto& setting : table.keys)
      if (setting.get(load) != setting.initial)
        json[std::string(table.name)][std::string(setting.name)] = value(setting.get(load));
  return json;
}

/// The values of a struct by their keys, without those that are another way to state one.
template <class T>
Json described(const T& owner) {
  Json json = Json::object();
  for (const description::Field<T>& field : description::fields<T>())
    if (field.in_place_of.empty() && field.belongs(owner))
      json[std::string(field.name)] = value(field.get(owner));
  return json;
}

Json environment_json(const surroundings::Environment& environment) {
  Json json = described(environment);
  for (const surroundings::magnets::Magnet& magnet : environment.magnets)
    json["magnets"].push_back(described(magnet));
  return json;
}

Json contact_json(const SurfaceContact& contact) {
  const bool touches = contact.state != SurfaceContact::State::open;
  return {{"state", to_string(contact.state)},
          {"where", touches ? Json(to_string(contact.where)) : Json(nullptr)},
          {"normal_force", contact.normal_force},
          {"friction_force", contact.friction_force},
          {"point", touches ? vector(contact.point) : Json(nullptr)},
          {"elastic_energy", contact.elastic_energy},
          {"surface_work", contact.surface_work},
          {"friction_work", contact.friction_work}};
}

Json balance_json(const EnergyBalance& balance) {
  return {{"surface_work", balance.surface_work},
          {"friction_work", balance.friction_work},
          {"energy_lost", balance.energy_lost},
          {"stored", balance.stored},
          {"rest", balance.rest()},
          {"relative_rest", balance.relative_rest()}};
}

Json pull_in_json(const continuation::PullIn& pull_in) {
  Json json{{"fraction", pull_in.fraction},   {"load", pull_in.load},
            {"magnet", pull_in.magnet},       {"tip", vector(pull_in.tip)},
            {"tip_angle", pull_in.tip_angle}, {"approach", Json::array()}};
  for (const continuation::ApproachToFold& at : pull_in.approach)
    json["approach"].push_back(
        {{"fraction", at.fraction}, {"smallest_eigenvalue", at.smallest_eigenvalue}});
  return json;
}

/// The parts of the bands of a shape; null where one is not known.
void add_bands(const models::MechanicsRun& run, std::size_t index, Json& json) {
  for (std::size_t i = 0; i < results::shape_quantities.size(); ++i) {
    const char* name = results::shape_quantities[i];
    const results::Band parts =
        results::shape_band(run, index, static_cast<results::ShapeQuantity>(i));
    json["model_uncertainty"][name] = or_null(parts.model);
    if (!run.input_parts.empty()) json["input_uncertainty"][name] = or_null(parts.input);
    json["band"][name] = or_null(parts.total);
  }
  if (!run.model_parts.empty() && !run.model_parts[index].unknown.empty())
    json["model_uncertainty_unknown"] = run.model_parts[index].unknown;
}

Json mechanics_json(const models::MechanicsRun& run, std::size_t index) {
  const MechanicsStep& step = run.result.steps[index];
  Json json{{"status", to_string(step.status)}, {"message", step.message}};
  for (const results::Quantity& quantity : results::quantities()) {
    if (!quantity.is_in_summary || (quantity.belongs && !quantity.belongs(step))) continue;
    const std::vector<double> values = quantity.values(step);
    Json& number = json[std::string(quantity.name)];
    if (values.empty())
      number = nullptr;
    else if (quantity.components.empty())
      number = or_null(values.front());
    else
      number = values;
  }
  if (slip_off_limit(step))
    json["slip_off_at"] = step.slip_off_point == SlipOffPoint::rim ? "rim" : "axis";
  if (!run.model_parts.empty() || !run.input_parts.empty()) add_bands(run, index, json);
  if (step.touch)
    json["contact_state"] = step.touch->state == ProbeContact::State::stick ? "stick" : "slip";
  if (step.contact) json["contact"] = contact_json(*step.contact);
  if (step.contact && step.contact->energy_lost)
    json["jump"] = {{"energy_lost", *step.contact->energy_lost}};
  if (step.unstable_modes) json["unstable_modes"] = *step.unstable_modes;
  if (step.pull_in) json["pull_in"] = pull_in_json(*step.pull_in);
  json["unknowns"] = step.unknowns;
  json["iterations"] = step.iterations;
  json["seconds"] = step.seconds;
  json["centreline"] = step.deformation ? Json(step_file(run.model, index, "csv")) : Json(nullptr);
  return json;
}

/// A number for each sensor, null where it is not known.
Json numbers(const std::vector<std::optional<double>>& values) {
  Json result = Json::array();
  for (const std::optional<double>& value : values) result.push_back(or_null(value));
  return result;
}

/// Field of the straight cilium, whose shape has no error.
Json field_json(const models::FieldStep& step) {
  return {{"status", step.failure.empty() ? "computed" : "failed"},
          {"message", step.failure.empty() ? step.remark : step.failure},
          {"B", rows(step.B)},
          {"dB", rows(step.dB)},
          {"uncertainty", rows(step.uncertainty)},
          {"dB_uncertainty", rows(step.dB_uncertainty)},
          {"seconds", step.seconds}};
}

/// The uncertainties are the sums of the field model's own, and of what the shape's error carries
/// into B and ΔB, in any direction.
Json field_json(const models::CaseResult& result, const models::FieldRun& run, std::size_t index) {
  const models::FieldStep& step = run.steps[index].value();
  const models::MechanicsRun& shape = models::mechanics_of(run, result);
  Json json = field_json(step);
  for (const auto& [change, prefix] : {std::pair(false, ""), std::pair(true, "dB_")}) {
    models::AtSensors sums;
    std::vector<std::optional<double>> of_shape;
    for (std::size_t s = 0; s < step.B.size(); ++s) {
      sums.push_back(models::uncertainties(shape, run, index, s, change));
      const auto value = models::field_value(run, shape, index, s, change);
      of_shape.push_back(value ? value->from_mechanics : std::nullopt);
    }
    json[fmt::format("{}uncertainty", prefix)] = rows(sums);
    json[fmt::format("{}uncertainty_of_field", prefix)] =
        rows(change ? step.dB_uncertainty : step.uncertainty);
    json[fmt::format("{}uncertainty_of_shape", prefix)] = numbers(of_shape);
    const results::FieldBands bands = results::field_bands(result, run, index, change);
    json[fmt::format("{}model_uncertainty", prefix)] = rows(bands.model);
    json[fmt::format("{}band", prefix)] = rows(bands.total);
    const auto& inputs = change ? step.dB_input_parts : step.B_input_parts;
    if (inputs.empty()) continue;
    json[fmt::format("{}input_uncertainty", prefix)] = rows(bands.input);
    for (const models::AtSensors& of_input : inputs)
      json[fmt::format("{}input_contributions", prefix)].push_back(rows(of_input));
  }
  if (!step.model_part_unknown.empty()) json["model_uncertainty_unknown"] = step.model_part_unknown;
  return json;
}

/// What a chip reads beyond the straight cilium without an environment: dB and the external field.
models::AtSensors reading(const models::FieldStep& step, const std::vector<Vector3>& external) {
  models::AtSensors result = step.dB;
  for (std::size_t s = 0; s < result.size(); ++s)
    if (result[s]) *result[s] += external[s];
  return result;
}

Json step_json(const models::CaseResult& result, const std::vector<std::vector<Vector3>>& external,
               std::size_t index) {
  Json json{{"load", load_json(result.problem.load_path[index])}};
  if (const auto velocity = input::stated_values(result.problem, "velocity"); !velocity.empty())
    json["load"]["velocity"] = velocity[index];
  const surroundings::Environment& environment = result.problem.load_path[index].environment();
  if (!surroundings::is_empty(environment)) json["environment"] = environment_json(environment);
  json["mechanics"] = Json::object();
  for (const models::MechanicsRun& run : result.mechanics) {
    json["mechanics"][run.model] = mechanics_json(run, index);
    for (const models::MagnetForce& magnet :
         models::forces_on_magnets(result.problem.cilium, run.result.steps[index]))
      json["forces_on_magnets"][run.model].push_back({{"name", magnet.name},
                                                      {"force", vector(magnet.force)},
                                                      {"torque", vector(magnet.torque)}});
  }
  if (!external.empty())
    for (const Vector3& B : external[index]) json["B_external"].push_back(vector(B));
  json["fields"] = Json::object();
  for (const models::FieldRun& run : result.fields) {
    if (!run.steps[index]) continue;
    Json& field = json["fields"][run.name()] = field_json(result, run, index);
    if (!external.empty() && !run.measured)
      field["reading"] = rows(reading(*run.steps[index], external[index]));
  }
  return json;
}

Json comparison_json(const models::Comparison& c) {
  Json json{{"step", c.step ? Json(*c.step) : Json(nullptr)},
            {"sensor", c.sensor ? Json(*c.sensor) : Json(nullptr)},
            {"quantity", c.quantity},
            {"component", or_null(c.component)},
            {"statistic", c.statistic},
            {"model", c.model},
            {"reference", c.reference},
            {"difference", or_null(c.difference)},
            {"relative", or_null(c.relative)},
            {"scale", or_null(c.scale)},
            {"unit", c.unit},
            {"uncertainty", or_null(c.uncertainty)},
            {"verdict", to_string(c.verdict)}};
  if (c.statistic == "r2") {
    json["r2"] = or_null(c.r2);
    json["correlation"] = or_null(c.correlation);
  }
  if (!c.note.empty()) json["note"] = c.note;
  return json;
}

/// A sensor's name, or its number where it has none; empty for none.
std::string sensor_cell(std::optional<std::size_t> sensor, std::span<const std::string> names) {
  if (!sensor) return {};
  return *sensor < names.size() ? names[*sensor] : std::to_string(*sensor);
}

}  // namespace

std::string_view to_string(Status status) {
  switch (status) {
    case Status::converged:
      return "converged";
    case Status::slipped_off:
      return "slipped_off";
    case Status::pulled_in:
      return "pulled_in";
    case Status::failed:
      break;
  }
  return "failed";
}

std::string_view to_string(SurfaceContact::State state) {
  switch (state) {
    case SurfaceContact::State::open:
      return "open";
    case SurfaceContact::State::stick:
      return "stick";
    case SurfaceContact::State::slip:
      break;
  }
  return "slip";
}

std::string_view to_string(SurfaceContact::Where where) {
  switch (where) {
    case SurfaceContact::Where::rim:
      return "rim";
    case SurfaceContact::Where::mantle:
      return "mantle";
    case SurfaceContact::Where::surface:
      break;
  }
  return "surface";
}

std::string step_file(std::string_view series, std::size_t step, std::string_view extension) {
  return fmt::format("{}_{:04}.{}", series, step, extension);
}

std::vector<double> output_points(const Centreline& centreline) {
  const double L = centreline.length();
  std::vector<double> points = centreline.breaks();
  for (int i = 0; i <= 200; ++i) points.push_back(L * (i / 200.0));
  std::sort(points.begin(), points.end());
  std::vector<double> result;
  for (const double S : points)
    if (result.empty() || S - result.back() > 1e-9 * L) result.push_back(S);
  result.back() = L;
  return result;
}

std::string summary_json(const models::CaseResult& result,
                         const std::vector<models::Comparison>& comparisons,
                         const Provenance& provenance, std::string_view validation) {
  Json json{{"schema", 1}, {"case", result.problem.name}, {"title", result.problem.title}};
  json["provenance"] = to_json(provenance);
  json["sensors"] = Json::array();
  for (const Vector3& sensor : result.problem.sensors) json["sensors"].push_back(vector(sensor));
  json["sensor_names"] = input::sensor_names(result.problem);
  if (!result.inputs.empty()) json["inputs"] = result.inputs;
  if (!result.unstated_touch.empty()) json["unstated_touch"] = result.unstated_touch;
  json["undeformed"] = {{"fields", Json::object()}};
  for (const models::FieldRun& run : result.fields)
    json["undeformed"]["fields"][run.name()] = field_json(run.undeformed);
  json["steps"] = Json::array();
  const auto external = results::external_field(result.problem);
  for (std::size_t i = 0; i < result.problem.load_path.size(); ++i)
    json["steps"].push_back(step_json(result, external, i));
  if (is_sweep(result.problem))
    for (const models::MechanicsRun& run : result.mechanics)
      json["energy_balance"][run.model] = balance_json(energy_balance(run));
  json["comparisons"] = Json::array();
  for (const models::Comparison& c : comparisons) json["comparisons"].push_back(comparison_json(c));
  if (!validation.empty()) json["validation"] = Json::parse(validation);
  unsign_zeros(json);
  return to_text(json);
}

std::string errors_csv(const std::vector<models::Comparison>& comparisons,
                       std::span<const std::string> sensors) {
  CsvWriter csv;
  csv.row("step", "sensor", "quantity", "component", "statistic", "model", "reference",
          "difference", "relative", "scale", "unit", "uncertainty", "verdict", "r2", "correlation",
          "note");
  for (const models::Comparison& c : comparisons)
    csv.row(c.step, sensor_cell(c.sensor, sensors), c.quantity, c.component, c.statistic, c.model,
            c.reference, c.difference, c.relative, c.scale, c.unit, c.uncertainty,
            to_string(c.verdict), c.r2, c.correlation, c.note);
  return csv.text();
}

std::string fields_csv(const models::CaseResult& result) {
  const input::Case& problem = result.problem;
  CsvWriter csv;
  csv.column("step");
  for (const LoadParameter& parameter : problem.load_path.front().type().parameters)
    csv.column(parameter.name, parameter.quantity.unit);
  csv.column("sensor");
  csv.column("pair");
  for (const char* quantity : {"B_", "dB_", "uncertainty_", "band_"})
    csv.vector_columns(quantity, "T");
  const auto external = results::external_field(problem);
  if (!external.empty()) csv.vector_columns("reading_", "T");
  csv.end_row();
  for (std::size_t step = 0; step < problem.load_path.size(); ++step)
    for (std::size_t sensor = 0; sensor < problem.sensors.size(); ++sensor)
      for (const models::FieldRun& run : result.fields) {
        const std::optional<models::FieldStep>& field = run.steps[step];
        csv.add(step);
        for (const double value : problem.load_path[step].values()) csv.add(value);
        csv.add(input::sensor_name(problem, sensor));
        csv.add(run.name());
        csv.add(field ? field->B[sensor] : std::nullopt);
        csv.add(field ? field->dB[sensor] : std::nullopt);
        csv.add(models::uncertainties(models::mechanics_of(run, result), run, step, sensor, true));
        csv.add(field ? results::field_bands(result, run, step, true).total[sensor] : std::nullopt);
        if (!external.empty())
          csv.add(field && !run.measured ? reading(*field, external[step])[sensor] : std::nullopt);
        csv.end_row();
      }
  return csv.text();
}

std::string centreline_csv(const Centreline& centreline) {
  CsvWriter csv;
  csv.column("S", "m");
  csv.vector_columns("", "m");
  csv.column("theta", "rad");
  csv.column("kappa", "1/m");
  csv.end_row();
  for (const double S : output_points(centreline)) {
    const CentrelinePoint p = centreline.at(S);
    csv.row(S, p.position.x(), p.position.y(), p.position.z(), p.theta(), p.bending_curvature());
  }
  return csv.text();
}

std::vector<ResultFile> result_files(const models::CaseResult& result,
                                     const std::vector<models::Comparison>& comparisons,
                                     const Provenance& provenance, std::string_view validation) {
  std::vector<ResultFile> files;
  for (const models::MechanicsRun& run : result.mechanics)
    for (std::size_t i = 0; i < run.result.steps.size(); ++i)
      if (const auto& deformation = run.result.steps[i].deformation)
        files.push_back({step_file(run.model, i, "csv"),
                         [&deformation] { return centreline_csv(deformation->centreline); }});
  if (is_sweep(result.problem)) files.push_back({"sweep.csv", [&] { return sweep_csv(result); }});
  if (!result.fields.empty()) files.push_back({"fields.csv", [&] { return fields_csv(result); }});
  files.push_back(
      {"errors.csv", [&] { return errors_csv(comparisons, input::sensor_names(result.problem)); }});
  files.push_back({"summary.json", [&, provenance, validation = std::string(validation)] {
                     return summary_json(result, comparisons, provenance, validation);
                   }});
  return files;
}

void write_results(const models::CaseResult& result,
                   const std::vector<models::Comparison>& comparisons, const Provenance& provenance,
                   const std::filesystem::path& folder, std::string_view validation) {
  for (const ResultFile& file : result_files(result, comparisons, provenance, validation))
    write_file(folder / file.name, file.text());
}

}  // namespace ciliaval::compare::output
