// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>

#include "problem/error.h"

namespace ciliaval::continuation {

/// A point on a branch of equilibria x(s), t(s): t the fraction of the way from one load to the
/// next, s a length along the branch.
struct BranchPoint {
  double fraction = 0;  ///< t
  double rate = 0;      ///< dt/ds
  double cosine = 1;    ///< of the angle between dx/ds here and at the accepted equilibrium before
};

/// True if each point lies on the other's branch at the distance s, by the trapezoidal rule in t
/// and by a small angle. Newton's method may leap to another branch.
inline bool is_same_branch(const BranchPoint& from, const BranchPoint& to, double s) {
  constexpr double tolerance = 0.02;
  constexpr double rounding = 1e-8;  // of t, where both rates are near 0
  constexpr double smallest_cosine = 0.95;
  const double gap = to.fraction - from.fraction - s * (from.rate + to.rate) / 2;
  return std::abs(gap) <=
             rounding + tolerance * s * std::max(std::abs(from.rate), std::abs(to.rate)) &&
         to.cosine >= smallest_cosine;
}

/// A branch of equilibria, followed by s in place of t (Riks 1979; Keller 1977).
struct Branch {
  /// The equilibrium at the distance s from the last accepted one; none if Newton's method fails.
  std::function<std::optional<BranchPoint>(double s)> find;
  /// Goes on from the equilibrium found last.
  std::function<void()> accept;
};

/// The point before t = 1 at which the branch turns back, dt/ds = 0: there is no equilibrium beyond
/// it on this branch, the tangent is singular, and its eigenvalue changes sign. The branch has
/// found it last. None if the branch leads to t = 1, or is lost on the way: no statement is made
/// then. `first` is the part of the way that is tried first.
inline std::optional<BranchPoint> turning_point(const Branch& branch, const BranchPoint& start,
                                                double first) {
  constexpr int most_trials = 200;
  constexpr int most_halvings = 20;
  constexpr int bits = 20;               // of s; those of t are twice as many
  constexpr double largest_rate = 1e-3;  // at the turning point, over that of the step before
  BranchPoint now = start;
  double step = first / start.rate;
  int halvings = 0;
  for (int trial = 0; trial < most_trials && halvings <= most_halvings; ++trial) {
    std::optional<BranchPoint> found = branch.find(step);
    if (found && !is_same_branch(now, *found, step)) found.reset();
    if (found && found->rate > 0) {
      if (found->fraction >= 1) return std::nullopt;
      branch.accept();
      now = *found;
      step *= 2;
      halvings = 0;
      continue;
    }
    if (found) {
      const auto rate = [&](double s) {
        const std::optional<BranchPoint> point = branch.find(s);
        if (!point || !is_same_branch(now, *point, s)) throw SolverError("the branch is lost");
        return point->rate;
      };
      try {
        std::uintmax_t iterations = 50;
        const auto [below, above] = boost::math::tools::toms748_solve(
            rate, 0.0, step, now.rate, found->rate, boost::math::tools::eps_tolerance<double>(bits),
            iterations);
        const std::optional<BranchPoint> fold = branch.find(below);
        // On a leap the rate changes its sign without passing through 0.
        if (fold && std::abs(fold->rate) < largest_rate * now.rate)
          return fold->fraction < 1 ? fold : std::nullopt;
      } catch (const SolverError&) {  // nearer to the last equilibrium then
      }
    }
    step /= 2;
    ++halvings;
  }
  return std::nullopt;
}

}  // namespace ciliaval::continuation
