// SPDX-License-Identifier: LGPL-2.1-or-later
// An optimum as text, CSV and JSON.
#include <fmt/core.h>
#include <fmt/ranges.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "compare/output/results.h"
#include "compare/output/text_table.h"
#include "compare/study/optimum/optimise.h"
#include "compare/study/summary/report.h"

namespace ciliaval::compare::study::optimum {
namespace {

using Json = nlohmann::ordered_json;

/// "range >= 2 mN", "|B_z| <= 3000 uT"
std::string words(const Study& study, const Limit& c) {
  if (c.is_own_load) return fmt::format("range >= {:g} times the load", c.value);
  const output::ShownUnit unit = unit_of(c.output, study);
  return fmt::format("{} {} {:g} {}", symbol(c.output),
                     c.is_lower ? ">=" : "<=", c.value / unit.size, unit.name);
}

/// d ln(goal)/d ln(bound) for a bound that is moved outwards; 0 between the bounds.
double bound_elasticity(const Parameter& p, const LocalOptimum& optimum, std::size_t i) {
  if (optimum.at_bound[i] == 0) return 0;
  const double from = p.values.front();
  const double to = p.values.back();
  const double bound = std::abs(optimum.at_bound[i] < 0 ? from : to);
  return optimum.bound_multipliers[i] *
         (p.is_logarithmic ? 1 / std::abs(std::log(to / from)) : bound / (to - from));
}

bool is_reached(const LocalOptimum& optimum, std::size_t constraint) {
  return optimum.multipliers[constraint] > 0;
}

/// Which of the study's limits a pair misses at a design, in per cent of the limit.
std::string missed_limits(const Study& study, const PairResult& result) {
  std::vector<std::string> missed;
  for (const Limit& limit : study.optimisation->limits) {
    const auto value = magnitude_of(study, result, limit.output);
    if (!value) {
      missed.push_back(fmt::format("{} unknown", id(limit.output)));
      continue;
    }
    const double by = (limit.is_lower ? 1 : -1) * (limit.value - *value) / limit.value;
    if (by > 2 * feasibility)
      missed.push_back(fmt::format("{} missed by {:.2g} %", id(limit.output), 100 * by));
  }
  if (study.optimisation->limits.empty()) return "-";
  return missed.empty() ? "kept" : fmt::format("{}", fmt::join(missed, ", "));
}

std::string parameter_table(const Study& study, const Optimum& optimum) {
  const Optimisation& o = *study.optimisation;
  output::TextRows rows{{"", "from", "to"}};
  for (const Design& design : optimum.designs) rows[0].push_back(design.name);
  for (std::size_t i = 0; i < o.parameters.size(); ++i) {
    const Parameter& p = o.parameters[i];
    const auto shown = [&](double value) { return fmt::format("{:.5g}", value / p.unit_size); };
    std::vector<std::string>& row = rows.emplace_back();
    row = {summary::heading(p), shown(p.values.front()), shown(p.values.back())};
    for (const Design& design : optimum.designs) row.push_back(shown(design.values[i]));
  }
  std::vector<std::string> searches{"local searches", "", "", ""};
  for (const LocalOptimum& local : optimum.search.optima)
    searches.push_back(std::to_string(local.starts));
  rows.push_back(std::move(searches));
  return output::text_table(rows);
}

/// What holds the best design where it is, and what it is worth.
std::string activity(const Study& study, const LocalOptimum& best) {
  const Optimisation& o = *study.optimisation;
  const std::vector<Limit> constraints = constraints_of(study);
  std::string text = "\nOptimum 1:\n";
  for (std::size_t j = 0; j < constraints.size(); ++j) {
    const double spare = std::expm1(-best.trial.constraints[j]);
    text += fmt::format("  {}: ", words(study, constraints[j]));
    text += is_reached(best, j)
                ? fmt::format("reached; 1 % {} would give {:.3g} % more {}\n",
                              constraints[j].is_lower ? "less" : "more", best.multipliers[j],
                              symbol(o.goal))
                : fmt::format("kept, with {:.3g} % to spare\n", 100 * std::max(spare, 0.0));
  }
  for (std::size_t i = 0; i < o.parameters.size(); ++i) {
    const Parameter& p = o.parameters[i];
    if (best.at_bound[i] == 0) continue;
    text += fmt::format("  {} = {}: at its {} bound; 1 % {} would give {:.3g} % more {}\n", p.name,
                        format_value(p, best.at_bound[i] < 0 ? p.values.front() : p.values.back()),
                        best.at_bound[i] < 0 ? "lower" : "upper",
                        best.at_bound[i] < 0 ? "less" : "more", bound_elasticity(p, best, i),
                        symbol(o.goal));
  }
  return text + fmt::format(
                    "  {}: |d ln({})/du| = {:.1g} at most, u from 0 to 1 between the bounds\n",
                    best.residual < stationary ? "otherwise stationary"
                                               : "not stationary, so that a better one may be near",
                    symbol(o.goal), best.residual);
}

std::string result_table(const Study& study, const Optimum& optimum) {
  const Output goal = study.optimisation->goal;
  output::TextRows rows{{"", "pair"}};
  for (const Output output : study.outputs) rows[0].push_back(summary::heading(output, study));
  rows[0].insert(rows[0].end(), {"+-dB(uT)", fmt::format("{} of start", symbol(goal)), "limits"});
  for (const Design& design : optimum.designs)
    for (std::size_t i = 0; i < design.models.size(); ++i) {
      const PairResult& result = design.pairs[i];
      std::vector<std::string>& row = rows.emplace_back();
      row = {design.name, design.models[i].name()};
      for (std::size_t output = 0; output < study.outputs.size(); ++output)
        row.push_back(summary::cell(study, result, output));
      row.push_back(result.uncertainty ? fmt::format("{:.1g}", *result.uncertainty / 1e-6) : "-");
      std::optional<double> before;
      for (std::size_t s = 0; s < optimum.designs.front().models.size(); ++s)
        if (optimum.designs.front().models[s].name() == design.models[i].name())
          before = magnitude_of(study, optimum.designs.front().pairs[s], goal);
      const auto now = magnitude_of(study, result, goal);
      row.push_back(before && now && *before > 0 ? fmt::format("{:.4g}", *now / *before) : "-");
      row.push_back(missed_limits(study, result));
    }
  return output::text_table(rows);
}

/// Why a pair has no result at a design.
std::string messages(const Optimum& optimum) {
  std::string text;
  for (const Design& design : optimum.designs)
    for (std::size_t i = 0; i < design.models.size(); ++i)
      if (!design.pairs[i].message.empty())
        text += fmt::format("{}, {}: {}: {}\n", design.name, design.models[i].name(),
                            output::to_string(design.pairs[i].status), design.pairs[i].message);
  return text.empty() ? text : "\n" + text;
}

Json design_json(const Study& study, const Optimum& optimum, std::size_t index) {
  const Optimisation& o = *study.optimisation;
  const Design& design = optimum.designs[index];
  Json json{{"name", design.name}, {"parameters", Json::object()}, {"pairs", Json::object()}};
  for (std::size_t i = 0; i < o.parameters.size(); ++i)
    json["parameters"][o.parameters[i].number.path] = design.values[i];
  for (std::size_t i = 0; i < design.models.size(); ++i)
    json["pairs"][design.models[i].name()] = summary::pair_json(study, design.pairs[i]);
  if (index == 0) return json;
  const LocalOptimum& local = optimum.search.optima[index - 1];
  json["local_searches"] = local.starts;
  json["residual"] = local.residual;
  json["at_bound"] = Json::object();
  for (std::size_t i = 0; i < o.parameters.size(); ++i)
    if (local.at_bound[i] != 0)
      json["at_bound"][o.parameters[i].number.path] = {
          {"bound", local.at_bound[i] < 0 ? "from" : "to"},
          {"elasticity", bound_elasticity(o.parameters[i], local, i)}};
  json["constraints"] = Json::array();
  for (std::size_t j = 0; j < local.multipliers.size(); ++j)
    json["constraints"].push_back(
        {{"reached", is_reached(local, j)}, {"elasticity", local.multipliers[j]}});
  return json;
}

}  // namespace

std::string text(const Study& study, const Optimum& optimum) {
  const Optimisation& o = *study.optimisation;
  std::vector<std::string> limits;
  for (const Limit& c : constraints_of(study)) limits.push_back(words(study, c));
  std::string text = fmt::format("\nLargest {} by {} within the bounds{}{}\n", symbol(o.goal),
                                 study.pairs.front().name(), limits.empty() ? "" : ", with ",
                                 fmt::join(limits, ", "));
  const SearchResult& search = optimum.search;
  text += fmt::format("{} designs evaluated, {} local searches", optimum.evaluations,
                      search.local_searches);
  if (search.infeasible > 0)
    text += fmt::format(", {} without a design that keeps the limits", search.infeasible);
  if (search.not_stationary > 0)
    text += fmt::format(", {} that ended where nothing is stationary", search.not_stationary);
  text += "\n\n" + parameter_table(study, optimum);
  if (optimum.found())
    text += activity(study, search.optima.front());
  else
    text += "\nNo design was found that keeps the limits\n";
  return text + '\n' + result_table(study, optimum) + messages(optimum);
}

std::string csv(const Study& study, const Optimum& optimum) {
  output::CsvWriter csv;
  summary::add_csv_header(csv, study, study.optimisation->parameters, "design");
  for (const Design& design : optimum.designs)
    for (std::size_t i = 0; i < design.models.size(); ++i)
      summary::add_csv_row(csv, design.name, design.values, design.models[i], design.pairs[i]);
  return csv.text();
}

Json json(const Study& study, const Optimum& optimum) {
  const Optimisation& o = *study.optimisation;
  Json json{{"maximise", id(o.goal)},
            {"pair", study.pairs.front().name()},
            {"found", optimum.found()},
            {"evaluations", optimum.evaluations},
            {"local_searches", optimum.search.local_searches},
            {"not_stationary", optimum.search.not_stationary},
            {"infeasible", optimum.search.infeasible},
            {"parameters", Json::array()},
            {"constraints", Json::array()},
            {"designs", Json::array()}};
  for (const Parameter& p : o.parameters)
    json["parameters"].push_back(
        summary::parameter_json(p, {{"from", p.values.front()}, {"to", p.values.back()}}));
  for (const Limit& c : constraints_of(study))
    json["constraints"].push_back(
        {{"output", id(c.output)},
         {c.is_lower ? "at_least" : "at_most", c.value},
         {"times_the_load", c.is_own_load},
         {"unit", c.is_own_load ? "" : quantity_of(c.output, study.load()).unit}});
  for (std::size_t i = 0; i < optimum.designs.size(); ++i)
    json["designs"].push_back(design_json(study, optimum, i));
  json["slices"] = Json::array();
  for (std::size_t i = 0; i < optimum.slices.size(); ++i) {
    const Slice& slice = optimum.slices[i];
    Json values = Json::array();
    for (const std::optional<double>& value : slice.values)
      values.push_back(value ? Json(*value) : Json(nullptr));
    json["slices"].push_back({{"path", o.parameters[i].number.path},
                              {"best", optimum.designs[1].values[i]},
                              {"at", slice.at},
                              {"values", values},
                              {"kept", slice.keeps}});
  }
  return json;
}

}  // namespace ciliaval::compare::study::optimum
