// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cmath>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>

#include "problem/mechanics_model.h"

namespace ciliaval {

inline double magnitude_of(double value) {
  return std::abs(value);
}
inline double magnitude_of(const Vector3& value) {
  return value.norm();
}

/// Estimate of the discretisation error of a quantity Q, in Q's unit: Σ factor |Q(finer) −
/// Q(coarser)| over the parts. `quantity(i)` is the optional number or vector that follows from
/// solution i: 0 the result, i its companion i − 1. Empty if there are no parts or a solution lacks
/// Q.
template <class Quantity>
std::optional<double> error_estimate(std::span<const ErrorPart> parts, const Quantity& quantity) {
  if (parts.empty()) return std::nullopt;
  double sum = 0;
  for (const ErrorPart& part : parts) {
    const auto finer = quantity(part.finer);
    const auto coarser = quantity(part.coarser);
    if (!finer || !coarser) return std::nullopt;
    sum += part.factor * magnitude_of(*finer - *coarser);
  }
  return sum;
}

/// Solution i of a result: 0 itself, i its companion i − 1.
const MechanicsResult& solution(const MechanicsResult& result, std::size_t i);

/// The companion that `solve` makes. An error that it throws (problem/error.h) costs the error
/// estimate alone: then the companion has a failed step for each of the result's, with the reason.
MechanicsResult companion_of(const MechanicsResult& result,
                             const std::function<MechanicsResult()>& solve);

/// The remark on a step whose companion has failed for this reason.
std::string error_is_not_known(const std::string& reason);

/// Sets the uncertainties of the converged steps from the companions, if there are any, and the
/// algebraic error. Where a companion has failed, the step says why its error is not known.
void estimate_errors(MechanicsResult& result);

}  // namespace ciliaval
