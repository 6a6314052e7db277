// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/study/optimum/optimise.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "compare/budget/sensitivity.h"

namespace ciliaval::compare::study::optimum {
namespace {

/// The gain of a design without a goal, and the least of one that has it: ln of the goal in the
/// unit in which people read it.
constexpr double no_gain = -10;
/// The constraints of a design of which nothing is known.
constexpr double unknown_violation = 10;

/// The study as the search evaluates it: the first pair, and no output that it does not need.
Study searched(const Study& study) {
  Study s = study;
  s.pairs.resize(1);
  std::set<Output> needed{study.optimisation->goal};
  for (const Limit& c : constraints_of(study)) needed.insert(c.output);
  s.outputs.assign(needed.begin(), needed.end());
  return s;
}

/// Evaluates designs, unless they are known.
struct Evaluations {
  const Study& study;
  Study search;  ///< the study as the search evaluates it
  Solutions& solutions;
  std::span<const models::MechanicsEntry> mechanics_models;
  std::span<const models::FieldEntry> field_models;
  const Progress& progress;

  const PairResult& searched_at(const std::vector<double>& values) {
    return solve("search", search, values, study.pairs.front().mechanics, {}).front();
  }

  /// A design by some of the mechanics models.
  Design design(std::string name, std::vector<double> values,
                const std::vector<std::string>& mechanics) {
    const Progress inner = of_a_piece(progress, fmt::format("{}: {}: ", study.name, name));
    Design design{std::move(name), std::move(values), {}, {}};
    for (std::size_t i = 0; i < study.pairs.size(); ++i) {
      const models::ModelPair& pair = study.pairs[i];
      if (std::find(mechanics.begin(), mechanics.end(), pair.mechanics) == mechanics.end())
        continue;
      design.models.push_back(pair);
      design.pairs.push_back(
          solve("design", study, design.values, pair.mechanics, inner).at(study.place(i)));
    }
    return design;
  }

  const std::vector<PairResult>& solve(std::string_view kind, const Study& reduced,
                                       const std::vector<double>& values,
                                       const std::string& mechanics, const Progress& inner) {
    const std::string name = fmt::format("{} of {} at {}", kind, mechanics, fmt::join(values, " "));
    if (solutions.find(name) == nullptr)
      solutions.add(name, evaluate(reduced, study.design(values), mechanics, mechanics_models,
                                   field_models, inner));
    return *solutions.find(name);
  }
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
Trial trial_of(const Study& search, const std::vector<Limit>& constraints, double load,
               const PairResult& result) {
  Trial trial{no_gain, {}, false};
  const Output goal = search.optimisation->goal;
  if (const auto value = magnitude_of(search, result, goal)) {
    trial.is_defined = true;
    trial.gain = std::max(std::log(*value / unit_of(goal, search).size), no_gain);
  }
  for (const Limit& c : constraints) {
    const double limit = c.is_own_load ? c.value * load : c.value;
    const auto value = magnitude_of(search, result, c.output);
    double g = unknown_violation;
    if (value) g = (c.is_lower ? 1 : -1) * std::log(limit / *value);
    trial.constraints.push_back(std::clamp(g, -unknown_violation, unknown_violation));
  }
  return trial;
}

/// The bounds, 25 equal steps between them, and the best design itself.
std::vector<double> along(double best) {
  std::vector<double> u{best};
  constexpr int steps = 25;
  for (int k = 0; k <= steps; ++k) u.push_back(static_cast<double>(k) / steps);
  std::sort(u.begin(), u.end());
  u.erase(std::unique(u.begin(), u.end()), u.end());
  return u;
}

std::vector<Slice> slices_through(const std::vector<double>& best, Evaluations& evaluations,
                                  const std::vector<Limit>& constraints) {
  const Study& study = evaluations.study;
  std::vector<Slice> slices;
  for (std::size_t i = 0; i < best.size(); ++i) {
    Slice& slice = slices.emplace_back();
    for (const double u : along(best[i])) {
      std::vector<double> place = best;
      place[i] = u;
      const std::vector<double> values = from_unit(study, place);
      const PairResult& result = evaluations.searched_at(values);
      const double load = magnitude(study.design(values).load_path.front());
      slice.at.push_back(values[i]);
      slice.values.push_back(magnitude_of(evaluations.search, result, study.optimisation->goal));
      slice.keeps.push_back(trial_of(evaluations.search, constraints, load, result).violation() <=
                            feasibility);
    }
  }
  return slices;
}

}  // namespace

std::optional<double> magnitude_of(const Study& study, const PairResult& result, Output output) {
  for (std::size_t o = 0; o < study.outputs.size(); ++o)
    if (study.outputs[o] == output && result.values[o]) return std::abs(*result.values[o]);
  return std::nullopt;
}

std::vector<Limit> constraints_of(const Study& study) {
  std::vector<Limit> all = study.optimisation->limits;
  bool has_slope = study.optimisation->goal == Output::sensitivity;
  for (const Limit& limit : all)
    has_slope =
        has_slope || limit.output == Output::sensitivity || limit.output == Output::resolution;
  // The slope is that between loads somewhat lower and higher.
  constexpr double margin = 1e-3;
  if (contact_height(study.base.load_path.front()))
    all.push_back(
        {Output::range, true, 1 + margin + (has_slope ? 2 * budget::sensitivity_step : 0), true});
  return all;
}

Optimum run_optimisation(const Study& study, Solutions& solutions,
                         std::span<const models::MechanicsEntry> mechanics_models,
                         std::span<const models::FieldEntry> field_models,
                         const Progress& progress) {
  const Optimisation& o = *study.optimisation;
  Evaluations evaluations{study,        searched(study), solutions, mechanics_models,
                          field_models, progress};
  const std::vector<Limit> constraints = constraints_of(study);
  const std::string& searcher = study.pairs.front().mechanics;
  Optimum optimum;
  double best = no_gain;
  const auto function = [&](const std::vector<double>& u) {
    const std::vector<double> values = from_unit(study, u);
    const PairResult& result = evaluations.searched_at(values);
    const double load = magnitude(study.design(values).load_path.front());
    Trial trial = trial_of(evaluations.search, constraints, load, result);
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

  optimum.designs.push_back(evaluations.design("start", o.start, study.mechanics()));
  for (std::size_t i = 0; i < optimum.search.optima.size(); ++i)
    optimum.designs.push_back(evaluations.design(
        fmt::format("optimum {}", i + 1), from_unit(study, optimum.search.optima[i].u),
        i == 0 ? study.mechanics() : std::vector<std::string>{searcher}));
  if (optimum.found())
    optimum.slices = slices_through(optimum.search.optima.front().u, evaluations, constraints);
  return optimum;
}

}  // namespace ciliaval::compare::study::optimum
