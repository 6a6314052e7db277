// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <span>

#include "compare/models/run.h"

namespace ciliaval::compare::validation {

/// Sets what one standard uncertainty of each [[input_uncertainty]] makes of the results,
/// MechanicsRun::input_parts and FieldStep::B_input_parts, dB_input_parts, by central differences.
/// A quick model is shifted itself; a slow one has those of the most detailed quick one. Without
/// such tables nothing is done. Throws InputError as read_inputs().
void add_input_parts(models::CaseResult& result, std::span<const models::MechanicsEntry> mechanics,
                     std::span<const models::FieldEntry> fields, const Progress& progress = {});

}  // namespace ciliaval::compare::validation
