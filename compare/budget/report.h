// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "compare/budget/budget.h"
#include "compare/output/provenance.h"
#include "compare/output/table.h"

namespace ciliaval::compare::budget {

/// The budget for a terminal: the assumption of each link, then for each step a table of tip and
/// tip angle and of B, ΔB and dB/dF at the first sensor: the paper's value, each link with its
/// uncertainty, the best value. Lengths in mm, angles in degrees, fields in µT.
std::string budget_text(const Budget& budget, output::Footnotes which);

/// {"schema": 1, "case", "chain": [{"name", "physics"}], "not_run", "remarks", "seconds", "rows":
/// [{"step", "sensor", "quantity", "component", "unit", "paper_model", "paper", "best_model",
/// "best", "total": LINK, "links": [LINK], "beside": LINK or null}]}, LINK = {"from", "to",
/// "physics", "value", "uncertainty", "verdict"}; SI units. "loads" are the steps' in words,
/// "provenance" as in summary.json.
std::string budget_json(const Budget& budget, const output::Provenance& provenance);

/// A line for each link, total and model beside: step, sensor, quantity, component, unit, kind
/// ("link", "total", "beside"), from, to, value, uncertainty, verdict; SI units.
std::string budget_csv(const Budget& budget);

}  // namespace ciliaval::compare::budget
