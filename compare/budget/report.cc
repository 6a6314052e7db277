// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/budget/report.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <string_view>

#include "compare/output/table.h"

namespace ciliaval::compare {
namespace {

using Json = nlohmann::ordered_json;

/// A unit that people read: the SI value is divided by `size`.
struct Unit {
  std::string_view name;
  double size;
  int decimals;
};

Unit shown_unit(std::string_view si) {
  if (si == "m") return {"mm", 1e-3, 5};
  if (si == "rad") return {"deg", std::numbers::pi / 180, 4};
  if (si == "T") return {"uT", 1e-6, 3};
  if (si == "T/N") return {"uT/mN", 1e-3, 3};
  if (si == "T/(N/m)") return {"uT/(N/m)", 1e-6, 3};
  return {"uT/mm", 1e-3, 3};
}

/// A number without the sign of a zero.
std::string number(double value, int decimals) {
  const std::string text = fmt::format("{:.{}f}", value, decimals);
  const bool is_zero = text.find_first_not_of("-0.") == std::string::npos;
  return is_zero && text.starts_with('-') ? text.substr(1) : text;
}

constexpr int cell_width = 26;

/// "-0.06421 +- 2.1e-06" and a mark: ~ below its uncertainty, ? inconclusive.
std::string link_cell(const BudgetLink& link, const Unit& unit) {
  const char mark = link.verdict == Verdict::resolved            ? ' '
                    : link.verdict == Verdict::below_uncertainty ? '~'
                                                                 : '?';
  const std::string value = number(link.value / unit.size, unit.decimals);
  const std::string interval =
      link.uncertainty ? fmt::format("{:.2g}", *link.uncertainty / unit.size) : "unknown";
  return fmt::format("{:>13} +-{:>8} {}", value, interval, mark);
}

std::string value_cell(double value, const Unit& unit) {
  return fmt::format("{:<{}}", fmt::format("{:>13}", number(value / unit.size, unit.decimals)),
                     cell_width);
}

/// The rows that stand side by side in a table.
using Group = std::vector<const BudgetRow*>;

/// Those of one quantity at one step, of the mechanics or at the first sensor.
Group group_of(const Budget& budget, std::size_t step, std::string_view quantity) {
  Group group;
  for (const BudgetRow& row : budget.rows)
    if (row.step == step && row.quantity == quantity && row.sensor.value_or(0) == 0)
      group.push_back(&row);
  return group;
}

/// |link| over |best|, as vectors.
std::string percent(const Group& group, const std::vector<const BudgetLink*>& links) {
  double link = 0;
  double best = 0;
  for (std::size_t i = 0; i < group.size(); ++i) {
    link += std::pow(links[i]->value, 2);
    best += std::pow(group[i]->best, 2);
  }
  return best > 0 ? fmt::format("{:>10.3g}", 100 * std::sqrt(link / best))
                  : fmt::format("{:>10}", "-");
}

std::string link_line(const Group& group, const std::string& label,
                      const std::vector<const BudgetLink*>& links, bool with_percent) {
  std::string line = fmt::format("  {:<32}", label);
  for (std::size_t i = 0; i < group.size(); ++i)
    line += link_cell(*links[i], shown_unit(group[i]->unit));
  if (with_percent) line += percent(group, links);
  line.erase(line.find_last_not_of(' ') + 1);
  return line + '\n';
}

std::string value_line(const Group& group, const std::string& label, bool best) {
  std::string line = fmt::format("  {:<32}", label);
  for (const BudgetRow* row : group)
    line += value_cell(best ? row->best : row->paper, shown_unit(row->unit));
  line.erase(line.find_last_not_of(' ') + 1);
  return line + '\n';
}

/// The paper's values, the links, their total, the best values, the model beside.
std::string group_table(const Group& group, const std::string& title, bool is_field) {
  if (group.empty()) return {};
  std::string text = fmt::format("\n  {:<32}", title);
  for (const BudgetRow* row : group)
    text += fmt::format(
        "{:<{}}",
        fmt::format("{:>13}",
                    fmt::format("{} ({})", row->component.empty() ? "angle" : row->component,
                                shown_unit(row->unit).name)),
        cell_width);
  if (is_field)
    text += fmt::format("{:>10}", "% (1)");
  else
    text.erase(text.find_last_not_of(' ') + 1);
  text += '\n';
  const auto collect = [&](auto&& link_of) {
    std::vector<const BudgetLink*> links;
    for (const BudgetRow* row : group) links.push_back(link_of(*row));
    return links;
  };
  text += value_line(group, group.front()->total.from, false);
  for (std::size_t i = 0; i < group.front()->links.size(); ++i) {
    const auto links = collect([&](const BudgetRow& row) { return &row.links[i]; });
    text += link_line(group, "-> " + links.front()->to, links, is_field);
  }
  text +=
      link_line(group, "total", collect([](const BudgetRow& row) { return &row.total; }), is_field);
  text += value_line(group, group.front()->total.to, true);
  if (group.front()->beside)
    text += link_line(group, "beside: " + group.front()->beside->to,
                      collect([](const BudgetRow& row) { return &*row.beside; }), is_field);
  return text;
}

std::string step_text(const Budget& budget, std::size_t step) {
  Group mechanics = group_of(budget, step, "tip");
  const Group angle = group_of(budget, step, "tip_angle");
  mechanics.insert(mechanics.end(), angle.begin(), angle.end());
  const std::string text =
      group_table(mechanics, "tip", false) +
      group_table(group_of(budget, step, "B"), "B at sensor 0", true) +
      group_table(group_of(budget, step, "dB"), "dB at sensor 0", true) +
      group_table(group_of(budget, step, "sensitivity"), "d(dB)/d(load) at sensor 0", true);
  if (text.empty()) return {};
  return fmt::format("\nStep {} of {}: {}\n", step + 1, budget.load_path.size(),
                     describe(budget.load_path[step])) +
         text;
}

std::string chain_text(const Budget& budget) {
  std::string text =
      budget.case_name + ": from the paper's model to the best one, an assumption at a time\n\n";
  const auto line = [&](const std::string& label, const std::string& physics) {
    text += fmt::format("  {:<32}{}\n", label, physics);
  };
  for (const Station& station : budget.chain.stations)
    if (&station == &budget.chain.stations.front())
      line(station.name(), "the paper's model: elastica, dipoles along the centreline");
    else
      line("-> " + station.name(), station.physics);
  if (budget.chain.beside)
    line("beside: " + budget.chain.beside->name(),
         budget.chain.beside->physics + "; not in the sum");
  for (const std::string& name : budget.chain.not_run) line("not run", name);
  for (const std::string& remark : budget.remarks) line("note", remark);
  return text;
}

constexpr const char* legend =
    "\nEach line is next - previous model, +- its numerical uncertainty: discretisation, "
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
          {"uncertainty", link.uncertainty ? Json(*link.uncertainty) : Json(nullptr)},
          {"verdict", to_string(link.verdict)}};
}

