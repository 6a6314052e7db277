// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string_view>

#include "compare/input/model_entry.h"
#include "problem/joints/joints.h"

/// The option `joints` of the rods.
namespace ciliaval::compare::models::entries {

inline constexpr std::string_view joints_doc =
    "`corrected`: clamp and interfaces, where bonded sections can neither contract nor warp, are "
    "as stiff as in the solid, large strains of bending soften as in neo-Hooke's, and what the "
    "corrections are uncertain by counts as the model's error.";

inline input::Choices<joints::Correction> corrections() {
  return {{"none", joints::Correction::none}, {"corrected", joints::Correction::corrected}};
}

/// Reports a contact whose upper edge, to which the rim comes down, is not below the tip.
void check_rim(const input::CaseCheck& check);

/// Reports, at the option of the model, what the corrections do not reach: the cilium, or a sweep.
void check_joints(const input::CaseCheck& check, std::string_view model,
                  joints::Correction correction);

}  // namespace ciliaval::compare::models::entries
