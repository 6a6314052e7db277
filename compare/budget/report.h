// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "compare/budget/budget.h"
#include "compare/output/provenance.h"
#include "compare/plot/gnuplot.h"

namespace ciliaval::compare::budget {

/// The budget for a terminal: the assumption of each link, then for each step a table of tip and
/// tip angle and of B, ΔB and dB/dF at the first sensor: the paper's value, each link with its
/// uncertainty, the best value. Lengths in mm, angles in degrees, fields in µT.
std::string budget_text(const Budget& budget);

/// {"schema": 1, "case", "chain": [{"name", "physics"}], "not_run", "remarks", "seconds", "rows":
/// [{"step", "sensor", "quantity", "component", "unit", "paper_model", "paper", "best_model",
/// "best", "total": LINK, "links": [LINK], "beside": LINK or null}]}, LINK = {"from", "to",
/// "physics", "value", "uncertainty", "verdict"}; SI units. "loads" are the steps' in words,
/// "provenance" as in summary.json.
std::string budget_json(const Budget& budget, const output::Provenance& provenance);

/// A line for each link, total and model beside: step, sensor, quantity, component, unit, kind
/// ("link", "total", "beside"), from, to, value, uncertainty, verdict; SI units.
std::string budget_csv(const Budget& budget);

/// A script for gnuplot (compare/plot/gnuplot.h).
struct Waterfall {
  std::string script;  ///< empty if there is nothing to draw
  plot::Size size;
};

/// The links one below the other as bars from the paper's model to the best one: the component of
/// the tip that changes most and the three of ΔB at the first sensor, of the last step with rows.
/// Whiskers are the uncertainties; grey bars are below theirs, hollow ones inconclusive.
Waterfall waterfall(const Budget& budget);

/// The same for a page that may be narrow: a drawing for each of its columns, without a legend.
struct WaterfallPanel {
  std::string quantity;  ///< "tip x, mm"
  std::size_t step = 0;
  Waterfall drawing;
};
std::vector<WaterfallPanel> waterfall_panels(const Budget& budget);

/// The chain's models, the rows and the remarks of a text that budget_json() made. Throws what
/// nlohmann::json does if it is not.
Budget read_budget(const nlohmann::ordered_json& json);

}  // namespace ciliaval::compare::budget
