// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/convergence/study.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <utility>

#include "compare/models/registry.h"
#include "compare/models/run.h"
#include "compare/output/csv_writer.h"
#include "compare/output/text_table.h"
#include "compare/regression/quantities.h"
#include "problem/error.h"

namespace ciliaval::compare::convergence {
namespace {

using Json = nlohmann::ordered_json;

/// What one level gave, by id.
struct LevelResult {
  double size = 0;
  std::map<std::string, regression::Measurement> quantities;
};

/// Adds the lengths of the vectors that people look at first.
void add_lengths(std::map<std::string, regression::Measurement>& quantities) {
  std::vector<regression::Measurement> lengths;
  for (const auto& [id, x] : quantities) {
    if (!id.ends_with("/x")) continue;
    const std::string vector = id.substr(0, id.size() - 2);
    const double y = quantities.at(vector + "/y").value;
    regression::Measurement length = x;
    if (vector.ends_with("/tip")) {
      length.id = vector + "/deflection";
      length.value = std::hypot(x.value, y);
      lengths.push_back(std::move(length));
    } else if (vector.find("/dB/") != std::string::npos) {
      length.id = vector + "/norm";
      length.value = std::hypot(x.value, y, quantities.at(vector + "/z").value);
      lengths.push_back(std::move(length));
    }
  }
  for (regression::Measurement& length : lengths) quantities.emplace(length.id, std::move(length));
}

Progress named(const Progress& progress, const ModelRefinement& refinement, double value) {
  if (!progress) return {};
  return [&progress, prefix = fmt::format("{} {:g}: ", refinement.option.name, value)](
             const std::string& text) { progress(prefix + text); };
}

/// The first of the case's mechanics models, the cheapest first, that gives the field model what it
/// needs.
models::MechanicsRun mechanics_for(const models::FieldEntry& field, const input::Case& problem,
                                   const Progress& progress) {
  for (const models::MechanicsEntry& entry : models::mechanics_models()) {
    if (std::find(problem.mechanics.begin(), problem.mechanics.end(), entry.id) ==
        problem.mechanics.end())
      continue;
    models::MechanicsRun run =
        models::run_mechanics(entry.id, *entry.make(problem.options), problem, progress, {});
    const Deformation& undeformed = run.result.undeformed;
    if (!undeformed.centreline.pieces().empty() && (!field.has_body || undeformed.body)) return run;
  }
  throw InputError("none of the case's own mechanics models gives what the field model needs");
}

/// What makes a study of this level impossible; else empty.
std::string failure_of(const models::CaseResult& result, const ModelRefinement& refinement) {
  for (const models::MechanicsRun& run : result.mechanics)
    for (const MechanicsStep& step : run.result.steps)
      if (step.status == Status::failed) return step.message;
  if (!refinement.is_field) return {};
  for (const models::FieldRun& run : result.fields)
    for (const auto& step : run.steps)
      if (step && !step->any()) return step->failure;
  return {};
}

double seconds_of(const models::CaseResult& result, bool is_field) {
  double seconds = 0;
  if (is_field)
    for (const models::FieldRun& run : result.fields) {
      seconds += run.undeformed.seconds;
      for (const auto& step : run.steps)
        if (step) seconds += step->seconds;
    }
  else
    for (const models::MechanicsRun& run : result.mechanics)
      for (const MechanicsStep& step : run.result.steps) seconds += step.seconds;
  return seconds;
}

/// Runs a mechanics model, and the fields on it, at each value of its option.
std::vector<models::CaseResult> run_mechanics_levels(input::Case problem,
                                                     const ModelRefinement& refinement,
                                                     std::span<const double> values,
                                                     const Progress& progress) {
  std::vector<models::CaseResult> results;
  problem.mechanics = {refinement.model};
  problem.external.clear();  // the same at every level
  if (refinement.sequence.law == input::Refinement::Law::tolerance) problem.fields.clear();
  for (const double value : values) {
    refinement.set(problem.options, value);
    results.push_back(models::run(problem, models::mechanics_models(), models::field_models(),
                                  named(progress, refinement, value)));
  }
  return results;
}

/// Runs a field model at each value of its option, on one deformation.
std::vector<models::CaseResult> run_field_levels(input::Case problem,
                                                 const ModelRefinement& refinement,
                                                 std::span<const double> values,
                                                 const Progress& progress) {
  const models::FieldEntry& entry = models::entry_of(models::field_models(), refinement.model);
  std::vector<models::CaseResult> results;
  std::optional<models::MechanicsRun> mechanics;
  for (const double value : values) {
    refinement.set(problem.options, value);
    const auto field = entry.make(problem.options);
    if (!mechanics) mechanics = mechanics_for(entry, problem, progress);
    results.push_back({problem,
                       {*mechanics},
                       {models::run_field(refinement.model, *field, *mechanics, problem,
                                          named(progress, refinement, value))}});
  }
  return results;
}

LevelResult level_of(const models::CaseResult& result, const ModelRefinement& refinement,
                     double value) {
  LevelResult level{refinement.sequence.size(value), {}};
  for (regression::Measurement& quantity : regression::measurements(result).quantities)
    if (!quantity.id.ends_with("/tip_uncertainty") &&
        (!refinement.is_field || quantity.id.find("/mechanics/") == std::string::npos))
      level.quantities.emplace(quantity.id, std::move(quantity));
  add_lengths(level.quantities);
  return level;
}

Extrapolation extrapolation_of(const std::vector<RefinementLevel>& levels,
                               const regression::Measurement& finest,
                               const ModelRefinement& refinement) {
  if (refinement.sequence.law == input::Refinement::Law::power)
    return extrapolate(levels, refinement.sequence.formal_order,
                       refinement.rounding * finest.scale);
  // ΔB is the difference of two fields, each within the tolerance.
  const double parts = finest.id.find("/dB/") == std::string::npos ? 1 : 2;
  return kept_tolerances(levels, parts * finest.scale);
}

/// The quantities that every level has.
void extrapolate_all(const std::vector<LevelResult>& levels, const ModelRefinement& refinement,
                     RefinementStudy& study) {
  for (const auto& [id, finest] : levels.front().quantities) {
    ConvergedQuantity quantity{id, finest.unit, {}, {}};
    bool everywhere = true;
    for (const LevelResult& level : levels) {
      const auto found = level.quantities.find(id);
      everywhere = everywhere && found != level.quantities.end();
      if (everywhere) quantity.levels.push_back({level.size, found->second.value});
    }
    if (everywhere)
      quantity.extrapolation = extrapolation_of(quantity.levels, finest, refinement);
    else
      quantity.extrapolation.reason = "not every level has it";
    study.quantities.push_back(std::move(quantity));
  }
}

/// Whether the table shows it: what people look at.
bool is_shown(const std::string& id) {
  return id.find("/tip/") != std::string::npos || id.ends_with("/tip_angle") ||
         id.find("slip_off") != std::string::npos || id.find("/dB/") != std::string::npos;
}

Json quantity_json(const ConvergedQuantity& quantity) {
  const Extrapolation& e = quantity.extrapolation;
  Json json{{"id", quantity.id}, {"unit", quantity.unit}, {"levels", Json::array()}};
  for (const RefinementLevel& level : quantity.levels)
    json["levels"].push_back({{"size", level.size}, {"value", level.value}});
  json["conclusive"] = e.conclusive;
  json["reason"] = e.reason.empty() ? Json(nullptr) : Json(e.reason);
  json["order"] = e.order ? Json(*e.order) : Json(nullptr);
  json["limit"] = e.conclusive ? Json(e.limit) : Json(nullptr);
  json["uncertainty"] = e.conclusive ? Json(e.uncertainty) : Json(nullptr);
  json["safety"] = e.conclusive ? Json(e.safety) : Json(nullptr);
  return json;
}

std::string text_or_none(const Json& json) {
  return json.is_null() ? std::string() : json.get<std::string>();
}

ConvergedQuantity read_quantity(const Json& json) {
  ConvergedQuantity quantity{
      json.at("id").get<std::string>(), json.at("unit").get<std::string>(), {}, {}};
  for (const Json& level : json.at("levels"))
    quantity.levels.push_back({level.at("size").get<double>(), level.at("value").get<double>()});
  Extrapolation& e = quantity.extrapolation;
  e.conclusive = json.at("conclusive").get<bool>();
  e.reason = text_or_none(json.at("reason"));
  if (!json.at("order").is_null()) e.order = json["order"].get<double>();
  if (e.conclusive) {
    e.limit = json.at("limit").get<double>();
    e.uncertainty = json.at("uncertainty").get<double>();
    e.safety = json.at("safety").get<double>();
  }
  return quantity;
}

}  // namespace

RefinementStudy refinement_study(const input::Case& problem, const ModelRefinement& refinement,
                                 unsigned int count, const Progress& progress) {
  RefinementStudy study{refinement.model,
                        std::string(refinement.option.name),
                        std::string(refinement.sequence.size_name),
                        {},
                        {},
                        {},
                        {}};
  if (count < 3)
    throw InputError(fmt::format("a study needs 3 levels of refinement or more, not {}", count));
  const auto values = std::span(refinement.sequence.values)
                          .first(std::min<std::size_t>(count, refinement.sequence.values.size()));
  const std::vector<models::CaseResult> results =
      refinement.is_field ? run_field_levels(problem, refinement, values, progress)
                          : run_mechanics_levels(problem, refinement, values, progress);
  std::vector<LevelResult> levels;
  for (std::size_t i = results.size(); i-- > 0;) {
    study.settings.push_back(values[i]);
    study.seconds.push_back(seconds_of(results[i], refinement.is_field));
    levels.push_back(level_of(results[i], refinement, values[i]));
    if (const std::string failure = failure_of(results[i], refinement); !failure.empty())
      study.failure = fmt::format("{} {:g}: {}", refinement.option.name, values[i], failure);
  }
  if (study.failure.empty()) extrapolate_all(levels, refinement, study);
  return study;
}

std::string study_text(const std::vector<RefinementStudy>& studies) {
  std::string text;
  for (const RefinementStudy& study : studies) {
    text += fmt::format("{}, {} {:g} ({:.3g} s)\n", study.model, study.option,
                        fmt::join(study.settings, ", "), fmt::join(study.seconds, ", "));
    if (!study.failure.empty()) {
      text += fmt::format("  inconclusive: {}\n", study.failure);
      continue;
    }
    output::TextRows rows{{"quantity", "finest", "order", "extrapolated", "+-", "unit"}};
    for (const ConvergedQuantity& quantity : study.quantities) {
      if (!is_shown(quantity.id)) continue;
      const Extrapolation& e = quantity.extrapolation;
      if (e.conclusive) {
        rows.push_back(
            {quantity.id, output::number_cell(quantity.levels.front().value, 1, "{:.9g}"),
             output::number_cell(e.order, 1, "{:.2f}"), output::number_cell(e.limit, 1, "{:.9g}"),
             output::number_cell(e.uncertainty, 1, "{:.2g}"), quantity.unit});
        continue;
      }
      std::vector<double> values;
      for (const RefinementLevel& level : quantity.levels) values.push_back(level.value);
      rows.push_back({quantity.id, "-", "-", "-", "-",
                      fmt::format("{}; inconclusive: {}: {:.9g}", quantity.unit, e.reason,
                                  fmt::join(values, ", "))});
    }
    text += output::text_table(rows, "<>>>><");
  }
  return text;
}

std::string study_json(const std::string& case_name, const std::vector<RefinementStudy>& studies,
                       const output::Provenance& provenance) {
  Json json{{"schema", 1},
            {"case", case_name},
            {"provenance", output::to_json(provenance)},
            {"studies", Json::array()}};
  for (const RefinementStudy& study : studies) {
    Json entry{{"model", study.model},
               {"option", study.option},
               {"size_name", study.size_name},
               {"settings", study.settings},
               {"seconds", study.seconds},
               {"failure", study.failure.empty() ? Json(nullptr) : Json(study.failure)},
               {"quantities", Json::array()}};
    for (const ConvergedQuantity& quantity : study.quantities)
      entry["quantities"].push_back(quantity_json(quantity));
    json["studies"].push_back(std::move(entry));
  }
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + '\n';
}

std::vector<RefinementStudy> read_studies(const Json& json) {
  std::vector<RefinementStudy> studies;
  for (const Json& entry : json.at("studies")) {
    RefinementStudy study{};
    study.model = entry.at("model").get<std::string>();
    study.option = entry.at("option").get<std::string>();
    study.size_name = entry.value("size_name", "size of the level");
    study.settings = entry.at("settings").get<std::vector<double>>();
    study.seconds = entry.at("seconds").get<std::vector<double>>();
    study.failure = text_or_none(entry.at("failure"));
    for (const Json& quantity : entry.at("quantities"))
      study.quantities.push_back(read_quantity(quantity));
    studies.push_back(std::move(study));
  }
  return studies;
}

std::string study_csv(const std::vector<RefinementStudy>& studies) {
  std::size_t levels = 0;
  for (const RefinementStudy& study : studies) levels = std::max(levels, study.settings.size());
  output::CsvWriter csv;
  for (const char* name : {"model", "option", "quantity", "unit", "conclusive", "order", "limit",
                           "uncertainty", "safety", "reason"})
    csv.add(name);
  for (std::size_t i = 1; i <= levels; ++i) {
    csv.add(fmt::format("size_{}", i));
    csv.add(fmt::format("value_{}", i));
  }
  csv.end_row();
  for (const RefinementStudy& study : studies)
    for (const ConvergedQuantity& quantity : study.quantities) {
      const Extrapolation& e = quantity.extrapolation;
      const auto number = [&](double value) {
        return e.conclusive ? std::optional(value) : std::nullopt;
      };
      for (const std::string& text : {study.model, study.option, quantity.id, quantity.unit})
        csv.add(text);
      csv.add(e.conclusive ? 1 : 0);
      for (const auto& value : {e.order, number(e.limit), number(e.uncertainty), number(e.safety)})
        csv.add(value);
      csv.add(e.reason);
      for (std::size_t i = 0; i < levels; ++i) {
        const bool is_there = i < quantity.levels.size();
        csv.add(is_there ? std::optional(quantity.levels[i].size) : std::nullopt);
        csv.add(is_there ? std::optional(quantity.levels[i].value) : std::nullopt);
      }
      csv.end_row();
    }
  return csv.text();
}

}  // namespace ciliaval::compare::convergence
