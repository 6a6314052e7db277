// SPDX-License-Identifier: LGPL-2.1-or-later
#include <nlohmann/json.hpp>

#include "compare/budget/report.h"
#include "problem/error.h"

namespace ciliaval::compare::budget {
namespace {

using Json = nlohmann::ordered_json;

models::Verdict verdict_of(const std::string& text) {
  for (const models::Verdict verdict :
       {models::Verdict::resolved, models::Verdict::below_uncertainty,
        models::Verdict::inconclusive})
    if (to_string(verdict) == text) return verdict;
  throw FileError("there is no verdict `" + text + "`");
}

std::string text_or_none(const Json& json) {
  return json.is_null() ? std::string() : json.get<std::string>();
}

BudgetLink read_link(const Json& json) {
  const Json& uncertainty = json.at("uncertainty");
  return {json.at("from").get<std::string>(),
          json.at("to").get<std::string>(),
          json.at("physics").get<std::string>(),
          json.at("value").get<double>(),
          uncertainty.is_null() ? std::nullopt : std::optional(uncertainty.get<double>()),
          verdict_of(json.at("verdict").get<std::string>())};
}

BudgetRow read_row(const Json& json) {
  BudgetRow row;
  row.step = json.at("step").get<std::size_t>();
  if (!json.at("sensor").is_null()) row.sensor = json["sensor"].get<std::size_t>();
  row.quantity = json.at("quantity").get<std::string>();
  row.component = text_or_none(json.at("component"));
  row.unit = json.at("unit").get<std::string>();
  row.paper = json.at("paper").get<double>();
  row.best = json.at("best").get<double>();
  row.total = read_link(json.at("total"));
  for (const Json& link : json.at("links")) row.links.push_back(read_link(link));
  if (!json.at("beside").is_null()) row.beside = read_link(json["beside"]);
  return row;
}

/// "solid/volume stacked" taken apart.
Stage read_stage(const Json& json) {
  const std::string name = json.at("name").get<std::string>();
  const std::size_t slash = name.find('/');
  if (slash == std::string::npos) throw FileError("`" + name + "` is no pair of models");
  Stage stage;
  stage.mechanics = name.substr(0, slash);
  stage.field = name.substr(slash + 1);
  if (const std::size_t blank = stage.field.find(' '); blank != std::string::npos) {
    stage.variant = stage.field.substr(blank + 1);
    stage.field.resize(blank);
  }
  stage.physics = text_or_none(json.at("physics"));
  return stage;
}

}  // namespace

Budget read_budget(const Json& json) {
  Budget budget;
  budget.case_name = json.at("case").get<std::string>();
  for (const Json& stage : json.at("chain")) budget.chain.stages.push_back(read_stage(stage));
  budget.chain.not_run = json.at("not_run").get<std::vector<std::string>>();
  budget.remarks = json.at("remarks").get<std::vector<std::string>>();
  for (const Json& row : json.at("rows")) budget.rows.push_back(read_row(row));
  budget.seconds = json.at("seconds").get<double>();
  return budget;
}

}  // namespace ciliaval::compare::budget
