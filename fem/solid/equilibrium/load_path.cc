// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/equilibrium/load_path.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "fem/solid/equilibrium/fold.h"
#include "fem/solid/loads/dead_forces.h"
#include "fem/solid/loads/environment_forces.h"
#include "fem/solid/loads/probe.h"
#include "fem/solid/loads/tip_couple.h"
#include "problem/continuation/slip_off.h"

namespace ciliaval::fem::solid::equilibrium {
using namespace discretisation;
using namespace loads;
namespace {

/// A step that failed is shortened to this part.
constexpr double cut_factor = 0.25;

/// Cuts of steps that turn the material inside out in one iteration. They do not count as
/// max_cutbacks: each takes a single factorisation.
constexpr unsigned int max_overshoots = 10;

constexpr double slip_off_bracket = 0.01;  ///< relative width that ends the search for the slip-off

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

std::string history(const std::vector<double>& residuals) {
  std::string text;
  for (const double residual : residuals) text += (text.empty() ? "" : ", ") + number(residual);
  return text;
}

std::string with_unit(const Load& load) {
  return number(magnitude(load)) + " " + std::string(magnitude_unit(load));
}

}  // namespace

bool same_place(const Load& a, const Load& b) {
  if (type(a) != type(b) || azimuth(a) != azimuth(b)) return false;
  if (contact_height(a)) return contact_height(a) == contact_height(b);
  if (const auto section = a.as<SectionLoad>())
    return section->arclength == b.as<SectionLoad>()->arclength;
  return true;
}

struct LoadPathSolver::Attempt {
  bool converged = false;
  bool applied = false;  ///< the whole force was applied
  bool overshot = false;
  std::string trouble;
  Equilibrium equilibrium;
};

LoadPathSolver::LoadPathSolver(const SolidSpace& space, const ExtrudedQuadrature& quadrature,
                               const Cilium& cilium, Newton& newton, const Load& first,
                               LoadPathOptions options, InitialGuessSource initial_guess)
    : space_(space),
      quadrature_(quadrature),
      cilium_(cilium),
      newton_(newton),
      options_(options),
      initial_guess_(std::move(initial_guess)) {
  restart(first);
}

void LoadPathSolver::restart(const Load& load) {
  now_ = {{nothing_of(load), space_.undeformed(), 0}, {}, {}};
}

Equilibrium LoadPathSolver::predicted(const Load& load) const {
  Equilibrium result = now_.current;
  result.load = load;
  if (!now_.previous) return result;
  const Equilibrium& current = now_.current;
  const Equilibrium& previous = *now_.previous;
  const double last = magnitude(current.load) - magnitude(previous.load);
  if (last == 0) return result;
  SolidState& state = result.state;
  const double factor = std::clamp((magnitude(load) - magnitude(current.load)) / last, -1.0, 1.5);
  state.displacement.add(factor, current.state.displacement, -factor, previous.state.displacement);
  for (std::size_t e = 0; e < state.pressure.size(); ++e)
    state.pressure[e] += factor * (current.state.pressure[e] - previous.state.pressure[e]);
  result.applied_force += factor * (current.applied_force - previous.applied_force);
  return result;
}

LoadPathSolver::Attempt LoadPathSolver::attempt(const Load& load, Guess guess, int& iterations,
                                                const Progress& progress) {
  if (guess.state) {
    Attempt attempt =
        attempt_from({load, std::move(*guess.state), guess.applied_force}, iterations, progress);
    if (attempt.converged) return attempt;
  }
  return attempt_from(predicted(load), iterations, progress);
}

LoadPathSolver::Attempt LoadPathSolver::attempt_from(Equilibrium start, int& iterations,
                                                     const Progress& progress) {
  Attempt attempt;
  attempt.equilibrium = std::move(start);
  const Load& load = attempt.equilibrium.load;
  SolidState& state = attempt.equilibrium.state;
  const auto report = [&](int iteration, double residual) {
    if (progress)
      progress("load " + number(magnitude(load)) + ", iteration " + std::to_string(iteration) +
               ", residual " + number(residual));
  };
  NewtonResult result;
  double contact_force = 0;
  const auto probe = load.as<ProbeLoad>();
  const auto couple = load.as<MomentLoad>();
  if (probe || couple) {
    UnknownForce force =
        probe ? probe_force(space_, quadrature_, *probe, options_.kernel_width,
                            attempt.equilibrium.applied_force)
              : TipCouple(space_, quadrature_, *couple).with_unknown_angle(state.displacement);
    if (const auto around = acting_environment(load); !surroundings::is_empty(around))
      force.others = environment_forces(space_, cilium_, around);
    result = newton_.solve(force, state, options_.newton, report);
    if (probe) contact_force = force.amplitude;
  } else {
    result =
        newton_.solve(external_forces(space_, quadrature_, cilium_, load, options_.kernel_width),
                      state, options_.newton, report);
    if (const auto contact = load.as<ContactLoad>()) contact_force = contact->force;
  }
  iterations += result.iterations();
  attempt.overshot = result.overshot;
  attempt.converged = result.converged;
  if (!result.converged) {
    attempt.trouble = result.reason + " (relative residuals " + history(result.residuals) + ")";
    return attempt;
  }
  attempt.equilibrium.applied_force = force_of_load(load, result.external, state.displacement);
  attempt.applied = contact_force == 0 ||
                    attempt.equilibrium.applied_force >=
                        contact_force - continuation::force_shortfall * std::abs(contact_force);
  return attempt;
}

double LoadPathSolver::force_of_load(const Load& load, const Vector& external,
                                     const Vector& displacement) const {
  Vector3 force = resultant(space_, external);
  const surroundings::Environment environment = acting_environment(load);
  if (!surroundings::is_empty(environment))
    force -= weight_of(space_, cilium_, environment) +
             force_of_magnets(space_, cilium_, environment, displacement);
  return whole_force(quadrature_, force).dot(direction(load));
}

std::optional<double> LoadPathSolver::toward_slip_off(const Guess& guess, const Load& load) const {
  if (!guess.slip_off) return std::nullopt;
  const double now = magnitude(now_.current.load);
  const double borne = *guess.slip_off;
  const double next = now < borne ? borne : borne * (1 + slip_off_bracket);
  if (now < next && next < magnitude(load)) return next;
  return std::nullopt;
}

void LoadPathSolver::accept(Attempt&& attempt) {
  now_.previous = std::move(now_.current);
  now_.current = std::move(attempt.equilibrium);
}

LoadPathOutcome LoadPathSolver::advance(const Load& target, const Progress& progress) {
  LoadPathOutcome outcome = advance_in_legs(target, progress);
  return outcome.status == Status::failed ? pulled_in(target, std::move(outcome)) : outcome;
}

LoadPathOutcome LoadPathSolver::advance_in_legs(const Load& target, const Progress& progress) {
  const auto environment = [this] { return now_.current.load.environment(); };
  if (!same_place(now_.current.load, target) || environment() != target.environment())
    restart(target);
  if (environment() == target.environment() || target.is<EnvironmentLoad>())
    return advance_magnitude(target, progress);
  const LoadPathOutcome first =
      advance_magnitude(with_environment(now_.current.load, target.environment()), progress);
  if (first.status != Status::converged) return first;
  LoadPathOutcome outcome = advance_magnitude(target, progress);
  outcome.iterations += first.iterations;
  return outcome;
}

LoadPathOutcome LoadPathSolver::advance_magnitude(const Load& target, const Progress& progress) {
  if (now_.current.load == target) return {Status::converged, {}, {}, {}, 0};
  if (now_.slipped && magnitude(target) >= magnitude(*now_.slipped)) return slip_off(progress);
  return follow(target, progress);
}

LoadPathOutcome LoadPathSolver::follow(const Load& target, const Progress& progress) {
  const Load start = now_.current.load;
  double reached = 0;     // part of the way
  double step = 1;        // the next one, in parts of the way
  unsigned int cuts = 0;  // in a row
  unsigned int overshoots = 0;
  bool unguided = false;  // the initial guess is lost
  int iterations = 0;
  while (reached < 1) {
    double aim = std::min(1.0, reached + step);
    Load load = aim == 1 ? target : interpolate(start, target, aim);
    Guess guess = unguided ? Guess{} : initial_guess_(load, progress);
    unguided = unguided || guess.lost;
    if (const auto nearer = toward_slip_off(guess, load)) {
      aim = (*nearer - magnitude(start)) / (magnitude(target) - magnitude(start));
      load = with_magnitude(load, *nearer);
      guess = initial_guess_(load, progress);
    }
    Attempt result = attempt(load, std::move(guess), iterations, progress);
    if (result.converged && !result.applied && magnitude(load) <= magnitude(now_.current.load)) {
      result.converged = false;
      result.trouble = "Newton's method went to a cilium that has slipped off under a smaller load";
    }
    if (result.converged && !result.applied) {
      now_.slipped = load;
      LoadPathOutcome outcome = slip_off(progress);
      outcome.iterations += iterations;
      return outcome;
    }
    if (result.converged) {
      accept(std::move(result));
      reached = aim;
      step *= 2;
      cuts = 0;
      continue;
    }
    const bool may_overshoot = result.overshot && overshoots < max_overshoots;
    ++(may_overshoot ? overshoots : cuts);
    step = (aim - reached) * cut_factor;
    // Where steps fail now and then, the cuts are never many in a row.
    if (cuts > options_.max_cutbacks ||
        step < std::pow(cut_factor, options_.max_cutbacks + overshoots)) {
      const double part = (aim - reached) * 100;
      return {Status::failed,
              "no equilibrium found at load " + with_unit(load) + " in a step of " + number(part) +
                  " % of the way: " + result.trouble + "; the last load that converged is " +
                  with_unit(now_.current.load),
              {},
              {},
              0,
              iterations};
    }
  }
  return {Status::converged, {}, {}, {}, 0, iterations};
}

LoadPathOutcome LoadPathSolver::pulled_in(const Load& target, LoadPathOutcome failed) {
  if (target.environment().magnets.empty()) return failed;
  // A contact begins at the cilium that the environment alone bends.
  const Load free = contact_height(target) ? with_environment(EnvironmentLoad{1, azimuth(target)},
                                                              target.environment())
                                           : target;
  failed.way_to_fold = FoldSearch(space_, quadrature_, cilium_, newton_, options_).find(free);
  if (failed.way_to_fold.empty()) return failed;
  failed.status = Status::pulled_in;
  failed.load_at_fold =
      contact_height(target) ? 0 : failed.way_to_fold.back().fraction * magnitude(target);
  restart(target);
  return failed;
}

LoadPathOutcome LoadPathSolver::slip_off(const Progress& progress) {
  std::string trouble;
  int iterations = 0;
  double fraction = 0.5;
  unsigned int cuts = 0;
  while (magnitude(*now_.slipped) - magnitude(now_.current.load) >
         slip_off_bracket * magnitude(*now_.slipped)) {
    const Load load = interpolate(now_.current.load, *now_.slipped, fraction);
    Attempt result = attempt(load, initial_guess_(load, progress), iterations, progress);
    if (result.converged) {
      if (result.applied) {
        accept(std::move(result));
      } else {
        now_.slipped = load;
      }
      fraction = 0.5;
      cuts = 0;
      continue;
    }
    // A load without a solution tells nothing about the slip-off: try nearer to the last one borne.
    if (++cuts > options_.max_cutbacks) {
      trouble = "; the bracket stays this wide because no equilibrium was found at " +
                with_unit(load) + ": " + result.trouble;
      break;
    }
    fraction *= cut_factor;
  }
  const Load& borne = now_.current.load;
  const bool probe = borne.is<ProbeLoad>();
  LoadPathOutcome outcome;
  outcome.status = Status::slipped_off;
  outcome.slip_off_force = probe ? now_.current.applied_force : magnitude(borne);
  if (probe) outcome.slip_off_displacement = magnitude(borne);
  outcome.slip_off_bracket = magnitude(*now_.slipped) - magnitude(borne);
  outcome.iterations = iterations;
  outcome.message =
      (probe ? "the cilium slips off: with a displacement of "
             : "the cilium slips off: a contact force of ") +
      with_unit(borne) +
      (probe ? " the contact force was applied in full, with " : " was borne in full, ") +
      with_unit(*now_.slipped) + (probe ? " it was not" : " was not") +
      " (a solid begins to slip off where the lowest point of its tip face comes "
      "down to the upper end of the contact kernel)" +
      trouble;
  return outcome;
}

}  // namespace ciliaval::fem::solid::equilibrium
