// SPDX-License-Identifier: LGPL-2.1-or-later
// Budget, convergence and regression check.
#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "compare/budget/report.h"
#include "compare/convergence/plot.h"
#include "compare/report/sections.h"

namespace ciliaval::compare::report {
namespace {

std::string row_name(const budget::BudgetRow& row) {
  if (row.quantity == "tip") return "tip " + row.component;
  if (row.quantity == "tip_angle") return "tip angle";
  return fmt::format("{}{}{}", row.quantity == "sensitivity" ? "d|ΔB|/dF" : row.quantity,
                     row.component.empty() ? "" : "_" + row.component,
                     row.sensor.value_or(0) > 0 ? fmt::format(", sensor {}", *row.sensor) : "");
}

std::string link_text(const budget::BudgetLink& link, double unit) {
  const std::string mark = link.verdict == models::Verdict::resolved            ? ""
                           : link.verdict == models::Verdict::below_uncertainty ? "~ "
                                                                                : "? ";
  const std::string value = number(link.value, unit, 4);
  return mark + (link.uncertainty
                     ? fmt::format("{} ± {}", value, number(*link.uncertainty, unit, 1))
                     : value);
}

Table budget_table(const budget::Budget& budget, std::size_t step, const std::string& load) {
  Table table{fmt::format("Load step {}{}", step + 1, load.empty() ? "" : ": " + load),
              {"number", "paper's model", "links: next − previous", "best model", "total"},
              {}};
  for (const budget::BudgetRow& row : budget.rows) {
    if (row.step != step) continue;
    const ShownUnit unit = shown_unit(row.unit);
    std::vector<std::string> links;
    for (const budget::BudgetLink& link : row.links)
      links.push_back(fmt::format("{} {}", link.to, link_text(link, unit.size)));
    table.rows.push_back({fmt::format("{}, {}", row_name(row), unit.name),
                          number(row.paper, unit.size),
                          {fmt::format("{}", fmt::join(links, "; ")), "text"},
                          number(row.best, unit.size),
                          link_text(row.total, unit.size)});
  }
  return table;
}

bool is_shown(const std::string& id) {
  return id.find("/tip/") != std::string::npos || id.ends_with("/tip_angle") ||
         id.find("slip_off") != std::string::npos || id.find("/dB/") != std::string::npos;
}

Table convergence_table(const convergence::RefinementStudy& study) {
  Table table{fmt::format("{}, {} {:g}, finest first ({:.3g} s)", study.model, study.option,
                          fmt::join(study.settings, ", "), fmt::join(study.seconds, ", ")),
              {"quantity", "unit", "finest", "order", "extrapolated", "±", "remark"},
              {}};
  for (const convergence::ConvergedQuantity& q : study.quantities) {
    if (!is_shown(q.id) || q.levels.empty()) continue;
    const convergence::Extrapolation& e = q.extrapolation;
    table.rows.push_back({q.id,
                          {q.unit, "word"},
                          number(q.levels.front().value, 1, 9),
                          e.order ? fmt::format("{:.2f}", *e.order) : unknown,
                          e.conclusive ? number(e.limit, 1, 9) : unknown,
                          e.conclusive ? number(e.uncertainty, 1, 2) : unknown,
                          {e.conclusive ? e.reason : "inconclusive: " + e.reason, "text"}});
  }
  return table;
}

}  // namespace

std::string budget_content(const Json& json, Figures& figures) {
  const budget::Budget budget = budget::read_budget(json);
  Table chain{"From the paper's model to the best one, an assumption at a time",
              {"model", "what changes"},
              {}};
  for (const budget::Stage& stage : budget.chain.stages)
    chain.rows.push_back(
        {stage.name(),
         {stage.physics.empty() ? "the paper's model: elastica, dipoles along the centreline"
                                : stage.physics,
          "text"}});
  std::string text = html(chain);
  std::vector<std::string> remarks = budget.remarks;
  for (const std::string& name : budget.chain.not_run) remarks.push_back("not run: " + name);
  text += list(remarks);
  const Json& loads = at_or_null(json, "loads");
  const auto load = [&](std::size_t step) {
    return loads.is_null() ? std::string() : loads.at(step).get<std::string>();
  };
  std::vector<Drawing> drawings;
  for (const budget::WaterfallPanel& panel : budget::waterfall_panels(budget))
    drawings.push_back(
        {fmt::format("Error budget of {}", panel.quantity),
         fmt::format("{} at load step {}{}: bars from the paper's model to the best, whiskers the "
                     "numerical uncertainty; grey: below it; hollow: it is not known.",
                     panel.quantity, panel.step + 1,
                     load(panel.step).empty() ? "" : ", " + load(panel.step)),
         panel.drawing.script, panel.drawing.size});
  text += figures.row(drawings, Figures::Width::wide);
  std::vector<std::size_t> steps;
  for (const budget::BudgetRow& row : budget.rows)
    if (std::find(steps.begin(), steps.end(), row.step) == steps.end()) steps.push_back(row.step);
  std::string tables;
  for (const std::size_t step : steps) tables += html(budget_table(budget, step, load(step)));
  if (!tables.empty())
    tables += paragraph(
        "±: numerical uncertainty. ~: below it, cannot be told from zero. ?: "
        "inconclusive, it is not known.");
  return text + details("The budget's numbers", tables);
}

std::string convergence_content(const Json& json, Figures& figures) {
  const std::vector<convergence::RefinementStudy> studies = convergence::read_studies(json);
  std::vector<std::string> failures;
  std::vector<Drawing> drawings;
  std::string tables;
  for (const convergence::RefinementStudy& study : studies) {
    if (!study.failure.empty()) {
      failures.push_back(fmt::format("{}: inconclusive: {}", study.model, study.failure));
      continue;
    }
    const convergence::ConvergencePlot drawing = convergence::convergence_panel(study);
    drawings.push_back(
        {fmt::format("Convergence of {}", study.model),
         fmt::format("{}, {}: distance from the extrapolated limit f₀ over h, {}. Lines: "
                     "the observed order. Grey crosses: inconclusive, distance from the finest "
                     "level.",
                     study.model, study.option, study.size_name),
         drawing.script, drawing.size});
    tables += html(convergence_table(study));
  }
  return list(failures) + figures.row(drawings, Figures::Width::wide) +
         details("Orders and intervals", tables);
}

std::string check_content(const Json& check) {
  Table table{
      "Results against the accepted ones", {"case", "passed", "numbers compared", "failures"}, {}};
  std::vector<std::string> failures;
  for (const Json& entry : check.at("cases")) {
    const std::string name = entry.at("case").get<std::string>();
    const bool passed = entry.at("passed").get<bool>();
    table.rows.push_back({name,
                          {passed ? "yes" : "no", passed ? "word" : "word bad"},
                          number(entry.at("compared"), 1, 9),
                          number(entry.at("failures"), 1, 9)});
    for (const Json& finding : entry.at("findings"))
      if (!finding.at("passed").get<bool>())
        failures.push_back(fmt::format("{}: {}: {}", name, finding.at("id").get<std::string>(),
                                       text_at(finding, "message")));
  }
  return html(table) + list(failures);
}

}  // namespace ciliaval::compare::report
