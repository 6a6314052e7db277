// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fem/solid/discretisation/space.h"
#include "fem/solid/equilibrium/newton.h"
#include "fem/solid/loads/height_loads.h"
#include "problem/cilium.h"
#include "problem/load.h"
#include "problem/mechanics_model.h"

namespace ciliaval::fem::solid::equilibrium {

/// True if two loads have the same type, azimuth and contact height or loaded section.
bool same_place(const Load& a, const Load& b);

/// The solid in equilibrium with a load.
struct Equilibrium {
  Load load;
  discretisation::SolidState state;
  double applied_force = 0;  ///< on the whole body along e, N
};

/// A cheaper model's answer to a load: a state near the equilibrium, or the magnitude below the
/// load's with which it slipped off, or neither.
struct Guess {
  std::optional<discretisation::SolidState> state;
  double applied_force = 0;          ///< with the state, N
  std::optional<double> slip_off{};  ///< N, or m of a probe
  bool lost = false;                 ///< it failed: do not ask it again on this way
};
using InitialGuessSource = std::function<Guess(const Load&, const Progress&)>;

struct LoadPathOptions {
  NewtonOptions newton;
  unsigned int max_cutbacks = 5;  ///< cuts of a step to its quarter, in a row
  double kernel_width = 0.5e-3;   ///< half-width of the contact kernel, m
};

/// An equilibrium at the fraction t of the way from one load to another.
struct OnTheWay {
  double fraction = 0;
  Equilibrium equilibrium;
};

struct LoadPathOutcome {
  Status status = Status::failed;
  std::string message;
  std::optional<double> slip_off_force;         ///< N
  std::optional<double> slip_off_displacement;  ///< of a probe, m
  double slip_off_bracket = 0;  ///< width of the bracket above it, N, or m of a probe
  int iterations = 0;
  /// If a magnet pulls the cilium in: equilibria on the way to the fold, which is the last.
  std::vector<OnTheWay> way_to_fold{};
  double load_at_fold = 0;  ///< magnitude, N, N/m or a factor
};

/// The state of a load path.
struct LoadPathState {
  Equilibrium current;
  std::optional<Equilibrium> previous;
  /// The smallest load at this place with an equilibrium in which it is not applied in full.
  std::optional<Load> slipped;
};

/// Follows a load path from equilibrium to equilibrium. A load is tried from the initial guess,
/// then from a linear extrapolation of the last two equilibria at the same place (height, section).
/// A step that fails is cut to a quarter, and doubled after each success; a step that overshoots at
/// once (det F ≤ 0 after one iteration) may be cut 10 times more. At a new place and in another
/// environment it starts from the straight solid: on the way the cilium might slip off or buckle,
/// and a result must not depend on the loads before. The environment comes first, without the load.
class LoadPathSolver {
 public:
  /// Starts from the straight solid under no load of the path's type. The space, the quadrature,
  /// the cilium and the solver must outlive it.
  LoadPathSolver(const discretisation::SolidSpace& space,
                 const discretisation::ExtrudedQuadrature& quadrature, const Cilium& cilium,
                 Newton& newton, const Load& first, LoadPathOptions options,
                 InitialGuessSource initial_guess);

  /// Goes on to the next load. Unless that converges, the state stays at the last equilibrium under
  /// a load fully applied.
  LoadPathOutcome advance(const Load& target, const Progress& progress = {});

  const Equilibrium& current() const { return now_.current; }
  const LoadPathState& state() const { return now_; }
  void restore(LoadPathState state) { now_ = std::move(state); }

 private:
  struct Attempt;
  Attempt attempt(const Load& load, Guess guess, int& iterations, const Progress& progress);
  /// Newton's method from a state and, of a probe, an applied force near the equilibrium.
  Attempt attempt_from(Equilibrium start, int& iterations, const Progress& progress);
  Equilibrium predicted(const Load& load) const;
  /// The magnitude to try before the load's: the guessed slip-off or, once borne, a little more.
  std::optional<double> toward_slip_off(const Guess& guess, const Load& load) const;
  void accept(Attempt&& attempt);
  /// Follows the way from the current load to the target.
  LoadPathOutcome follow(const Load& target, const Progress& progress);
  /// First to the target's environment, then to its magnitude.
  LoadPathOutcome advance_in_legs(const Load& target, const Progress& progress);
  /// The outcome of a load that has failed, as pulled in if beside magnets there is a fold on the
  /// way to it; then the next load starts from the straight solid.
  LoadPathOutcome pulled_in(const Load& target, LoadPathOutcome failed);
  /// Narrows the bracket between the current load and the slipped one.
  LoadPathOutcome slip_off(const Progress& progress);
  void restart(const Load& load);
  /// advance() to a load of the same place in the present environment, or by an EnvironmentLoad.
  LoadPathOutcome advance_magnitude(const Load& target, const Progress& progress);
  /// The force of the load alone along e, of nodal forces that have the environment's, N.
  double force_of_load(const Load& load, const discretisation::Vector& external,
                       const discretisation::Vector& displacement) const;

  const discretisation::SolidSpace& space_;
  const discretisation::ExtrudedQuadrature& quadrature_;
  const Cilium& cilium_;
  Newton& newton_;
  LoadPathOptions options_;
  InitialGuessSource initial_guess_;
  LoadPathState now_;
};

}  // namespace ciliaval::fem::solid::equilibrium
