// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <span>

#include "compare/models/run.h"

namespace ciliaval::compare::models {

/// Sets the options by which the model leaves out least, corrected joints. Says why it does not
/// take the case with them, or has no such options; empty: it does.
std::string correct(const MechanicsEntry& entry, input::Case& problem);

/// Sets what each model leaves out, MechanicsRun::model_parts and FieldStep::B_model_part,
/// dB_model_part (docs/theory/band.md). A rod and its fields are held against the most detailed rod
/// with corrected joints and the most detailed field that takes but a moment; where the corrections
/// do not reach, and of all other models, it is not known, and the result says why.
void add_model_parts(CaseResult& result, std::span<const MechanicsEntry> mechanics,
                     std::span<const FieldEntry> fields, const Progress& progress = {});

}  // namespace ciliaval::compare::models
