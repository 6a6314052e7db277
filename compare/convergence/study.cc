// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/convergence/study.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <utility>

#include "compare/models/registry.h"
#include "compare/models/run.h"
#include "compare/output/csv_writer.h"
#include "compare/output/json_file.h"
#include "compare/output/text_table.h"
#include "compare/results/observation.h"
#include "problem/error.h"

namespace ciliaval::compare::convergence {
namespace {

using Json = nlohmann::ordered_json;

/// Results of one level, by id.
using Quantities = std::map<std::string, results::Observation>;

/// The first of the case's mechanics models, the cheapest first, that gives the field model what it
/// needs.
models::MechanicsRun mechanics_for(const models::FieldEntry& field, const input::Case& problem,
                                   const Progress& progress) {
  for (const models::MechanicsEntry& entry : models::mechanics_models()) {
    if (std::find(problem.mechanics.begin(), problem.mechanics.end(), entry.id) ==
        problem.mechanics.end())
      continue;
    models::MechanicsRun run =
        models::run_mechanics(entry, problem, models::field_models(), progress);
    const Deformation& undeformed = run.result.undeformed;
    if (!undeformed.centreline.pieces().empty() && (!field.has_body || undeformed.body)) return run;
  }
  throw InputError("none of the case's own mechanics models gives what the field model needs");
}

/// Reason why a study of this level is impossible; else empty.
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

/// Reason why a field model does not know the error of this level; else empty.
std::string unknown_error_of(const models::CaseResult& result, const ModelRefinement& refinement) {
  if (!refinement.is_field) return {};
  for (const models::FieldRun& run : result.fields)
    for (const auto& step : run.steps)
      if (step && !step->remark.empty()) return step->remark;
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

/// Runs at each value of the option a mechanics model, and the fields on it, or a field model on
/// one deformation.
std::vector<models::CaseResult> run_levels(input::Case problem, const ModelRefinement& refinement,
                                           std::span<const double> values,
                                           const Progress& progress) {
  std::vector<models::CaseResult> results;
  std::optional<models::MechanicsRun> mechanics;
  if (!refinement.is_field) {
    problem.mechanics = {refinement.model};
    problem.external.clear();  // the same at every level
    if (refinement.sequence.law == input::Refinement::Law::tolerance) problem.fields.clear();
  }
  for (const double value : values) {
    refinement.set(problem.options, value);
    const Progress of_level =
        with_prefix(progress, fmt::format("{} {:g}: ", refinement.option.name, value));
    if (!refinement.is_field) {
      results.push_back(
          models::run(problem, models::mechanics_models(), models::field_models(), of_level));
      continue;
    }
    const models::FieldEntry& entry = models::entry_of(models::field_models(), refinement.model);
    const auto field = entry.make(problem.options);
    if (!mechanics) mechanics = mechanics_for(entry, problem, progress);
    results.push_back(
        {problem,
         {*mechanics},
         {models::run_field(refinement.model, *field, *mechanics, problem, of_level)}});
  }
  return results;
}

Quantities quantities_of(const models::CaseResult& result, const ModelRefinement& refinement) {
  Quantities quantities;
  for (results::Observation& row : results::observations(result))
    if (row.is_converged && !row.is_estimate && (!refinement.is_field || !row.field.empty()))
      quantities.emplace(row.id(), std::move(row));
  return quantities;
}

Extrapolation extrapolation_of(const std::vector<RefinementLevel>& levels,
                               const results::Observation& finest,
                               const ModelRefinement& refinement) {
  if (refinement.sequence.law == input::Refinement::Law::power)
    return extrapolate(levels, refinement.sequence.formal_order,
                       refinement.rounding * finest.scale);
  // A change is the difference of two fields, each within the tolerance.
  return kept_tolerances(levels, (finest.is_change ? 2 : 1) * finest.scale);
}

/// The quantities that every level has.
void extrapolate_all(const std::vector<Quantities>& levels, const ModelRefinement& refinement,
                     RefinementStudy& study) {
  for (const auto& [id, finest] : levels.front()) {
    ConvergedQuantity quantity{finest, {}, {}};
    for (std::size_t i = 0; i < levels.size() && levels[i].contains(id); ++i)
      quantity.levels.push_back(
          {refinement.sequence.size(study.settings[i]), levels[i].at(id).value});
    if (quantity.levels.size() == levels.size())
      quantity.extrapolation = extrapolation_of(quantity.levels, finest, refinement);
    else
      quantity.extrapolation.reason = "not every level has it";
    study.quantities.push_back(std::move(quantity));
  }
}

/// The numbers of an extrapolation; a limit that is not conclusive is none.
std::array<std::pair<const char*, std::optional<double>>, 4> numbers_of(const Extrapolation& e) {
  const auto if_conclusive = [&](double value) {
    return e.conclusive ? std::optional(value) : std::nullopt;
  };
  return {{{"order", e.order},
           {"limit", if_conclusive(e.limit)},
           {"uncertainty", if_conclusive(e.uncertainty)},
           {"safety", if_conclusive(e.safety)}}};
}

Json quantity_json(const ConvergedQuantity& quantity) {
  const Extrapolation& e = quantity.extrapolation;
  const results::Observation& row = quantity.finest;
  Json json{{"id", row.id()},
            {"step", row.step ? Json(*row.step) : Json(nullptr)},
            {"mechanics", row.mechanics},
            {"field", output::or_null(row.field)},
            {"sensor", row.sensor ? Json(*row.sensor) : Json(nullptr)},
            {"quantity", row.quantity},
            {"component", output::or_null(row.component)},
            {"unit", row.unit},
            {"levels", Json::array()}};
  for (const RefinementLevel& level : quantity.levels)
    json["levels"].push_back({{"size", level.size}, {"value", level.value}});
  json["conclusive"] = e.conclusive;
  json["reason"] = output::or_null(e.reason);
  for (const auto& [name, value] : numbers_of(e)) json[name] = output::or_null(value);
  return json;
}

/// Summary of the levels for the numbers of some models.
struct Judgement {
  std::size_t failed = 0;  ///< models
  std::size_t numbers = 0;
  std::size_t conclusive = 0;
  double largest = 0;  ///< interval over the scale
  std::string where;   ///< the number that has it

  void add(const Judgement& other) {
    failed += other.failed;
    numbers += other.numbers;
    conclusive += other.conclusive;
    if (other.largest > largest || where.empty()) {
      largest = other.largest;
      where = other.where;
    }
  }
};

Judgement judge(const RefinementStudy& study) {
  Judgement result;
  result.failed = study.failure.empty() ? 0 : 1;
  for (const ConvergedQuantity& quantity : study.quantities) {
    ++result.numbers;
    if (!quantity.extrapolation.conclusive) continue;
    ++result.conclusive;
    const double scale = quantity.finest.size();
    const double relative = scale > 0 ? quantity.extrapolation.uncertainty / scale : 0;
    if (relative > result.largest || result.where.empty()) {
      result.largest = relative;
      result.where = quantity.finest.id();
    }
  }
  return result;
}

std::string describe(const Judgement& judgement) {
  std::string text =
      fmt::format("{} of {} numbers have an interval", judgement.conclusive, judgement.numbers);
  if (judgement.conclusive > 0)
    text += fmt::format(", the widest +-{:.2g} % of its scale ({})", 100 * judgement.largest,
                        judgement.where);
  return text;
}

/// Two lines for people: how well tip and dB are known, and whether to refine.
std::string in_words(const RefinementStudy& study) {
  constexpr double enough = 0.01;
  const auto own = std::ranges::find(study.settings, study.own_setting);
  std::vector<std::string> known;
  std::vector<std::string> away;
  double farthest = 0;
  for (const bool is_field : {false, true}) {
    std::optional<double> interval;
    double distance = 0;
    for (const ConvergedQuantity& quantity : study.quantities) {
      const results::Observation& finest = quantity.finest;
      const double size = finest.size();
      if (!finest.is_looked_at || !quantity.extrapolation.conclusive || size == 0 ||
          finest.field.empty() == is_field)
        continue;
      interval = std::max(interval.value_or(0), quantity.extrapolation.uncertainty / size);
      if (own == study.settings.end()) continue;
      const double value =
          quantity.levels[static_cast<std::size_t>(own - study.settings.begin())].value;
      distance = std::max(distance, std::abs(value - quantity.extrapolation.limit) / size);
    }
    if (!interval) continue;
    const char* name = is_field ? "dB" : "tip";
    known.push_back(fmt::format("{} known to {:.1g} %", name, 100 * *interval));
    away.push_back(fmt::format("{} {:.1g} %", name, 100 * distance));
    farthest = std::max(farthest, distance);
  }
  if (known.empty()) return {};
  const std::string text = fmt::format("  {} on the finest level\n", fmt::join(known, ", "));
  if (own == study.settings.end())
    return text + fmt::format("  the case's own {} {:g} is none of the levels\n", study.option,
                              study.own_setting);
  return text + fmt::format("  the case's {} {:g}: {} from the limit; {} for 1 %\n", study.option,
                            study.own_setting, fmt::join(away, ", "),
                            farthest <= enough ? "nothing to refine" : "refine it");
}

std::string verdict(const Judgement& all) {
  std::string_view word = "converged";
  if (all.conclusive < all.numbers) word = "converged in part";
  if (all.failed > 0 || all.conclusive == 0) word = "inconclusive";
  return fmt::format(
      "\nVerdict: {}: {}{}\n", word, describe(all),
      all.failed > 0 ? fmt::format("; {} models failed on a level", all.failed) : "");
}

std::string quantity_table(const RefinementStudy& study) {
  output::TextRows rows{{"quantity", "finest", "order", "extrapolated", "+-", "unit"}};
  for (const ConvergedQuantity& quantity : study.quantities) {
    if (!quantity.finest.is_looked_at) continue;
    const Extrapolation& e = quantity.extrapolation;
    if (e.conclusive) {
      rows.push_back(
          {quantity.finest.id(), output::number_cell(quantity.levels.front().value, 1, "{:.9g}"),
           output::number_cell(e.order, 1, "{:.2f}"), output::number_cell(e.limit, 1, "{:.9g}"),
           output::number_cell(e.uncertainty, 1, "{:.2g}"), quantity.finest.unit});
      continue;
    }
    std::vector<double> values;
    for (const RefinementLevel& level : quantity.levels) values.push_back(level.value);
    rows.push_back({quantity.finest.id(), "-", "-", "-", "-",
                    fmt::format("{}; inconclusive: {}: {:.9g}", quantity.finest.unit, e.reason,
                                fmt::join(values, ", "))});
  }
  return output::text_table(rows, "<>>>><");
}

}  // namespace

void ModelRefinement::set(input::ModelOptions& options, double value) const {
  option.set_number(options, value);
  if (sequence.also) sequence.also(options);
}

std::vector<ModelRefinement> refinements(const input::Case& problem) {
  std::vector<ModelRefinement> result;
  const auto add = [&](const auto& entries, const std::vector<std::string>& asked, bool is_field) {
    for (const auto& entry : entries) {
      if (std::find(asked.begin(), asked.end(), entry.id) == asked.end()) continue;
      for (const input::Refinement& sequence : entry.refinements)
        if (!sequence.applies || sequence.applies(problem.options)) {
          const auto is_its_option = [&](const input::Option& option) {
            return option.name == sequence.option;
          };
          result.push_back(
              {entry.id, is_field, entry.accuracy / 10,
               *std::find_if(entry.options.begin(), entry.options.end(), is_its_option), sequence});
        }
    }
  };
  add(models::mechanics_models(), problem.mechanics, false);
  add(models::field_models(), problem.fields, true);
  return result;
}

RefinementStudy refinement_study(const input::Case& problem, const ModelRefinement& refinement,
                                 unsigned int count, const Progress& progress) {
  RefinementStudy study;
  study.model = refinement.model;
  study.option = refinement.option.name;
  study.size_name = refinement.sequence.size_name;
  study.own_setting = refinement.option.number(problem.options);
  if (count < 3)
    throw InputError(fmt::format("a study needs 3 levels of refinement or more, not {}", count));
  const auto values = std::span(refinement.sequence.values)
                          .first(std::min<std::size_t>(count, refinement.sequence.values.size()));
  const auto results = run_levels(problem, refinement, values, progress);
  std::vector<Quantities> levels;
  for (std::size_t i = results.size(); i-- > 0;) {
    study.settings.push_back(values[i]);
    study.seconds.push_back(seconds_of(results[i], refinement.is_field));
    levels.push_back(quantities_of(results[i], refinement));
    if (const std::string failure = failure_of(results[i], refinement); !failure.empty())
      study.failure = fmt::format("{} {:g}: {}", refinement.option.name, values[i], failure);
  }
  if (study.failure.empty()) extrapolate_all(levels, refinement, study);
  // No level is known to keep its tolerance, and close values may share an error.
  if (const std::string reason = unknown_error_of(results.back(), refinement); !reason.empty())
    for (ConvergedQuantity& quantity : study.quantities) {
      quantity.extrapolation = {};
      quantity.extrapolation.reason = reason;
    }
  return study;
}

std::string study_text(const std::vector<RefinementStudy>& studies, bool list) {
  std::string text;
  Judgement all;
  for (const RefinementStudy& study : studies) {
    text += fmt::format("{}, {} {:g} ({:.3g} s)\n", study.model, study.option,
                        fmt::join(study.settings, ", "), fmt::join(study.seconds, ", "));
    const Judgement judgement = judge(study);
    text += study.failure.empty() ? fmt::format("  {}\n", describe(judgement))
                                  : fmt::format("  inconclusive: {}\n", study.failure);
    text += in_words(study);
    if (judgement.conclusive == 0 && !study.quantities.empty())
      text += fmt::format("  {}\n", study.quantities.front().extrapolation.reason);
    if (list && study.failure.empty()) text += quantity_table(study);
    all.add(judgement);
  }
  return text + verdict(all) + (list ? "" : "The list of numbers: --all\n");
}

std::string study_json(const std::string& case_name, const std::vector<RefinementStudy>& studies,
                       const output::Provenance& provenance) {
  Json json{{"schema", 1},
            {"case", case_name},
            {"provenance", output::to_json(provenance)},
            {"studies", Json::array()}};
  for (const RefinementStudy& study : studies) {
    Json entry{{"model", study.model},         {"option", study.option},
               {"size_name", study.size_name}, {"settings", study.settings},
               {"seconds", study.seconds},     {"failure", output::or_null(study.failure)},
               {"quantities", Json::array()}};
    for (const ConvergedQuantity& quantity : study.quantities)
      entry["quantities"].push_back(quantity_json(quantity));
    json["studies"].push_back(std::move(entry));
  }
  return output::to_text(json);
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
      for (const std::string& text :
           {study.model, study.option, quantity.finest.id(), quantity.finest.unit})
        csv.add(text);
      csv.add(e.conclusive ? 1 : 0);
      for (const auto& [name, value] : numbers_of(e)) csv.add(value);
      csv.add(e.reason);
      for (const RefinementLevel& level : quantity.levels) {
        csv.add(level.size);
        csv.add(level.value);
      }
      for (std::size_t i = 2 * quantity.levels.size(); i < 2 * levels; ++i) csv.add("");
      csv.end_row();
    }
  return csv.text();
}

}  // namespace ciliaval::compare::convergence
