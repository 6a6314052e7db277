// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string>

#include "compare/budget/budget.h"
#include "compare/plot/gnuplot.h"

namespace ciliaval::compare {

/// The budget for a terminal: what each link changes, then for each step a table of tip and tip
/// angle and of B, ΔB and dB/dF at the first sensor: the paper's value, each link with its
/// uncertainty, the best value. Lengths in mm, angles in degrees, fields in µT.
std::string budget_text(const Budget& budget);

/// {"schema": 1, "case", "chain": [{"name", "physics"}], "not_run", "remarks", "seconds", "rows":
/// [{"step", "sensor", "quantity", "component", "unit", "paper_model", "paper", "best_model",
/// "best", "total": LINK, "links": [LINK], "beside": LINK or null}]}, LINK = {"from", "to",
/// "physics", "value", "uncertainty", "verdict"}; SI units.
std::string budget_json(const Budget& budget);

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

}  // namespace ciliaval::compare
