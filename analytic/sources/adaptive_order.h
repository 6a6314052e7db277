// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <boost/container/small_vector.hpp>
#include <cstddef>
#include <string_view>

#include "analytic/sources/field_points.h"
#include "problem/error.h"
#include "problem/lagrange.h"

namespace ciliaval::analytic::sources {

/// The n-point Gauss–Legendre rule on [0, 1], computed once for each n by each thread.
const QuadratureRule& unit_gauss_legendre(std::size_t n);

/// The orders tried one after the other by `integrate_adaptively`.
inline constexpr std::size_t quadrature_orders[] = {4, 6, 8, 12, 16, 24, 36, 54};

/// The demand on `integrate_adaptively`.
struct AdaptiveOrder {
  double tolerance;                      ///< relative to |B|
  std::size_t highest_order;             ///< one of `quadrature_orders`
  std::string_view integral;             ///< its name, for the message
  const Vector3& x;                      ///< the field point, for the message
  Vector3 other_part = Vector3::Zero();  ///< B that is already known, T
};

/// Throws the SolverError of an integral that cannot be brought to its tolerance.
[[noreturn]] void throw_tolerance_missed(const AdaptiveOrder& asked, double reached);

/// True if the estimate of the value's error, rounding included, is within the tolerance.
inline bool is_within(const FieldValue& value, double tolerance) {
  return value.uncertainty.norm() <= tolerance * value.B.norm();
}

/// Throws it if the estimate of the value's error, rounding included, is above the tolerance.
inline void require_tolerance(const FieldValue& value, const AdaptiveOrder& asked) {
  if (!is_within(value, asked.tolerance))
    throw_tolerance_missed(asked, value.uncertainty.norm() / value.B.norm());
}

/// Starts every part with the two lowest orders.
struct LowestLevel {
  std::size_t operator()(const auto& /*part*/) const { return 1; }
};

/// A sum of integrals, as far as the orders brought it.
struct AdaptiveSum {
  FieldValue value;  ///< its uncertainty: the parts' last changes and the rounding
  double reached;    ///< the changes alone over |B|: what a higher order could mend
};

/// Throws the SolverError if the changes are above the tolerance.
inline void require_reached(const AdaptiveSum& sum, const AdaptiveOrder& asked) {
  if (!(sum.reached <= asked.tolerance)) throw_tolerance_missed(asked, sum.reached);
}

/// Adaptive Gauss order: `other_part` plus the sum of the integrals over `parts`, where
/// `contribution(part, n)` is the integral over one part by a rule of order n, its uncertainty the
/// rounding error of the rule's sum. The parts' orders are raised one by one until the sum of the
/// differences between each part's last two orders is below tolerance·|B|, or no order is left.
/// That sum is the error of the last orders but one. A part starts with the orders of the levels
/// `first_level(part)` − 1 and `first_level(part)`.
template <class Parts, class Contribution, class FirstLevel = LowestLevel>
AdaptiveSum sum_adaptively(const Parts& parts, Contribution contribution,
                           const AdaptiveOrder& asked, FirstLevel first_level = {}) {
  struct State {
    std::size_t level = 0;
    FieldValue value;
    Vector3 difference = Vector3::Zero();
  };
  boost::container::small_vector<State, 16> states(parts.size());
  const auto raise = [&](std::size_t i, const Vector3& previous) {
    states[i].value = contribution(parts[i], quadrature_orders[states[i].level]);
    states[i].difference = (states[i].value.B - previous).cwiseAbs();
  };
  for (std::size_t i = 0; i < parts.size(); ++i) {
    states[i].level = first_level(parts[i]);
    raise(i, contribution(parts[i], quadrature_orders[states[i].level - 1]).B);
  }
  while (true) {
    FieldValue sum{asked.other_part, Vector3::Zero()};
    Vector3 changes = Vector3::Zero();
    for (const State& state : states) {
      sum += state.value;
      changes += state.difference;
    }
    const double size = sum.B.norm();
    const double allowed = asked.tolerance * size;
    bool raised = false;
    if (!(changes.norm() <= allowed)) {
      const double share = allowed / (2 * static_cast<double>(parts.size()));
      for (std::size_t i = 0; i < parts.size(); ++i) {
        State& state = states[i];
        if (quadrature_orders[state.level] >= asked.highest_order) continue;
        if (!(state.difference.norm() > share)) continue;
        ++state.level;
        raise(i, Vector3(state.value.B));
        raised = true;
      }
    }
    if (raised) continue;
    sum.uncertainty += changes;
    return {sum, size > 0 ? changes.norm() / size : changes.norm()};
  }
}

/// sum_adaptively(), of which the changes must be within the tolerance. Throws SolverError if they
/// are not at the highest order.
template <class Parts, class Contribution, class FirstLevel = LowestLevel>
FieldValue integrate_adaptively(const Parts& parts, Contribution contribution,
                                const AdaptiveOrder& asked, FirstLevel first_level = {}) {
  const AdaptiveSum sum = sum_adaptively(parts, contribution, asked, first_level);
  require_reached(sum, asked);
  return sum.value;
}

}  // namespace ciliaval::analytic::sources
