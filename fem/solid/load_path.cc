// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/load_path.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>
#include <variant>

#include "fem/solid/forces.h"
#include "fem/solid/probe.h"

namespace ciliaval::fem {
namespace {

/// Cutbacks of a load path's step that turn the material inside out in one iteration: the load is
/// too large by far, each takes a single factorisation, and they do not count as max_cutbacks.
constexpr unsigned int max_overshoots = 20;

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

/// "0.004 N"
std::string with_unit(const Load& load) {
  return number(magnitude(load)) + " " + std::string(magnitude_unit(load));
}

/// The same load but for its magnitude?
bool same_place(const Load& a, const Load& b) {
  if (type(a) != type(b) || azimuth(a) != azimuth(b)) return false;
  if (contact_height(a)) return contact_height(a) == contact_height(b);
  if (const auto* section = std::get_if<SectionLoad>(&a))
    return section->arclength == std::get<SectionLoad>(b).arclength;
  return true;
}

}  // namespace

Load acting(const Load& load, double applied_force) {
  if (const auto* probe = std::get_if<ProbeLoad>(&load))
    return ContactLoad{applied_force, probe->height, probe->azimuth};
  return load;
}

SpreadLoad spread_load(const Load& load, double area, double kernel_width) {
  SpreadLoad result;
  result.direction = direction(load);
  if (const auto* contact = std::get_if<ContactLoad>(&load))
    result.per_height = contact_density(contact->force, area, contact->height, kernel_width);
  if (const auto* flow = std::get_if<FlowLoad>(&load))
    result.per_height = flow_density(flow->force_per_height, area);
  if (const auto* dead = std::get_if<DeadLoad>(&load))
    result.per_volume = dead->force_per_length / area;
  return result;
}

ExternalForces external_forces(const SolidSpace& space, const Fibres& fibres, const Load& load,
                               double kernel_width) {
  const SpreadLoad spread = spread_load(load, fibres.area(), kernel_width);
  if (const auto* section = std::get_if<SectionLoad>(&load))
    return dead_forces(
        section_force(space, fibres, section->force, section->arclength, spread.direction));
  if (!spread.per_height) {
    const auto b = [&spread](const Vector3&) -> Vector3 {
      return spread.per_volume * spread.direction;
    };
    return dead_forces(body_force(space, b));
  }
  return [&space, &fibres, spread](const dealii::Vector<double>& displacement,
                                   dealii::Vector<double>& forces,
                                   const dealii::AffineConstraints<double>& constraints,
                                   dealii::SparseMatrix<double>* matrix) {
    add_fibre_forces(space, fibres, *spread.per_height, spread.direction, displacement, forces,
                     constraints, matrix);
  };
}

struct LoadPathSolver::Attempt {
  bool converged = false;
  bool applied = false;  ///< the whole force was applied
  bool overshot = false;
  std::string trouble;
  Equilibrium equilibrium;
};

LoadPathSolver::LoadPathSolver(const SolidSpace& space, const Fibres& fibres, Newton& newton,
                               const Load& first, LoadPathOptions options, FirstGuess first_guess)
    : space_(space),
      fibres_(fibres),
      newton_(newton),
      options_(options),
      first_guess_(std::move(first_guess)),
      current_{with_magnitude(first, 0), space.undeformed(), 0} {}

void LoadPathSolver::restart(const Load& load) {
  current_ = {with_magnitude(load, 0), space_.undeformed(), 0};
  previous_.reset();
  slipped_.reset();
}

Equilibrium LoadPathSolver::predicted(const Load& load) const {
  Equilibrium result = current_;
  result.load = load;
  if (!previous_) return result;
  const double last = magnitude(current_.load) - magnitude(previous_->load);
  if (last == 0) return result;
  SolidState& state = result.state;
  const double factor = std::clamp((magnitude(load) - magnitude(current_.load)) / last, -1.0, 1.5);
  state.displacement.add(factor, current_.state.displacement, -factor,
                         previous_->state.displacement);
  for (std::size_t e = 0; e < state.pressure.size(); ++e)
    state.pressure[e] += factor * (current_.state.pressure[e] - previous_->state.pressure[e]);
  result.applied_force += factor * (current_.applied_force - previous_->applied_force);
  return result;
}

LoadPathSolver::Attempt LoadPathSolver::attempt(const Load& load, Guess guess,
                                                LoadPathOutcome& outcome,
                                                const Progress& progress) {
  if (guess.state) {
    Attempt attempt =
        attempt_from({load, std::move(*guess.state), guess.applied_force}, outcome, progress);
    if (attempt.converged) return attempt;
  }
  return attempt_from(predicted(load), outcome, progress);
}

LoadPathSolver::Attempt LoadPathSolver::attempt_from(Equilibrium start, LoadPathOutcome& outcome,
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
  if (const auto* probe = std::get_if<ProbeLoad>(&load)) {
    UnknownForce force = probe_force(space_, fibres_, *probe, options_.kernel_width,
                                     attempt.equilibrium.applied_force);
    result = newton_.solve(force, state, options_.newton, report);
    contact_force = force.amplitude;
  } else {
    result = newton_.solve(external_forces(space_, fibres_, load, options_.kernel_width), state,
                           options_.newton, report);
    if (const auto* contact = std::get_if<ContactLoad>(&load)) contact_force = contact->force;
  }
  outcome.iterations += result.iterations();
  attempt.overshot = result.overshot;
  attempt.converged = result.converged;
  if (!result.converged) {
    attempt.trouble = result.reason + " (relative residuals " + history(result.residuals) + ")";
    return attempt;
  }
  attempt.equilibrium.applied_force =
      whole_force(fibres_, resultant(space_, result.external)).dot(direction(load));
  attempt.applied = !contact_height(load) || attempt.equilibrium.applied_force >=
                                                 contact_force * (1 - options_.force_shortfall);
  return attempt;
}

Guess LoadPathSolver::guess_for(const Load& load, const Progress& progress) const {
  return first_guess_ ? first_guess_(load, progress) : Guess{};
}

std::optional<double> LoadPathSolver::toward_slip_off(const Guess& guess, const Load& load) const {
  if (!guess.slip_off) return std::nullopt;
  const double now = magnitude(current_.load);
  const double borne = *guess.slip_off;
  const double next = now < borne ? borne : borne * (1 + options_.slip_off_bracket);
  if (now < next && next < magnitude(load)) return next;
  return std::nullopt;
}

void LoadPathSolver::accept(Attempt&& attempt) {
  previous_ = std::move(current_);
  current_ = std::move(attempt.equilibrium);
}

LoadPathOutcome LoadPathSolver::advance(const Load& target, const Progress& progress) {
  LoadPathOutcome outcome;
  if (!same_place(current_.load, target)) restart(target);
  if (magnitude(current_.load) == magnitude(target)) {
    outcome.status = Status::converged;
    return outcome;
  }
  if (slipped_ && magnitude(target) >= magnitude(*slipped_)) return slip_off(outcome, progress);
  const Load start = current_.load;
  double reached = 0;
  double step = 1;
  unsigned int halvings = 0;
  unsigned int overshoots = 0;
  while (reached < 1) {
    double aim = std::min(1.0, reached + step);
    Load load = aim == 1 ? target : interpolate(start, target, aim);
    Guess guess = guess_for(load, progress);
    if (const auto nearer = toward_slip_off(guess, load)) {
      aim = (*nearer - magnitude(start)) / (magnitude(target) - magnitude(start));
      load = with_magnitude(load, *nearer);
      guess = guess_for(load, progress);
    }
    Attempt result = attempt(load, std::move(guess), outcome, progress);
    if (result.converged && !result.applied && magnitude(load) <= magnitude(current_.load)) {
      result.converged = false;
      result.trouble = "Newton's method went to a cilium that has slipped off under a smaller load";
    }
    if (result.converged && !result.applied) {
      slipped_ = load;
      return slip_off(outcome, progress);
    }
    if (result.converged) {
      accept(std::move(result));
      reached = aim;
      step *= 2;
      halvings = halvings > 0 ? halvings - 1 : 0;
      continue;
    }
    const bool far_off = result.overshot && overshoots < max_overshoots;
    if (far_off) ++overshoots;
    if (!far_off && ++halvings > options_.max_cutbacks) {
      outcome.message = "no equilibrium found at load " + number(magnitude(load)) + ": " +
                        result.trouble + "; the last load that converged is " +
                        number(magnitude(current_.load));
      return outcome;
    }
    step = (aim - reached) / 2;
  }
  outcome.status = Status::converged;
  return outcome;
}

LoadPathOutcome LoadPathSolver::slip_off(LoadPathOutcome outcome, const Progress& progress) {
  outcome.status = Status::slipped_off;
  std::string trouble;
  double fraction = 0.5;
  unsigned int halvings = 0;
  while (magnitude(*slipped_) - magnitude(current_.load) >
         options_.slip_off_bracket * magnitude(*slipped_)) {
    const Load load = interpolate(current_.load, *slipped_, fraction);
    Attempt result = attempt(load, guess_for(load, progress), outcome, progress);
    if (result.converged) {
      if (result.applied) {
        accept(std::move(result));
      } else {
        slipped_ = load;
      }
      fraction = 0.5;
      halvings = 0;
      continue;
    }
    // A load without a solution tells nothing about the slip-off: try nearer to the last one borne.
    if (++halvings > options_.max_cutbacks) {
      trouble = "; the bracket stays this wide because no equilibrium was found at " +
                with_unit(load) + ": " + result.trouble;
      break;
    }
    fraction /= 2;
  }
  const bool probe = std::holds_alternative<ProbeLoad>(current_.load);
  outcome.slip_off_force = probe ? current_.applied_force : magnitude(current_.load);
  if (probe) outcome.slip_off_displacement = magnitude(current_.load);
  outcome.message =
      (probe ? "the cilium slips off: with a displacement of "
             : "the cilium slips off: a contact force of ") +
      with_unit(current_.load) +
      (probe ? " the contact force was applied in full, with " : " was borne in full, ") +
      with_unit(*slipped_) + (probe ? " it was not" : " was not") +
      " (a solid begins to slip off where the lowest point of its tip face comes "
      "down to the upper end of the contact kernel)" +
      trouble;
  return outcome;
}

}  // namespace ciliaval::fem
