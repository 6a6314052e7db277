// SPDX-License-Identifier: LGPL-2.1-or-later
#include "problem/error_estimate.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ciliaval {

const MechanicsResult& solution(const MechanicsResult& result, std::size_t i) {
  return i == 0 ? result : result.companions.at(i - 1);
}

void estimate_errors(MechanicsResult& result) {
  for (std::size_t s = 0; s < result.steps.size(); ++s) {
    MechanicsStep& step = result.steps[s];
    if (const std::optional<double> limit = slip_off_limit(step);
        limit && !step.slip_off_uncertainty) {
      step.slip_off_uncertainty = error_estimate(result.error_parts, [&](std::size_t i) {
        return slip_off_limit(solution(result, i).steps.at(s));
      });
      if (step.slip_off_uncertainty) *step.slip_off_uncertainty += result.algebraic_error * *limit;
    }
    if (step.status != Status::converged) continue;
    const auto estimate = [&](const auto& of_step, double algebraic) {
      std::optional<double> error = error_estimate(result.error_parts, [&](std::size_t i) {
        const MechanicsStep& other = solution(result, i).steps.at(s);
        return other.status == Status::converged ? std::optional(of_step(other)) : std::nullopt;
      });
      if (error) *error += algebraic;
      return error;
    };
    const auto tip = [](const MechanicsStep& of) {
      return of.deformation->centreline.at(of.deformation->centreline.length());
    };
    const double algebraic = result.algebraic_error;
    step.tip_uncertainty = estimate([&](const MechanicsStep& of) { return tip(of).position; },
                                    algebraic * step.deformation->centreline.length());
    step.tip_angle_uncertainty =
        estimate([&](const MechanicsStep& of) { return tip(of).theta(); }, algebraic);
    // A prescribed force is the sum of the nodal loads: rounding errors, the quadrature's included
    // (docs/evidence/solid.md).
    const bool is_prescribed =
        !step.load.is<ProbeLoad>() && !step.load.is<FlowLoad>() && !step.load.is<SweepLoad>();
    const double rounding =
        5 * std::numeric_limits<double>::epsilon() * std::sqrt(static_cast<double>(step.unknowns));
    step.applied_force_uncertainty = estimate(
        [](const MechanicsStep& of) { return of.applied_force; },
        (is_prescribed ? std::min(algebraic, rounding) : algebraic) * std::abs(step.applied_force));
  }
}

}  // namespace ciliaval
