// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <optional>

#include "compare/input/case.h"
#include "compare/input/model_entry.h"
#include "problem/support/fingerprint.h"

namespace ciliaval::compare::models {

/// All of a case: each key of its canonical text (input::to_toml()) with its value, dotted, the
/// tables of a list counted from 1; without the table [case] of names. A mesh or a profile in a
/// file counts by its content, wherever it lies.
support::Fingerprint fingerprint(const input::Case& problem);

/// The fingerprint of a mechanics model's checkpoint: all of the case but what its result cannot
/// depend on, because it is computed from it or set beside it: other models, sensors, signal,
/// readings, measurements; and the options that may be raised after a failure. An error limit of
/// the field depends on sensors and models, too. None if the model keeps no checkpoint.
std::optional<support::Fingerprint> fingerprint(const input::Case& problem,
                                                const input::MechanicsEntry& entry);

}  // namespace ciliaval::compare::models
