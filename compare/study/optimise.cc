// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/study/optimise.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <tuple>
#include <utility>

#include "compare/budget/sensitivity.h"
#include "compare/study/record.h"
#include "compare/study/report.h"

namespace ciliaval::compare::study {
namespace {

using Json = nlohmann::ordered_json;

/// The gain of a design without a goal, and the least of one that has it: ln of the goal in the
/// unit in which people read it.
constexpr double no_gain = -10;
/// The constraints of a design of which nothing is known.
constexpr double unknown_violation = 10;

/// One mechanics model at one design, with the search's outputs or with all of them.
struct Key {
  bool is_search = true;
  std::vector<double> values;
  std::string mechanics;
  bool operator<(const Key& other) const {
    return std::tie(is_search, values, mechanics) <
           std::tie(other.is_search, other.values, other.mechanics);
  }
};
using Records = std::map<Key, std::vector<PairResult>>;

/// The study as the search evaluates it: the first pair, and no output that it does not need.
Study searched(const Study& study) {
  Study s = study;
  s.pairs.resize(1);
  std::vector<Output> needed{study.optimisation->goal};
  for (const Constraint& c : constraints_of(study)) needed.push_back(c.output);
  s.outputs.clear();
  for (const Output output : all_outputs())
    if (std::find(needed.begin(), needed.end(), output) != needed.end())
      s.outputs.push_back(output);
  return s;
}

std::vector<models::ModelPair> pairs_of(const Study& study, const std::string& mechanics) {
  std::vector<models::ModelPair> pairs;
  for (const models::ModelPair& pair : study.pairs)
    if (pair.mechanics == mechanics) pairs.push_back(pair);
  return pairs;
}

std::string to_text(const Key& key, const std::vector<PairResult>& results) {
  return Json{{key.is_search ? "search" : "design", key.values},
              {"mechanics", key.mechanics},
              {"pairs", to_json(results)}}
      .dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// The records of the journal that are of this study.
Records records_of(const Study& study, const Journal& journal) {
  const Study search = searched(study);
  Records records;
  for (const std::string& text : journal.records()) {
    try {
      const Json json = Json::parse(text);
      const bool is_search = json.contains("search");
      const Study& of = is_search ? search : study;
      Key key{is_search, json.at(is_search ? "search" : "design").get<std::vector<double>>(),
              json.at("mechanics").get<std::string>()};
      auto results =
          results_from(json.at("pairs"), of.outputs.size(), pairs_of(of, key.mechanics).size());
      if (results && key.values.size() == study.optimisation->parameters.size())
        records.emplace(std::move(key), std::move(*results));
    } catch (const Json::exception&) {  // another format's: computed again
    }
  }
  return records;
}

/// Evaluates designs, or finds them in the journal.
class Evaluations {
 public:
  Evaluations(const Study& study, Journal& journal,
              std::span<const models::MechanicsEntry> mechanics,
              std::span<const models::FieldEntry> fields, const Progress& progress)
      : study_(study),
        search_(searched(study)),
        journal_(journal),
        mechanics_(mechanics),
        fields_(fields),
        progress_(progress),
        records_(records_of(study, journal)) {}

  const Study& search() const { return search_; }

  const std::vector<PairResult>& of(const Key& key, const Progress& progress = {}) {
    const auto known = records_.find(key);
    if (known != records_.end()) return known->second;
    const Study& study = key.is_search ? search_ : study_;
    auto results =
        evaluate(study, study_.design(key.values), key.mechanics, mechanics_, fields_, progress);
    journal_.append(to_text(key, results));
    return records_.emplace(key, std::move(results)).first->second;
  }

  /// A design by some of the mechanics models, in the order of the study's pairs.
  Design design(std::string name, std::vector<double> values,
                const std::vector<std::string>& mechanics) {
    for (const std::string& model : mechanics) {
      Progress inner;
      if (progress_)
        inner = [&](const std::string& text) {
          progress_(fmt::format("{}: {}: {}", study_.name, name, text));
        };
      of({false, values, model}, inner);
    }
    Design design{std::move(name), std::move(values), {}, {}};
    std::map<std::string, std::size_t> next;
    for (const models::ModelPair& pair : study_.pairs) {
      const auto record = records_.find({false, design.values, pair.mechanics});
      if (std::find(mechanics.begin(), mechanics.end(), pair.mechanics) == mechanics.end())
        continue;
      design.models.push_back(pair);
      design.pairs.push_back(record->second[next[pair.mechanics]++]);
    }
    return design;
  }

 private:
  const Study& study_;
  Study search_;
  Journal& journal_;
  std::span<const models::MechanicsEntry> mechanics_;
  std::span<const models::FieldEntry> fields_;
  const Progress& progress_;
  Records records_;
};

/// A parameter between its bounds as a number from 0 to 1, and back.
double to_unit(const Parameter& p, double value) {
  const double from = p.values.front();
  const double to = p.values.back();
  const double u = p.is_logarithmic ? std::log(value / from) / std::log(to / from)
                                    : (value - from) / (to - from);
  return std::clamp(u, 0.0, 1.0);
}
double from_unit(const Parameter& p, double u) {
  const double from = p.values.front();
  const double to = p.values.back();
  if (u <= 0) return from;
  if (u >= 1) return to;
  return p.is_logarithmic ? from * std::pow(to / from, u) : from + u * (to - from);
}

std::vector<double> from_unit(const Study& study, const std::vector<double>& u) {
  std::vector<double> values;
  for (std::size_t i = 0; i < u.size(); ++i)
    values.push_back(from_unit(study.optimisation->parameters[i], u[i]));
  return values;
}

/// What the search makes of a result.
Trial trial_of(const Study& search, const std::vector<Constraint>& constraints, double load,
               const PairResult& result) {
  const auto magnitude_of = [&](Output output) -> std::optional<double> {
    const auto place = std::find(search.outputs.begin(), search.outputs.end(), output);
    const auto& value = result.values[static_cast<std::size_t>(place - search.outputs.begin())];
    return value ? std::optional(std::abs(*value)) : std::nullopt;
  };
  Trial trial{no_gain, {}, false};
  const Output goal = search.optimisation->goal;
  if (const auto value = magnitude_of(goal)) {
    trial.is_defined = true;
    trial.gain = std::max(std::log(*value / unit_of(goal, search).size), no_gain);
  }
  for (const Constraint& c : constraints) {
    const double limit = c.is_own_load ? c.value * load : c.value;
    const auto value = magnitude_of(c.output);
    double g = unknown_violation;
    if (value) g = (c.is_lower ? 1 : -1) * std::log(limit / *value);
    trial.constraints.push_back(std::clamp(g, -unknown_violation, unknown_violation));
  }
  return trial;
}

}  // namespace

std::vector<Constraint> constraints_of(const Study& study) {
  const Optimisation& o = *study.optimisation;
  std::vector<Constraint> all;
  bool has_slope = o.goal == Output::sensitivity;
  for (const Limit& limit : o.limits) {
    all.push_back({limit.output, limit.is_lower, limit.value, false});
    has_slope =
        has_slope || limit.output == Output::sensitivity || limit.output == Output::resolution;
  }
  // The slope is that between loads somewhat lower and higher.
  constexpr double margin = 1e-3;
  if (contact_height(study.base.load_path.front()))
    all.push_back(
        {Output::range, true, 1 + margin + (has_slope ? 2 * budget::sensitivity_step : 0), true});
  return all;
}

Optimum run_optimisation(const Study& study, Journal& journal,
                         std::span<const models::MechanicsEntry> mechanics_models,
                         std::span<const models::FieldEntry> field_models,
                         const Progress& progress) {
  const Optimisation& o = *study.optimisation;
  Evaluations evaluations(study, journal, mechanics_models, field_models, progress);
  const std::vector<Constraint> constraints = constraints_of(study);
  const std::string& searcher = study.pairs.front().mechanics;
  Optimum optimum;
  double best = no_gain;
  const auto function = [&](const std::vector<double>& u) {
    const std::vector<double> values = from_unit(study, u);
    const PairResult& result = evaluations.of({true, values, searcher}).front();
    const double load = magnitude(study.design(values).load_path.front());
    Trial trial = trial_of(evaluations.search(), constraints, load, result);
    ++optimum.evaluations;
    if (trial.is_defined && trial.violation() <= feasibility) best = std::max(best, trial.gain);
    if (progress)
      progress(fmt::format("{}: {} designs, the best so far {:.5g} {}", study.name,
                           optimum.evaluations, std::exp(best), unit_of(o.goal, study).name));
    return trial;
  };
  std::vector<double> start;
  for (std::size_t i = 0; i < o.start.size(); ++i)
    start.push_back(to_unit(o.parameters[i], o.start[i]));
  optimum.search = maximise(function, start, {o.global_evaluations, o.starts});
  journal.flush();

  optimum.designs.push_back(evaluations.design("start", o.start, study.mechanics()));
  for (std::size_t i = 0; i < optimum.search.optima.size(); ++i)
    optimum.designs.push_back(evaluations.design(
        fmt::format("optimum {}", i + 1), from_unit(study, optimum.search.optima[i].u),
        i == 0 ? study.mechanics() : std::vector<std::string>{searcher}));
  journal.flush();
  return optimum;
}

std::size_t kept_evaluations(const Study& study, const Journal& journal) {
  return records_of(study, journal).size();
}

}  // namespace ciliaval::compare::study
