// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/budget/report.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "compare/output/csv_writer.h"
#include "compare/output/json_file.h"
#include "compare/output/text_table.h"
#include "problem/error.h"

namespace ciliaval::compare::budget {
namespace {

using Json = nlohmann::ordered_json;

std::string value_cell(double value, std::string_view unit) {
  return output::number_cell(value, output::shown_unit(unit).size,
                             unit == "m"     ? "{:.5f}"
                             : unit == "rad" ? "{:.4f}"
                                             : "{:.3f}");
}

/// "+- 2.1e-06" and a mark: ~ below its uncertainty, ? inconclusive.
std::string interval_cell(const BudgetLink& link, std::string_view unit) {
  const char* mark = link.verdict == models::Verdict::resolved            ? ""
                     : link.verdict == models::Verdict::below_uncertainty ? " ~"
                                                                          : " ?";
  if (!link.uncertainty) return fmt::format("+- unknown{}", mark);
  return fmt::format("+- {:.2g}{}", *link.uncertainty / output::shown_unit(unit).size, mark);
}

/// The rows that stand side by side in a table.
using Group = std::vector<const BudgetRow*>;

/// The rows of one quantity at one step at the first sensor; none: those of the mechanics.
Group group_of(const Budget& budget, std::size_t step, std::optional<std::string_view> quantity) {
  Group group;
  for (const BudgetRow& row : budget.rows)
    if (row.step == step && (quantity ? row.quantity == *quantity && row.sensor == 0 : !row.sensor))
      group.push_back(&row);
  return group;
}

/// "tip x", "tip angle"; of a field its component.
std::string column_name(const BudgetRow& row) {
  if (row.sensor) return row.component;
  std::string name = row.quantity;
  std::ranges::replace(name, '_', ' ');
  return row.component.empty() ? name : fmt::format("{} {}", name, row.component);
}

/// |link| over |best|, as vectors, in %; none where the best is zero.
std::optional<double> percent_of(const Group& group, const std::vector<const BudgetLink*>& links) {
  double link = 0;
  double best = 0;
  for (std::size_t i = 0; i < group.size(); ++i) {
    link += std::pow(links[i]->value, 2);
    best += std::pow(group[i]->best, 2);
  }
  if (best == 0) return std::nullopt;
  return 100 * std::sqrt(link / best);
}

std::string percent(const Group& group, const std::vector<const BudgetLink*>& links) {
  const auto value = percent_of(group, links);
  return value ? fmt::format("{:.3g}", *value) : "-";
}

/// The paper's values, the links, their total, the best values, the model beside.
std::string group_table(const Group& group, const std::string& title, bool is_field) {
  if (group.empty()) return {};
  output::TextRows rows{{title}};
  std::string alignment = "<";
  for (const BudgetRow* row : group) {
    rows[0].push_back(
        fmt::format("{} ({})", column_name(*row), output::shown_unit(row->unit).name));
    rows[0].emplace_back();
    alignment += "><";
  }
  if (is_field) rows[0].emplace_back("% (1)");
  const auto add_values = [&](const std::string& label, double BudgetRow::*value) {
    std::vector<std::string>& cells = rows.emplace_back(1, label);
    for (const BudgetRow* row : group)
      cells.insert(cells.end(), {value_cell(row->*value, row->unit), ""});
  };
  const auto add_links = [&](const std::string& label, auto&& link_of) {
    std::vector<std::string>& cells = rows.emplace_back(1, label);
    std::vector<const BudgetLink*> links;
    for (const BudgetRow* row : group) {
      const BudgetLink& link = *links.emplace_back(&link_of(*row));
      cells.insert(cells.end(),
                   {value_cell(link.value, row->unit), interval_cell(link, row->unit)});
    }
    if (is_field) cells.push_back(percent(group, links));
  };
  const BudgetRow& first = *group.front();
  add_values(first.total.from, &BudgetRow::paper);
  for (std::size_t i = 0; i < first.links.size(); ++i)
    add_links(
        "-> " + first.links[i].to, [&](const BudgetRow& row) -> auto& { return row.links[i]; });
  add_links(
      "total", [](const BudgetRow& row) -> auto& { return row.total; });
  add_values(first.total.to, &BudgetRow::best);
  if (first.beside)
    add_links(
        "beside: " + first.beside->to, [](const BudgetRow& row) -> auto& { return *row.beside; });
  return "\n" + output::text_table(rows, alignment + ">");
}

std::string sensor_name(const Budget& budget, std::size_t sensor) {
  return sensor < budget.sensor_names.size() ? budget.sensor_names[sensor] : std::to_string(sensor);
}

std::string step_text(const Budget& budget, std::size_t step) {
  const std::string at = " at sensor " + sensor_name(budget, 0);
  const std::string text =
      group_table(group_of(budget, step, {}), "shape", false) +
      group_table(group_of(budget, step, "B"), "B" + at, true) +
      group_table(group_of(budget, step, "dB"), "dB" + at, true) +
      group_table(group_of(budget, step, "sensitivity"), "d(dB)/d(load)" + at, true);
  if (text.empty()) return {};
  return fmt::format("\nStep {} of {}: {}\n", step + 1, budget.load_path.size(),
                     output::describe(budget.load_path[step])) +
         text;
}

std::string chain_text(const Budget& budget) {
  output::TextRows rows;
  for (const Stage& stage : budget.chain.stages)
    rows.push_back({(rows.empty() ? "" : "-> ") + stage.name(), stage.physics});
  if (budget.chain.beside)
    rows.push_back({"beside: " + budget.chain.beside->name(),
                    budget.chain.beside->physics + "; not in the sum"});
  for (const std::string& name : budget.chain.not_run) rows.push_back({"not run", name});
  for (const std::string& remark : budget.remarks) rows.push_back({"note", remark});
  return fmt::format("{}: from the paper's model to the best one, an assumption at a time\n\n{}",
                     budget.case_name, output::text_table(rows, "<"));
}

/// The assumptions that change dB at the first sensor most, at the last step that has it; without
/// fields the tip.
std::string largest_links(const Budget& budget) {
  constexpr std::size_t most = 3;
  for (const std::string_view quantity : {"dB", "tip"})
    for (std::size_t step = budget.load_path.size(); step-- > 0;) {
      Group group;
      for (const BudgetRow& row : budget.rows)
        if (row.step == step && row.quantity == quantity && row.sensor.value_or(0) == 0)
          group.push_back(&row);
      if (group.empty()) continue;
      std::vector<std::pair<double, const BudgetLink*>> links;
      for (std::size_t i = 0; i < group.front()->links.size(); ++i) {
        std::vector<const BudgetLink*> components;
        for (const BudgetRow* row : group) components.push_back(&row->links[i]);
        if (const auto percent = percent_of(group, components))
          links.emplace_back(*percent, components.front());
      }
      std::ranges::stable_sort(links, std::greater{}, &std::pair<double, const BudgetLink*>::first);
      if (links.empty()) continue;
      std::string text =
          fmt::format("\nWhat changes {} most at step {}, in % of it:\n", quantity, step + 1);
      for (std::size_t i = 0; i < std::min(most, links.size()); ++i)
        text += fmt::format("  {:>6.2g}  {}\n", links[i].first, links[i].second->physics);
      return text;
    }
  return {};
}

constexpr const char* legend =
    "Each line is next - previous model, +- its numerical uncertainty: discretisation, "
    "quadrature,\n"
    "of dB/dF also truncation. Models on the same deformation share its error, which cancels.\n"
    "~ below its uncertainty: cannot be told from zero. ? inconclusive: an uncertainty is not "
    "known.\n"
    "(1) length of the vector of the link over that of the best model, in %.\n";

// ------------------------------------------------------------------------------------------- files

Json link_json(const BudgetLink& link) {
  return {{"from", link.from},
          {"to", link.to},
          {"physics", link.physics},
          {"value", link.value},
          {"uncertainty", output::or_null(link.uncertainty)},
          {"verdict", models::to_string(link.verdict)}};
}

Json row_json(const BudgetRow& row) {
  Json json{
      {"step", row.step},         {"sensor", row.sensor ? Json(*row.sensor) : Json(nullptr)},
      {"quantity", row.quantity}, {"component", output::or_null(row.component)},
      {"unit", row.unit},         {"paper_model", row.total.from},
      {"paper", row.paper},       {"best_model", row.total.to},
      {"best", row.best},         {"total", link_json(row.total)},
      {"links", Json::array()},   {"beside", row.beside ? link_json(*row.beside) : Json(nullptr)}};
  for (const BudgetLink& link : row.links) json["links"].push_back(link_json(link));
  return json;
}

}  // namespace

std::string budget_text(const Budget& budget, output::Footnotes which) {
  std::string text = chain_text(budget) + largest_links(budget);
  for (std::size_t step = 0; step < budget.load_path.size(); ++step)
    text += step_text(budget, step);
  if (budget.rows.empty()) return text + "\nThere is no difference to split.\n";
  text += '\n' + output::footnotes(which, legend);
  const bool others = std::any_of(budget.rows.begin(), budget.rows.end(),
                                  [](const BudgetRow& row) { return row.sensor.value_or(0) > 0; });
  if (others) text += "The other sensors are in the JSON and the CSV.\n";
  return text;
}

std::string budget_json(const Budget& budget, const output::Provenance& provenance) {
  Json json{{"schema", 1},
            {"case", budget.case_name},
            {"sensor_names", budget.sensor_names},
            {"provenance", output::to_json(provenance)},
            {"loads", Json::array()},
            {"chain", Json::array()},
            {"not_run", budget.chain.not_run},
            {"remarks", budget.remarks},
            {"seconds", budget.seconds},
            {"rows", Json::array()}};
  for (const Load& load : budget.load_path) json["loads"].push_back(output::describe(load));
  for (const Stage& stage : budget.chain.stages)
    json["chain"].push_back({{"name", stage.name()}, {"physics", stage.physics}});
  for (const BudgetRow& row : budget.rows) json["rows"].push_back(row_json(row));
  return output::to_text(json);
}

std::string budget_csv(const Budget& budget) {
  output::CsvWriter csv;
  csv.row("step", "sensor", "quantity", "component", "unit", "kind", "from", "to", "value",
          "uncertainty", "verdict");
  for (const BudgetRow& row : budget.rows) {
    const auto add = [&](std::string_view kind, const BudgetLink& link) {
      csv.row(row.step, row.sensor ? sensor_name(budget, *row.sensor) : "", row.quantity,
              row.component, row.unit, kind, link.from, link.to, link.value, link.uncertainty,
              models::to_string(link.verdict));
    };
    for (const BudgetLink& link : row.links) add("link", link);
    add("total", row.total);
    if (row.beside) add("beside", *row.beside);
  }
  return csv.text();
}

}  // namespace ciliaval::compare::budget
