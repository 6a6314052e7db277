// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <vector>

#include "compare/input/case.h"

namespace ciliaval::compare::results {

/// Flux density of the uniform field and the magnets of the environment at each sensor of the case,
/// at each step, T: what a chip reads beside the cilium's field. Empty where it is the same at all
/// steps, and so is no part of a change.
std::vector<std::vector<Vector3>> external_field(const input::Case& problem);

}  // namespace ciliaval::compare::results
