// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "fem/solid/fibres.h"
#include "fem/solid/equilibrium/newton.h"
#include "fem/solid/discretisation/space.h"
#include "problem/load.h"
#include "problem/mechanics_model.h"

namespace ciliaval::fem {

/// The load as far as it is spread over the solid (all but a section load); e in any case.
SpreadLoad spread_load(const Load& load, double area, double kernel_width);

/// The load's nodal forces as a function of the displacement (docs/solid.md).
ExternalForces external_forces(const SolidSpace& space, const Fibres& fibres, const Load& load,
                               double kernel_width);

/// The contact force of a probe, N; any other load as it is.
Load acting(const Load& load, double applied_force);

/// Whether two loads differ in nothing but their magnitude.
bool same_place(const Load& a, const Load& b);

/// The solid in equilibrium with a load.
struct Equilibrium {
  Load load;
  SolidState state;
  double applied_force = 0;  ///< on the whole body along e, N
};

/// What a cheaper model knows about a load: a state near the equilibrium, or the magnitude below
/// the load's with which it slipped off. Empty if it knows neither.
struct Guess {
  std::optional<SolidState> state;
  double applied_force = 0;          ///< with the state, N
  std::optional<double> slip_off{};  ///< N, or m of a probe
  bool lost = false;  ///< it failed, and costs more than it gives on the rest of the way
};
using FirstGuess = std::function<Guess(const Load&, const Progress&)>;
/// The solver, made when it is first asked for.
using NewtonSource = std::function<Newton&()>;

struct LoadPathOptions {
  NewtonOptions newton;
  unsigned int max_cutbacks = 5;   ///< cuts of a step to its quarter, in a row
  double kernel_width = 0.5e-3;    ///< half-width of the contact kernel, m
  double force_shortfall = 1e-6;   ///< relative; a contact force that falls short by more slips off
  double slip_off_bracket = 0.01;  ///< relative width at which the search for the slip-off ends
};

struct LoadPathOutcome {
  Status status = Status::failed;
  std::string message;
  std::optional<double> slip_off_force;         ///< N
  std::optional<double> slip_off_displacement;  ///< of a probe, m
  int iterations = 0;
};

/// The way from one load to the next, as far as it is gone.
struct Ramp {
  Load start;
  Load target;
  double reached = 0;           ///< part of the way
  double step = 1;              ///< the next step, in parts of the way
  unsigned int cuts = 0;        ///< in a row
  unsigned int overshoots = 0;  ///< cuts of steps that turned the material inside out at once
  int iterations = 0;           ///< of Newton's method, so far
  bool unguided = false;        ///< the first guess is lost
};

/// All that the following of a load path goes on from.
struct LoadPathState {
  Equilibrium current;
  std::optional<Equilibrium> previous;
  /// The smallest load at this place with an equilibrium in which it is not applied in full.
  std::optional<Load> slipped;
  std::optional<Ramp> ramp;  ///< while a load is on its way
};

/// Follows a load path from equilibrium to equilibrium. A load is tried from the first guess, where
/// there is one; else, or if Newton's method fails, a load at the place (height, section) of the
/// last one is reached from it, at once from a linear extrapolation of the last two equilibria or
/// in steps that are cut to a quarter where they fail and doubled after each success;
/// steps that overshoot at once (det F ≤ 0 after one iteration) may be cut 10 times more. At a new
/// place it starts from the straight solid: on the way from one place to another the cilium might
/// slip off under loads that nobody asked for.
class LoadPathSolver {
 public:
  /// Starts from the straight solid under no load of the path's type. The space and fibres must
  /// outlive it.
  LoadPathSolver(const SolidSpace& space, const Fibres& fibres, NewtonSource newton,
                 const Load& first, LoadPathOptions options, FirstGuess first_guess = {});

  /// Goes on to the next load. Unless that converges, the state stays at the last equilibrium under
  /// a load fully applied. Calls `on_equilibrium` after each one on the way: from the state()
  /// that is there at that time, the same advance() finds the same bits.
  LoadPathOutcome advance(const Load& target, const Progress& progress = {},
                          const std::function<void()>& on_equilibrium = {});

  /// The equilibrium that Newton's method finds from this guess alone; none where it finds none, or
  /// one in which the load is not applied in full. state() stays.
  std::optional<Equilibrium> solve(const Load& load, Guess guess, int& iterations,
                                   const Progress& progress);
  /// Goes on from an equilibrium as if advance() had found it; it replaces one under an equal load.
  void go_to(Equilibrium equilibrium);
  /// Begins the way to the next load, which advance() goes.
  void set_out(const Load& target);

  const Equilibrium& current() const { return now_.current; }
  const LoadPathState& state() const { return now_; }
  void restore(LoadPathState state) { now_ = std::move(state); }

 private:
  struct Attempt;
  Attempt attempt(const Load& load, Guess guess, int& iterations, const Progress& progress);
  /// Newton's method from a state and, of a probe, an applied force near the equilibrium.
  Attempt attempt_from(Equilibrium start, int& iterations, const Progress& progress);
  Equilibrium predicted(const Load& load) const;
  Guess guess_for(const Load& load, const Progress& progress) const;
  /// The magnitude to try before the load's: the one guessed for the slip-off or, when that is
  /// borne, a little more.
  std::optional<double> toward_slip_off(const Guess& guess, const Load& load) const;
  void accept(Attempt&& attempt);
  /// Makes the ramp's step shorter. False if it has been cut too often.
  bool cut(Ramp& ramp, bool overshot) const;
  LoadPathOutcome follow_ramp(const Progress& progress,
                              const std::function<void()>& on_equilibrium);
  /// Narrows the bracket between the current load and the one that slipped.
  LoadPathOutcome slip_off(const Progress& progress, const std::function<void()>& on_equilibrium);
  void restart(const Load& load);

  const SolidSpace& space_;
  const Fibres& fibres_;
  NewtonSource newton_;
  LoadPathOptions options_;
  FirstGuess first_guess_;
  LoadPathState now_;
};

}  // namespace ciliaval::fem
