// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/models/entries/joints.h"

#include <fmt/format.h>

#include "compare/input/case.h"
#include "fem/solid/solid_options.h"
#include "problem/error.h"

namespace ciliaval::compare::models::entries {

void check_rim(const input::CaseCheck& check) {
  if (!check.is_asked_for || !check.load_is_right) return;
  const double w = check.problem.options.of<fem::solid::SolidOptions>().kernel_width;
  const double length = check.problem.cilium.length();
  for (std::size_t i = 0; i < check.problem.load_path.size(); ++i) {
    const Load& load = check.problem.load_path[i];
    const std::optional<double> h = contact_height(load);
    if (load.slip_off_point() == SlipOffPoint::rim && h && *h < length && *h + w >= length)
      return check.report(
          fmt::format("load.height[{}]", i),
          fmt::format(
              "with slip_off = 'rim' the contact's upper edge, {:g} m above the height {:g} "
              "m, must lie below the tip at {:g} m: move the contact, set a smaller "
              "'kernel_width' in [models.solid], or use slip_off = 'axis'",
              w, *h, length));
  }
}

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
