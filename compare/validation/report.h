// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string>

#include "compare/output/table.h"
#include "compare/validation/validation.h"

namespace ciliaval::compare::validation {

/// The validation for a terminal: the domain, then for each measurand and model a line for each
/// value with D, S, E, the uncertainties and the verdict, and χ² over the values. Units as
/// text_table.h shows them.
std::string text(const Validation& validation, output::Footnotes which);

/// The key `validation` of summary.json (docs/guide/results.md), SI units.
std::string json(const Validation& validation);

}  // namespace ciliaval::compare::validation
