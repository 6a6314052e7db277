// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/models/magnet_forces.h"

#include "analytic/forces/wrench.h"
#include "problem/error.h"

namespace ciliaval::compare::models {

std::vector<MagnetForce> forces_on_magnets(const Cilium& cilium, const MechanicsStep& step) {
  std::vector<MagnetForce> result;
  if (!step.deformation) return result;
  for (const auto& magnet : acting_environment(step.load).magnets) {
    if (magnet.magnetization.isZero(0)) continue;
    try {
      const auto on_cilium =
          analytic::forces::wrench_on_cilium(cilium, *step.deformation, {magnet});
      result.push_back({magnet.name, -on_cilium.force,
                        magnet.position.cross(on_cilium.force) - on_cilium.torque});
    } catch (const SolverError&) {
      return {};
    }
  }
  return result;
}

}  // namespace ciliaval::compare::models
