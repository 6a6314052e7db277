// SPDX-License-Identifier: LGPL-2.1-or-later
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "compare/budget/report.h"
#include "compare/output/table.h"

namespace ciliaval::compare::budget {
namespace {

/// A drawn row with the unit of its axis.
struct Panel {
  const BudgetRow* row;
  std::string title;
  double unit;
};

/// The rows of a step: the tip's component with the largest difference, ΔB at the first sensor.
std::vector<Panel> panels_of(const Budget& budget, std::size_t step) {
  std::vector<Panel> panels;
  const BudgetRow* tip = nullptr;
  for (const BudgetRow& row : budget.rows)
    if (row.step == step && row.quantity == "tip" &&
        (tip == nullptr || std::abs(row.total.value) > std::abs(tip->total.value)))
      tip = &row;
  if (tip != nullptr) panels.push_back({tip, "tip " + tip->component + ", mm", 1e-3});
  for (const BudgetRow& row : budget.rows)
    if (row.step == step && row.quantity == "dB" && row.sensor == 0)
      panels.push_back({&row, "dB_" + row.component + ", µT", 1e-6});
  return panels;
}

std::string_view style_of(models::Verdict verdict) {
  switch (verdict) {
    case models::Verdict::resolved:
      return "fc rgb '#4477aa' fs solid 1 border lc rgb '#4477aa'";
    case models::Verdict::below_uncertainty:
      return "fc rgb '#aaaaaa' fs solid 1 border lc rgb '#777777'";
    case models::Verdict::inconclusive:
      break;
  }
  return "fc rgb '#aa3377' fs empty border lc rgb '#aa3377'";
}

/// The line of the stage that a link leads to: for a mechanics model the first stage with it.
std::size_t line_of(const Budget& budget, const std::string& to) {
  const std::vector<Stage>& stages = budget.chain.stages;
  const auto it = std::find_if(stages.begin(), stages.end(), [&](const Stage& stage) {
    return stage.name() == to || stage.mechanics == to;
  });
  return static_cast<std::size_t>(it - stages.begin());
}

/// A bar from `from` to `to` on a line, with whiskers at `to`.
std::string bar(double from, double to, std::size_t line, double uncertainty,
                std::string_view style) {
  const auto y = static_cast<double>(line);
  const double half = 0.36;
  std::string text =
      fmt::format("set object rectangle from first {}, first {} to first {}, first {} {} front\n",
                  std::min(from, to), y - half, std::max(from, to), y + half, style);
  if (uncertainty > 0)
    text += fmt::format(
        "set arrow from first {}, first {} to first {}, first {} heads size screen 0.004,90 lw 1.3 "
        "lc rgb 'black' front\n",
        to - uncertainty, y, to + uncertainty, y);
  return text;
}

/// The lines' names, or marks without them.
std::string line_names(const Budget& budget, bool shown) {
  std::string text = "set ytics (";
  std::size_t line = 0;
  for (const Stage& stage : budget.chain.stages) {
    if (line > 0) text += fmt::format("{} {}, ", plot::quoted(shown ? stage.name() : ""), line);
    ++line;
  }
  return text + fmt::format("{} {})\n", plot::quoted(shown ? "total" : ""), line);
}

/// A thin line from the end of a bar to the start of the next one.
std::string joint(double x, std::size_t from, std::size_t to) {
  return fmt::format(
      "set arrow from first {0}, first {1} to first {0}, first {2} nohead lw 0.8 lc rgb 'gray40'\n",
      x, from, to);
}

std::string panel_script(const Budget& budget, const Panel& panel, bool first) {
  const BudgetRow& row = *panel.row;
  const auto lines = static_cast<double>(budget.chain.stages.size());
  std::string text = "unset object\nunset arrow\n";
  double at = 0;
  std::size_t previous = 0;
  double least = 0;
  double largest = 0;
  const auto reach = [&](double value, double uncertainty) {
    least = std::min(least, value - uncertainty);
    largest = std::max(largest, value + uncertainty);
  };
  for (const BudgetLink& link : row.links) {
    const double next = at + link.value / panel.unit;
    const double u = link.uncertainty.value_or(0) / panel.unit;
    if (previous > 0) text += joint(at, previous, line_of(budget, link.to));
    previous = line_of(budget, link.to);
    text += bar(at, next, line_of(budget, link.to), u, style_of(link.verdict));
    reach(next, u);
    at = next;
  }
  text += joint(at, previous, budget.chain.stages.size());
  const double u = row.total.uncertainty.value_or(0) / panel.unit;
  text += bar(0, row.total.value / panel.unit, budget.chain.stages.size(), u,
              "fc rgb '#ddaa33' fs solid 1 border lc rgb '#ddaa33'");
  reach(row.total.value / panel.unit, u);
  if (!(largest > least)) largest = least + 1;
  const double margin = 0.08 * (largest - least);
  text += fmt::format("set title {}\nset xlabel {}\nset xrange [{}:{}]\nset yrange [{}:0.4]\n",
                      plot::quoted(panel.title),
                      plot::quoted(fmt::format("from {:.5g}", row.paper / panel.unit)),
                      least - margin, largest + margin, lines + 0.6);
  text += line_names(budget, first);
  // The curve is the line at zero; the bars are objects.
  return text + "set parametric\nset trange [0:1]\n" +
         fmt::format("plot 0, 0.4 + t*{} with lines lc rgb 'gray40' notitle\nunset parametric\n",
                     lines + 0.2);
}

constexpr int names_width = 240;
constexpr int panel_width = 230;
constexpr int right_margin = 20;

int height_of(const Budget& budget) {
  return 170 + 30 * static_cast<int>(budget.chain.stages.size());
}

constexpr const char* header =
    "unset key\nset samples 2\nset grid x\nset tics nomirror\nset xtics rotate by -40\n";

}  // namespace

Waterfall waterfall(const Budget& budget) {
  if (budget.rows.empty()) return {};
  const std::size_t step = budget.rows.back().step;
  const std::vector<Panel> panels = panels_of(budget, step);
  if (panels.empty()) return {};
  const int count = static_cast<int>(panels.size());
  const plot::Size size{names_width + panel_width * count + right_margin, height_of(budget)};
  std::string script = fmt::format(
      "{}set label 1 {} at screen 0.5, screen 0.04 center\n"
      "set multiplot layout 1,{} title {} margins {},{},0.3,0.82 spacing 0.015\n",
      header,
      plot::quoted(
          "bars from the paper's model to the best, whiskers: numerical uncertainty; grey: "
          "below it; hollow: it is not known"),
      count,
      plot::quoted(fmt::format("{}, step {} of {}: {}", budget.case_name, step + 1,
                               budget.load_path.size(), output::describe(budget.load_path[step]))),
      static_cast<double>(names_width) / size.width,
      1 - static_cast<double>(right_margin) / size.width);
  for (const Panel& panel : panels)
    script += panel_script(budget, panel, &panel == &panels.front()) + "unset label 1\n";
  return {script + "unset multiplot\n", size};
}

std::vector<WaterfallPanel> waterfall_panels(const Budget& budget) {
  std::vector<WaterfallPanel> result;
  if (budget.rows.empty()) return result;
  const std::size_t step = budget.rows.back().step;
  const plot::Size size{names_width + panel_width + right_margin, height_of(budget)};
  for (const Panel& panel : panels_of(budget, step))
    result.push_back({panel.title, step, {header + panel_script(budget, panel, true), size}});
  return result;
}

}  // namespace ciliaval::compare::budget
