// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/output/results.h"

#include <fmt/core.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

#include "problem/error.h"

namespace ciliaval::compare {
namespace {

using Json = nlohmann::ordered_json;

/// null if empty; nlohmann itself writes what is not finite as null.
template <class T>
Json optional(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json text_or_null(const std::string& text) {
  return text.empty() ? Json(nullptr) : Json(text);
}

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

/// A row for each sensor, null where there is none; null if there is none at all.
Json rows(const AtSensors& vectors) {
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
  if (const auto* contact = std::get_if<ContactLoad>(&load)) {
    json["force"] = contact->force;
    json["height"] = contact->height;
  } else if (const auto* flow = std::get_if<FlowLoad>(&load)) {
    json["force_per_height"] = flow->force_per_height;
  } else if (const auto* section = std::get_if<SectionLoad>(&load)) {
    json["force"] = section->force;
    json["arclength"] = section->arclength;
  } else if (const auto* dead = std::get_if<DeadLoad>(&load)) {
    json["force_per_length"] = dead->force_per_length;
  } else if (const auto* probe = std::get_if<ProbeLoad>(&load)) {
    json["displacement"] = probe->displacement;
    json["height"] = probe->height;
  }
  json["azimuth"] = azimuth(load);
  return json;
}

Json mechanics_json(const MechanicsRun& run, std::size_t index) {
  const MechanicsStep& step = run.result.steps[index];
  Json json{{"status", to_string(step.status)}, {"message", step.message}};
  json["tip"] = nullptr;
  json["tip_angle"] = nullptr;
  json["tip_uncertainty"] = nullptr;
  json["applied_force"] = nullptr;
  if (step.deformation) {
    const Centreline& centreline = step.deformation->centreline;
    const CentrelinePoint tip = centreline.at(centreline.length());
    json["tip"] = vector(tip.position);
    json["tip_angle"] = tip.theta();
    json["tip_uncertainty"] = optional(step.tip_uncertainty);
    json["applied_force"] = step.applied_force;
  }
  json["slip_off_force"] = optional(step.slip_off_force);
  if (std::holds_alternative<ProbeLoad>(step.load))
    json["slip_off_displacement"] = optional(step.slip_off_displacement);
  json["contact_arclength"] = optional(step.contact_arclength);
  json["unknowns"] = step.unknowns;
  json["iterations"] = step.iterations;
  json["seconds"] = step.seconds;
  json["centreline"] = step.deformation ? Json(step_file(run.model, index, "csv")) : Json(nullptr);
  return json;
}

Json field_json(const FieldStep& step) {
  return {{"status", step.failure.empty() ? "computed" : "failed"},
          {"message", step.failure},
          {"B", rows(step.B)},
          {"dB", rows(step.dB)},
          {"uncertainty", rows(step.uncertainty)},
          {"dB_uncertainty", rows(step.dB_uncertainty)},
          {"seconds", step.seconds}};
}

Json step_json(const CaseResult& result, std::size_t index) {
  Json json{{"load", load_json(result.problem.load_path[index])}};
  if (index < result.problem.flow_velocity.size())
    json["load"]["velocity"] = result.problem.flow_velocity[index];
  json["mechanics"] = Json::object();
  for (const MechanicsRun& run : result.mechanics)
    json["mechanics"][run.model] = mechanics_json(run, index);
  json["fields"] = Json::object();
  for (const FieldRun& run : result.fields)
    if (run.steps[index]) json["fields"][run.name()] = field_json(*run.steps[index]);
  return json;
}

Json comparison_json(const Comparison& c) {
  Json json{{"step", optional(c.step)},
            {"sensor", optional(c.sensor)},
            {"quantity", c.quantity},
            {"component", text_or_null(c.component)},
            {"statistic", c.statistic},
            {"model", c.model},
            {"reference", c.reference},
            {"difference", optional(c.difference)},
            {"relative", optional(c.relative)},
            {"scale", optional(c.scale)},
            {"unit", c.unit},
            {"uncertainty", optional(c.uncertainty)},
            {"verdict", to_string(c.verdict)}};
  if (c.statistic == "r2") {
    json["r2"] = optional(c.r2);
    json["correlation"] = optional(c.correlation);
  }
  if (!c.note.empty()) json["note"] = c.note;
  return json;
}

template <class T>
std::string csv(const std::optional<T>& value) {
  return value ? fmt::format("{}", *value + T{}) : std::string();  // −0.0 + 0.0 = 0.0
}

}  // namespace

std::string_view to_string(Status status) {
  switch (status) {
    case Status::converged:
      return "converged";
    case Status::slipped_off:
      return "slipped_off";
    case Status::failed:
      break;
  }
  return "failed";
}

std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string result = "\"";
  for (const char c : text) result += c == '"' ? std::string("\"\"") : std::string(1, c);
  return result + '"';
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

std::string summary_json(const CaseResult& result, const std::vector<Comparison>& comparisons,
                         const Provenance& provenance) {
  Json json{{"schema", 1}, {"case", result.problem.name}, {"title", result.problem.title}};
  json["provenance"] = to_json(provenance);
  json["sensors"] = Json::array();
  for (const Vector3& sensor : result.problem.sensors) json["sensors"].push_back(vector(sensor));
  json["undeformed"] = {{"fields", Json::object()}};
  for (const FieldRun& run : result.fields)
    json["undeformed"]["fields"][run.name()] = field_json(run.undeformed);
  json["steps"] = Json::array();
  for (std::size_t i = 0; i < result.problem.load_path.size(); ++i)
    json["steps"].push_back(step_json(result, i));
  json["comparisons"] = Json::array();
  for (const Comparison& c : comparisons) json["comparisons"].push_back(comparison_json(c));
  unsign_zeros(json);
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + '\n';
}

std::string errors_csv(const std::vector<Comparison>& comparisons) {
  std::string text =
      "step,sensor,quantity,component,statistic,model,reference,difference,relative,scale,unit,"
      "uncertainty,verdict,r2,correlation,note\n";
  for (const Comparison& c : comparisons)
    text +=
        fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", csv(c.step), csv(c.sensor),
                    c.quantity, c.component, c.statistic, c.model, c.reference, csv(c.difference),
                    csv(c.relative), csv(c.scale), c.unit, csv(c.uncertainty), to_string(c.verdict),
                    csv(c.r2), csv(c.correlation), csv_field(c.note));
  return text;
}

std::string centreline_csv(const Centreline& centreline) {
  std::string text = "# units: S m, x m, y m, z m, theta rad, kappa 1/m\nS,x,y,z,theta,kappa\n";
  for (const double S : output_points(centreline)) {
    const CentrelinePoint p = centreline.at(S);
    const Vector3 r = p.position.array() + 0.0;  // −0.0 + 0.0 = 0.0
    text += fmt::format("{},{},{},{},{},{}\n", S, r.x(), r.y(), r.z(), p.theta() + 0.0,
                        p.bending_curvature() + 0.0);
  }
  return text;
}

void write_text(const std::filesystem::path& file, std::string_view text) {
  const auto fail = [&](int error) {
    throw FileError("cannot write `" + file.string() + "`: " + std::strerror(error));
  };
  const auto close = [](std::FILE* f) { return std::fclose(f); };
  std::unique_ptr<std::FILE, decltype(close)> stream(std::fopen(file.c_str(), "wb"), close);
  if (!stream) fail(errno);
  if (std::fwrite(text.data(), 1, text.size(), stream.get()) != text.size()) fail(errno);
  if (std::fflush(stream.get()) != 0) fail(errno);
  if (std::fclose(stream.release()) != 0) fail(errno);
}

void replace_text(const std::filesystem::path& file, std::string_view text) {
  const std::filesystem::path unfinished = file.string() + ".tmp";
  write_text(unfinished, text);
  std::filesystem::rename(unfinished, file);
}

void write_results(const CaseResult& result, const std::vector<Comparison>& comparisons,
                   const Provenance& provenance, const std::filesystem::path& folder) {
  for (const MechanicsRun& run : result.mechanics)
    for (std::size_t i = 0; i < run.result.steps.size(); ++i)
      if (run.result.steps[i].deformation)
        write_text(folder / step_file(run.model, i, "csv"),
                   centreline_csv(run.result.steps[i].deformation->centreline));
  write_text(folder / "errors.csv", errors_csv(comparisons));
  write_text(folder / "summary.json", summary_json(result, comparisons, provenance));
}

}  // namespace ciliaval::compare
