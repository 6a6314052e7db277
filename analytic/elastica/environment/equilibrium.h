// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "analytic/elastica/planar.h"

/// The planar elastica under weight and a uniform field, beside a load or without one. Without
/// units: lengths in L, forces in B/L², B = max(EI). docs/theory/environment.md.
namespace ciliaval::analytic::elastica::environment {

/// A force in the plane of the rod.
struct PlanarForce {
  double along = 0;     ///< along e
  double vertical = 0;  ///< along z
};

/// The rod and all that acts on it but one point force.
struct Rod {
  std::vector<double> ends;             ///< S of the segments' ends: 0, …, 1
  std::vector<double> compliance;       ///< B/EI of each segment
  std::vector<PlanarForce> per_length;  ///< dead, of each segment
  std::vector<PlanarForce> at_ends;     ///< dead, at each of `ends`
  double per_height = 0;                ///< q, along e
  double tip_moment = 0;                ///< dead couple at the tip
};

/// The same with all its forces times t.
Rod scaled(const Rod& rod, double t);

/// A section at which the integration down to the base begins anew.
struct Node {
  double S = 0;
  double theta = 0;
  double moment = 0;
  double along = 0;  ///< H just below
};

/// The unknowns of an equilibrium: what multiple shooting from the tip down to the base has to
/// find.
struct Unknowns {
  double tip_angle = 0;       ///< θ at S = 1
  double force = 0;           ///< F, along e …
  double at = 1;              ///< … at S
  std::vector<Node> nodes{};  ///< from the tip down; solve() adds what is missing
};

/// a + t (b − a), with b's nodes.
Unknowns interpolate(const Unknowns& a, const Unknowns& b, double t);

/// Two equations beside θ(0) = 0.
struct Conditions {
  std::optional<double> height{};      ///< z at the point force; none: `at` is given
  std::optional<double> at{};          ///< its S
  std::optional<double> force{};       ///< F
  std::optional<double> deflection{};  ///< w there
};

/// A solved equilibrium.
struct Equilibrium {
  Unknowns unknowns;
  double deflection = 0;  ///< w at the point force
  double height = 0;      ///< z there
  /// Number of changes of sign of ∂θ/∂θ(1) on the way down, at a point force that stays on its
  /// section: the number of modes in which the energy decreases. The equilibrium is stable if it is
  /// 0.
  int unstable_modes = 0;
  std::array<double, 16> angles{};  ///< θ at S = 0, 1/16, …
  int iterations = 0;
  int attempts = 1;  ///< of Newton's method, on the path to the equilibrium
};

/// ∫ √(f (|H| + |V|)) dS of the straight rod: how often errors of a long pull grow e-fold from end
/// to end. The shortest bend takes about 1/that of the length.
double e_foldings(const Rod& rod, double force);

/// Newton's method from a guess; none if it does not converge. Between two nodes errors grow to
/// e⁴ times what they were, so that the digits suffice for a pull of any strength.
std::optional<Equilibrium> solve(const Rod& rod, const Conditions& conditions,
                                 const Unknowns& guess, double tolerance);

/// A rod and its conditions as a function of t.
using Path = std::function<std::pair<Rod, Conditions>(double t)>;

/// Attempts of Newton's method on a path, or on all paths of a load, after which it is given up.
inline constexpr int most_attempts = 1000;

/// The equilibrium at t = 1 of the branch that goes through the one at t = 0, which is near
/// `start`: by steps of t that are halved where Newton's method fails or ends at an equilibrium
/// that is less stable. Throws SolverError, with t, where the branch ends or no attempts are left.
Equilibrium follow(const Path& path, const Unknowns& start, double tolerance,
                   int attempts = most_attempts);

/// The shape of an equilibrium.
PlanarShape shape(const Rod& rod, const Equilibrium& equilibrium, double tolerance);

/// The smallest factor t ≤ `most` on all forces at which the straight rod, which must be in
/// equilibrium, ceases to be stable; none if it is not reached.
std::optional<double> critical_scale(const Rod& rod, double most);

}  // namespace ciliaval::analytic::elastica::environment
