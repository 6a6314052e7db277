// SPDX-License-Identifier: LGPL-2.1-or-later
#include "problem/error_estimate.h"

namespace ciliaval {

const MechanicsResult& solution(const MechanicsResult& result, std::size_t i) {
  return i == 0 ? result : result.companions.at(i - 1);
}

void estimate_errors(MechanicsResult& result) {
  for (std::size_t s = 0; s < result.steps.size(); ++s) {
    MechanicsStep& step = result.steps[s];
    if (step.status != Status::converged) continue;
    const auto estimate = [&](double scale, const auto& of_step) {
      std::optional<double> error = error_estimate(result.error_parts, [&](std::size_t i) {
        const MechanicsStep& other = solution(result, i).steps.at(s);
        return other.status == Status::converged ? std::optional(of_step(other)) : std::nullopt;
      });
      if (error) *error += result.algebraic_error * scale;
      return error;
    };
    const auto tip = [](const MechanicsStep& of) {
      return of.deformation->centreline.at(of.deformation->centreline.length());
    };
    step.tip_uncertainty = estimate(step.deformation->centreline.length(),
                                    [&](const MechanicsStep& of) { return tip(of).position; });
    step.tip_angle_uncertainty =
        estimate(1, [&](const MechanicsStep& of) { return tip(of).theta(); });
    step.applied_force_uncertainty = estimate(
        std::abs(step.applied_force), [](const MechanicsStep& of) { return of.applied_force; });
  }
}

}  // namespace ciliaval
