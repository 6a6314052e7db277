// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/converge/study.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "compare/check/quantities.h"
#include "compare/registry.h"
#include "compare/run.h"
#include "fem/solid/solid.h"
#include "meshes/cylinder_mesh.h"
#include "problem/error.h"

namespace ciliaval::compare {
namespace {

using Json = nlohmann::ordered_json;

/// Two computations agree to rounding if they differ by less than this part of the scale: the
/// solvers' tolerances, 1e-12 for rods and 1e-9 for the solid, leave as much. CalculiX prints seven
/// digits.
double rounding_of(const std::string& model) {
  if (model == "calculix") return 1e-6;
  return model == "solid" ? 1e-9 : 1e-11;
}

/// What one level gave, by id.
struct LevelResult {
  double size = 0;
  std::map<std::string, Quantity> quantities;
};

/// Adds the lengths of the vectors that people look at first.
void add_lengths(std::map<std::string, Quantity>& quantities) {
  std::vector<Quantity> lengths;
  for (const auto& [id, x] : quantities) {
    if (!id.ends_with("/x")) continue;
    const std::string vector = id.substr(0, id.size() - 2);
    const double y = quantities.at(vector + "/y").value;
    Quantity length = x;
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
  for (Quantity& length : lengths) quantities.emplace(length.id, std::move(length));
}

/// The first in the order of the registry, the cheapest.
std::string first_mechanics(const Case& problem) {
  for (const MechanicsEntry& entry : mechanics_models())
    if (std::find(problem.mechanics.begin(), problem.mechanics.end(), entry.id) !=
        problem.mechanics.end())
      return entry.id;
  throw InputError("the refinement of a field model needs a mechanics model of the suite's own");
}

LevelResult run_level(Case problem, const Refinement& refinement, unsigned int setting,
                      const Progress& progress, RefinementStudy& study) {
  if (refinement.is_field) {
    problem.mechanics = {first_mechanics(problem)};
    problem.fields = {refinement.model};
  } else {
    problem.mechanics = {refinement.model};
  }
  problem.external.clear();  // the same at every level
  refinement.set(problem.options, setting);
  Progress named;
  if (progress)
    named = [&](const std::string& text) {
      progress(fmt::format("{} {}: {}", refinement.knob, setting, text));
    };
  const CaseResult result = run(problem, mechanics_models(), field_models(), named);
  double seconds = 0;
  for (const MechanicsRun& run : result.mechanics)
    for (const MechanicsStep& step : run.result.steps) {
      seconds += step.seconds;
      if (step.status == Status::failed && study.failure.empty())
        study.failure = fmt::format("{} {}: {}", refinement.knob, setting, step.message);
    }
  if (refinement.is_field)
    for (const FieldRun& run : result.fields)
      for (const auto& step : run.steps)
        if (step) seconds += step->seconds;
  study.seconds.push_back(seconds);
  LevelResult level{refinement.size(setting), {}};
  for (Quantity& quantity : measurements(result).quantities)
    if (!quantity.id.ends_with("/tip_uncertainty") &&
        (!refinement.is_field || quantity.id.find("/mechanics/") == std::string::npos))
      level.quantities.emplace(quantity.id, std::move(quantity));
  add_lengths(level.quantities);
  return level;
}

/// The quantities that every level has.
void extrapolate_all(const std::vector<LevelResult>& levels, const Refinement& refinement,
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
      quantity.extrapolation = extrapolate(quantity.levels, refinement.formal_order,
                                           rounding_of(refinement.model) * finest.scale);
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
  for (const Level& level : quantity.levels)
    json["levels"].push_back({{"size", level.size}, {"value", level.value}});
  json["conclusive"] = e.conclusive;
  json["reason"] = e.reason.empty() ? Json(nullptr) : Json(e.reason);
  json["order"] = e.order ? Json(*e.order) : Json(nullptr);
  json["limit"] = e.conclusive ? Json(e.limit) : Json(nullptr);
  json["uncertainty"] = e.conclusive ? Json(e.uncertainty) : Json(nullptr);
  json["safety"] = e.conclusive ? Json(e.safety) : Json(nullptr);
  return json;
}

}  // namespace

const std::vector<Refinement>& refinements() {
  static const std::vector<Refinement> all{
      {"beam", false, "refinement",
       [](ModelOptions& options, unsigned int level) { options.beam.refinement = level; },
       [](unsigned int level) { return std::ldexp(1.0, -static_cast<int>(level)); },
       "length of the elements, in segments", 0, 5, std::nullopt},
      {"calculix", false, "refinement",
       [](ModelOptions& options, unsigned int level) {
         options.calculix.refinement = level;
         options.calculix.error_estimate = false;
       },
       [](unsigned int level) { return fem::cylinder_mesh_options(level).finest_layer; },
       "thickness of the finest layers, in diameters", 0, 3, std::nullopt},
      // The thickness of the layers at the singular rims, which govern (docs/solid.md): order 1.5
      // on the average, none formal.
      {"solid", false, "refinement",
       [](ModelOptions& options, unsigned int level) { options.solid.refinement = level; },
       [](unsigned int level) { return fem::cylinder_mesh_options(level).finest_layer; },
       "thickness of the finest layers, in diameters", 0, 3, std::nullopt},
      // Midpoint rules.
      {"line", true, "log2 of elements",
       [](ModelOptions& options, unsigned int level) { options.line.elements = 1U << level; },
       [](unsigned int level) { return std::ldexp(1.0, -static_cast<int>(level)); },
       "length of the pieces, in segments", 4, 12, 2.0},
      {"volume", true, "log2 of elements",
       [](ModelOptions& options, unsigned int level) { options.volume.elements = 1U << level; },
       [](unsigned int level) { return std::ldexp(1.0, -static_cast<int>(level)); },
       "height of the slices, in segments", 4, 8, 2.0}};
  return all;
}

std::vector<Refinement> refinements(const Case& problem) {
  const auto asked = [](const std::vector<std::string>& ids, const std::string& id) {
    return std::find(ids.begin(), ids.end(), id) != ids.end();
  };
  std::vector<Refinement> result;
  for (const Refinement& refinement : refinements()) {
    if (!asked(refinement.is_field ? problem.fields : problem.mechanics, refinement.model))
      continue;
    const analytic::Method method =
        refinement.model == "line" ? problem.options.line.method : problem.options.volume.method;
    if (!refinement.is_field || method == analytic::Method::uniform) result.push_back(refinement);
  }
  return result;
}

RefinementStudy refinement_study(const Case& problem, const Refinement& refinement,
                                 unsigned int count, const Progress& progress) {
  RefinementStudy study{refinement.model, refinement.knob, refinement.size_name, {}, {}, {}, {}};
  if (count < 3 || count > refinement.finest - refinement.coarsest + 1)
    throw InputError(fmt::format("{} has 3 to {} levels of refinement, not {}", refinement.model,
                                 refinement.finest - refinement.coarsest + 1, count));
  std::vector<LevelResult> levels;
  for (unsigned int setting = refinement.coarsest; setting < refinement.coarsest + count;
       ++setting) {
    study.settings.insert(study.settings.begin(), setting);
    levels.insert(levels.begin(), run_level(problem, refinement, setting, progress, study));
  }
  std::reverse(study.seconds.begin(), study.seconds.end());
  if (study.failure.empty()) extrapolate_all(levels, refinement, study);
  return study;
}

std::string study_text(const std::vector<RefinementStudy>& studies) {
  std::string text;
  for (const RefinementStudy& study : studies) {
    text += fmt::format("{}, {} {} ({:.3g} s)\n", study.model, study.knob,
                        fmt::join(study.settings, ", "), fmt::join(study.seconds, ", "));
    if (!study.failure.empty()) {
      text += fmt::format("  inconclusive: {}\n", study.failure);
      continue;
    }
    text += fmt::format("  {:<44} {:>16} {:>7} {:>16} {:>10}\n", "quantity", "finest", "order",
                        "extrapolated", "+-");
    for (const ConvergedQuantity& quantity : study.quantities) {
      if (!is_shown(quantity.id)) continue;
      const Extrapolation& e = quantity.extrapolation;
      if (e.conclusive) {
        text += fmt::format("  {:<44} {:>16.9g} {:>7} {:>16.9g} {:>10.2g} {}\n", quantity.id,
                            quantity.levels.front().value,
                            e.order ? fmt::format("{:.2f}", *e.order) : "-", e.limit, e.uncertainty,
                            quantity.unit);
        continue;
      }
      std::vector<double> values;
      for (const Level& level : quantity.levels) values.push_back(level.value);
      text += fmt::format("  {:<44} inconclusive: {}: {:.9g} {}\n", quantity.id, e.reason,
                          fmt::join(values, ", "), quantity.unit);
    }
  }
  return text;
}

std::string study_json(const std::string& case_name, const std::vector<RefinementStudy>& studies) {
  Json json{{"schema", 1}, {"case", case_name}, {"studies", Json::array()}};
  for (const RefinementStudy& study : studies) {
    Json entry{{"model", study.model},
               {"knob", study.knob},
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

std::string study_csv(const std::vector<RefinementStudy>& studies) {
  std::string text =
      "model,quantity,unit,conclusive,order,limit,uncertainty,safety,reason,levels\n";
  for (const RefinementStudy& study : studies)
    for (const ConvergedQuantity& quantity : study.quantities) {
      const Extrapolation& e = quantity.extrapolation;
      const auto number = [&](double value) {
        return e.conclusive ? fmt::format("{}", value) : std::string();
      };
      text += fmt::format("{},{},{},{},{},{},{},{},\"{}\"", study.model, quantity.id, quantity.unit,
                          e.conclusive ? 1 : 0, e.order ? fmt::format("{}", *e.order) : "",
                          number(e.limit), number(e.uncertainty), number(e.safety), e.reason);
      for (const Level& level : quantity.levels)
        text += fmt::format(",{},{}", level.size, level.value);
      text += '\n';
    }
  return text;
}

}  // namespace ciliaval::compare
