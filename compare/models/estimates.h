// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include "compare/input/model_entry.h"

namespace ciliaval::compare::models {

/// Rods without estimates of their errors, which take a solution more each: for those who want
/// numbers alone.
void without_error_estimates(input::ModelOptions& options);

}  // namespace ciliaval::compare::models
