// SPDX-License-Identifier: LGPL-2.1-or-later
#include "problem/error_estimate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "problem/error.h"

namespace ciliaval {

const MechanicsResult& solution(const MechanicsResult& result, std::size_t i) {
  return i == 0 ? result : result.companions.at(i - 1);
}

MechanicsResult companion_of(const MechanicsResult& result,
                             const std::function<MechanicsResult()>& solve) {
  try {
    return solve();
  } catch (const RankFailure&) {
    throw;
  } catch (const Error& error) {
    MechanicsResult failed{.undeformed = result.undeformed, .steps = {}};
    for (const MechanicsStep& step : result.steps) {
      MechanicsStep& of_companion = failed.steps.emplace_back();
      of_companion.load = step.load;
      of_companion.message = error.what();
    }
    return failed;
  }
}

namespace {

/// Adds the reason why the error of a converged step is not known: the message of a companion that
/// has not converged there.
void remark_on_companions(MechanicsResult& result, std::size_t s) {
  for (const MechanicsResult& companion : result.companions) {
    const MechanicsStep& other = companion.steps.at(s);
    if (other.status == Status::converged || other.message.empty()) continue;
    std::string& message = result.steps[s].message;
    message += (message.empty() ? "" : "; ") + error_is_not_known(other.message);
    return;
  }
}

}  // namespace

std::string error_is_not_known(const std::string& reason) {
  return "the numerical error is not known: the solution that it is estimated from failed: " +
         reason;
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
    remark_on_companions(result, s);
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
