// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/models/entries/joints.h"

#include <fmt/format.h>

#include "compare/input/case.h"
#include "problem/error.h"

namespace ciliaval::compare::models::entries {

void check_joints(const input::CaseCheck& check, std::string_view model,
                  joints::Correction correction) {
  if (!check.is_asked_for || correction == joints::Correction::none) return;
  const std::string option = fmt::format("models.{}.joints", model);
  if (check.load_is_right && check.problem.load_path.front().is<SweepLoad>())
    return check.report(option, "the corrected joints take no sweep: use joints = 'none'");
  if (!check.cilium_is_right) return;
  try {
    joints::corrections(check.problem.cilium);
  } catch (const InputError& error) {
    check.report(option, error.what());
  }
}

}  // namespace ciliaval::compare::models::entries