Json row_json(const BudgetRow& row) {
  Json json{{"step", row.step},
            {"sensor", row.sensor ? Json(*row.sensor) : Json(nullptr)},
            {"quantity", row.quantity},
            {"component", row.component.empty() ? Json(nullptr) : Json(row.component)},
            {"unit", row.unit},
            {"paper_model", row.total.from},
            {"paper", row.paper},
            {"best_model", row.total.to},
            {"best", row.best},
            {"total", link_json(row.total)},
            {"links", Json::array()},
            {"beside", row.beside ? link_json(*row.beside) : Json(nullptr)}};
  for (const BudgetLink& link : row.links) json["links"].push_back(link_json(link));
  return json;
}

std::string csv_line(const BudgetRow& row, std::string_view kind, const BudgetLink& link) {
  return fmt::format("{},{},{},{},{},{},\"{}\",\"{}\",{},{},{}\n", row.step,
                     row.sensor ? fmt::format("{}", *row.sensor) : "", row.quantity, row.component,
                     row.unit, kind, link.from, link.to, link.value,
                     link.uncertainty ? fmt::format("{}", *link.uncertainty) : "",
                     to_string(link.verdict));
}

}  // namespace

std::string budget_text(const Budget& budget) {
  std::string text = chain_text(budget);
  for (std::size_t step = 0; step < budget.load_path.size(); ++step)
    text += step_text(budget, step);
  if (budget.rows.empty()) return text + "\nThere is no difference to split.\n";
  text += legend;
  const bool others = std::any_of(budget.rows.begin(), budget.rows.end(),
                                  [](const BudgetRow& row) { return row.sensor.value_or(0) > 0; });
  if (others) text += "The other sensors are in the JSON and the CSV.\n";
  return text;
}

std::string budget_json(const Budget& budget, const Provenance& provenance) {
  Json json{{"schema", 1},
            {"case", budget.case_name},
            {"provenance", to_json(provenance)},
            {"loads", Json::array()},
            {"chain", Json::array()},
            {"not_run", budget.chain.not_run},
            {"remarks", budget.remarks},
            {"seconds", budget.seconds},
            {"rows", Json::array()}};
  for (const Load& load : budget.load_path) json["loads"].push_back(describe(load));
  for (const Station& station : budget.chain.stations)
    json["chain"].push_back({{"name", station.name()}, {"physics", station.physics}});
  for (const BudgetRow& row : budget.rows) json["rows"].push_back(row_json(row));
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + '\n';
}

std::string budget_csv(const Budget& budget) {
  std::string text = "step,sensor,quantity,component,unit,kind,from,to,value,uncertainty,verdict\n";
  for (const BudgetRow& row : budget.rows) {
    for (const BudgetLink& link : row.links) text += csv_line(row, "link", link);
    text += csv_line(row, "total", row.total);
    if (row.beside) text += csv_line(row, "beside", *row.beside);
  }
  return text;
}

}  // namespace ciliaval::compare
