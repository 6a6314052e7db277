// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

namespace ciliaval::compare::study::optimum {

/// A point of the unit box [0, 1]ⁿ as a search sees it.
struct Trial {
  double gain = 0;                  ///< what is maximised
  std::vector<double> constraints;  ///< g: kept where g ≤ 0
  bool is_defined = true;           ///< false: `gain` is a stand-in for what is not there
  /// The largest g, or 0.
  double violation() const;
};
using TrialFunction = std::function<Trial(const std::vector<double>& u)>;

/// A constraint may be missed by so much: both searches approach it from outside.
inline constexpr double feasibility = 1e-8;
/// A point whose residual is below is stationary: from one side of the box to the other the gain
/// would change by less.
inline constexpr double stationary = 1e-3;

/// A point at which a local search ended, and what the conditions of Karush, Kuhn and Tucker say of
/// it: ∇gain = Σ λ_j ∇g_j + μ with λ ≥ 0 of the constraints that are reached, and μ_i ≤ 0 where
/// u_i = 0, ≥ 0 where u_i = 1, and 0 between.
struct LocalOptimum {
  std::vector<double> u;
  Trial trial;
  std::vector<double>
      multipliers;  ///< λ: d gain/d g_j of a constraint that is relaxed; 0 of others
  std::vector<double> bound_multipliers;  ///< |μ|: d gain of a bound that is moved outwards
  std::vector<int> at_bound;              ///< −1: u_i = 0; 1: u_i = 1; 0: between
  double residual = 0;                    ///< the largest component of what is left, per unit of u
  std::size_t starts = 1;                 ///< local searches that ended here
};

struct SearchOptions {
  unsigned int global_evaluations = 2000;  ///< of ISRES; 0: none
  unsigned int starts = 10;                ///< further local searches, from a Sobol' sequence
};

struct SearchResult {
  std::vector<LocalOptimum> optima;  ///< feasible and stationary, the best first; if none is
                                     ///< stationary the best point found
  std::size_t local_searches = 0;
  std::size_t not_stationary = 0;  ///< local searches that ended elsewhere, and their best point
  std::size_t infeasible = 0;      ///< … without a point that keeps the constraints
  std::vector<double> nearest;     ///< the point that misses them least
};

/// The largest gain in the unit box under the constraints, with NLopt: the evolution strategy ISRES
/// (Runarsson and Yao, IEEE Trans. SMC C 35, 233, 2005) over the whole box, then from its end, from
/// `start` and from further points a local search each: COBYLA (Powell 1994), which needs no
/// derivatives and bears points without a gain, then SLSQP (Kraft 1994) with differences of second
/// order, which converges to many digits. Every random number has a fixed seed: the same function
/// gives the same sequence of points. What the function throws comes through.
SearchResult maximise(const TrialFunction& function, const std::vector<double>& start,
                      const SearchOptions& options);

}  // namespace ciliaval::compare::study::optimum
