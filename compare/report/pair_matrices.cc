// SPDX-License-Identifier: LGPL-2.1-or-later
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "compare/report/sections.h"

namespace ciliaval::compare::report {
namespace {

/// Which of the comparisons stand in a matrix.
struct Selection {
  std::optional<std::size_t> step;  ///< none: over the load path
  const char* quantity;
  const char* component;  ///< "" for none
  const char* statistic;
};

bool is_in(const Json& c, const Selection& selection) {
  const Json& step = c.at("step");
  const Json& sensor = c.at("sensor");
  return (step.is_null() ? !selection.step : selection.step == step.get<std::size_t>()) &&
         (sensor.is_null() || sensor.get<std::size_t>() == 0) &&
         c.at("quantity").get<std::string>() == selection.quantity &&
         text_at(c, "component") == selection.component &&
         c.at("statistic").get<std::string>() == selection.statistic;
}

/// The class of an error's size: from below 0.1 % to 20 % and more.
std::string shade(double relative) {
  const double size = std::abs(relative);
  if (size < 1e-3) return "";
  return size < 1e-2 ? "e1" : size < 5e-2 ? "e2" : size < 0.2 ? "e3" : "e4";
}

/// "10.3 ± 0.2", in %; "~" what is below its uncertainty, "?" what is inconclusive.
Cell error_cell(const Json& c) {
  const Json& relative = c.at("relative");
  if (relative.is_null()) return unknown;
  const std::string verdict = c.at("verdict").get<std::string>();
  const Json& scale = c.at("scale");
  Json uncertainty;
  if (!c.at("uncertainty").is_null() && !scale.is_null() && scale.get<double>() != 0)
    uncertainty = c["uncertainty"].get<double>() / std::abs(scale.get<double>());
  std::string text = number(relative, 0.01, 3);
  // Of an uncertainty that the digits of the value hide, nothing is shown.
  if (!uncertainty.is_null() &&
      (verdict != "resolved" ||
       uncertainty.get<double>() > 1e-3 * std::abs(relative.get<double>())))
    text += fmt::format(" ± {}", number(uncertainty, 0.01, 1));
  if (verdict == "resolved") return {text, shade(relative.get<double>())};
  return {(verdict == "inconclusive" ? "? " : "~ ") + text, "faint"};
}

/// A row for each model, a column for each reference; empty if there is nothing to compare.
Table matrix(const Json& summary, const Selection& selection, std::string caption) {
  std::vector<std::string> models;
  std::vector<std::string> references;
  const auto add = [](std::vector<std::string>& names, const std::string& name) {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  };
  std::vector<const Json*> selected;
  for (const Json& c : summary.at("comparisons"))
    if (is_in(c, selection)) {
      selected.push_back(&c);
      add(models, c.at("model").get<std::string>());
      add(references, c.at("reference").get<std::string>());
    }
  Table table{std::move(caption), {"model \\ reference, %"}, {}};
  table.head.insert(table.head.end(), references.begin(), references.end());
  for (const std::string& model : models) {
    std::vector<Cell> row{model};
    row.resize(1 + references.size(), Cell(""));
    for (const Json* c : selected)
      if ((*c)["model"] == model) {
        const auto column =
            std::find(references.begin(), references.end(), (*c)["reference"].get<std::string>());
        row[1 + static_cast<std::size_t>(column - references.begin())] = error_cell(*c);
      }
    table.rows.push_back(std::move(row));
  }
  return table;
}

std::string matrices_of_step(const Json& summary, std::size_t step, std::size_t steps) {
  const std::string of = fmt::format("load step {} of {}", step + 1, steps);
  std::string text = html(matrix(summary, {step, "centreline", "", "maximum"},
                                 "Shapes, " + of +
                                     ": largest distance over the reference's tip "
                                     "deflection"));
  for (const char* axis : {"x", "y", "z"})
    text += html(
        matrix(summary, {step, "dB", axis, "value"},
               fmt::format("ΔB_{}, {}: difference over the reference's largest |ΔB|", axis, of)));
  return text;
}

/// R² and the squared correlation of w(z), of each pair of mechanics models at each step.
Table agreement(const Json& summary) {
  Table table{"Agreement of the shapes w(z): R² without a fit, and the squared correlation",
              {"step, model, reference", "R²", "correlation²"},
              {}};
  for (const Json& c : summary.at("comparisons"))
    if (c.at("statistic").get<std::string>() == "r2")
      table.rows.push_back(
          {fmt::format("{}, {}, {}", c.at("step").get<std::size_t>() + 1,
                       c.at("model").get<std::string>(), c.at("reference").get<std::string>()),
           number(c.at("r2"), 1, 7), number(c.at("correlation"), 1, 7)});
  return table;
}

}  // namespace

std::string pair_matrices(const Json& summary) {
  constexpr std::size_t most_steps = 8;
  const std::size_t steps = summary.at("steps").size();
  std::string shown;
  std::string others;
  std::size_t count = 0;
  for (std::size_t step = steps; step-- > 0 && count < most_steps;) {
    const std::string text = matrices_of_step(summary, step, steps);
    if (text.empty()) continue;
    (count++ == 0 ? shown : others) += text;
  }
  if (shown.empty()) return {};
  std::string path;
  for (const char* axis : {"x", "y", "z"})
    path += html(
        matrix(summary, {std::nullopt, "dB", axis, "rrmse"},
               fmt::format("ΔB_{} over the load path: relative root-mean-square error", axis)));
  return heading(3, "Pairs of models") +
         paragraph(
             "Each cell is the model less its reference in %, ± the numerical uncertainty of "
             "the two, where it is more than a thousandth of it. The reference leaves out less; it "
             "is not the truth. Shaded: resolved, "
             "from 0.1, 1, 5 and 20 % on. ~: below its uncertainty, nothing can be told from "
             "zero. ?: inconclusive, a model does not know its uncertainty. Fields: sensor "
             "0. Every comparison is in errors.csv.") +
         shown + details("The other load steps", others) +
         details("Over the load path (RRMSE)", path) +
         details("R² of the shapes", html(agreement(summary)));
}

}  // namespace ciliaval::compare::report
