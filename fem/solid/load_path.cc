// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/load_path.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>
#include <variant>

#include "fem/solid/forces.h"

namespace ciliaval::fem {
namespace {

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

/// The same load but for its magnitude?
bool same_place(const Load& a, const Load& b) {
  if (type(a) != type(b) || azimuth(a) != azimuth(b)) return false;
  if (const auto* contact = std::get_if<ContactLoad>(&a))
    return contact->height == std::get<ContactLoad>(b).height;
  if (const auto* section = std::get_if<SectionLoad>(&a))
    return section->arclength == std::get<SectionLoad>(b).arclength;
  return true;
}

/// Whether the path from a to b passes through loads that the mesh can bear: a section load only
/// finds planes at the arc lengths of the path itself.
bool can_interpolate(const Load& a, const Load& b) {
  if (type(a) != type(b)) return false;
  const auto* section = std::get_if<SectionLoad>(&a);
  return section == nullptr || section->arclength == std::get<SectionLoad>(b).arclength;
}

}  // namespace

ExternalForces external_forces(const SolidSpace& space, const Fibres& fibres, const Load& load,
                               double kernel_width) {
  const Vector3 e = direction(load);
  if (const auto* section = std::get_if<SectionLoad>(&load))
    return dead_forces(section_force(space, fibres, section->force, section->arclength, e));
  if (const auto* dead = std::get_if<DeadLoad>(&load)) {
    const Vector3 b = dead->force_per_length / fibres.area() * e;
    return dead_forces(body_force(space, [&b](const Vector3&) -> Vector3 { return b; }));
  }
  HeightDensity density;
  if (const auto* contact = std::get_if<ContactLoad>(&load)) {
    density = contact_density(contact->force, fibres.area(), contact->height, kernel_width);
  } else {
    density = flow_density(std::get<FlowLoad>(load).force_per_height, fibres.area());
  }
  return [&space, &fibres, density, e](const dealii::Vector<double>& displacement,
                                       dealii::Vector<double>& forces,
                                       const dealii::AffineConstraints<double>& constraints,
                                       dealii::SparseMatrix<double>* matrix) {
    add_fibre_forces(space, fibres, density, e, displacement, forces, constraints, matrix);
  };
}

struct LoadPathSolver::Attempt {
  bool converged = false;
  bool applied = false;  ///< the whole force was applied
  std::string trouble;
  Equilibrium equilibrium;
};

LoadPathSolver::LoadPathSolver(const SolidSpace& space, const Fibres& fibres, Newton& newton,
                               const Load& first, LoadPathOptions options)
    : space_(space),
      fibres_(fibres),
      newton_(newton),
      options_(options),
      current_{with_magnitude(first, 0), space.undeformed(), 0} {}

void LoadPathSolver::restart(const Load& load) {
  current_ = {with_magnitude(load, 0), space_.undeformed(), 0};
  previous_.reset();
}

SolidState LoadPathSolver::predicted(const Load& load) const {
  SolidState state = current_.state;
  if (!previous_ || !same_place(previous_->load, load) || !same_place(current_.load, load))
    return state;
  const double last = magnitude(current_.load) - magnitude(previous_->load);
  if (last == 0) return state;
  const double factor = std::clamp((magnitude(load) - magnitude(current_.load)) / last, -1.0, 1.5);
  state.displacement.add(factor, current_.state.displacement, -factor,
                         previous_->state.displacement);
  for (std::size_t e = 0; e < state.pressure.size(); ++e)
    state.pressure[e] += factor * (current_.state.pressure[e] - previous_->state.pressure[e]);
  return state;
}

LoadPathSolver::Attempt LoadPathSolver::attempt(const Load& load, LoadPathOutcome& outcome,
                                                const Progress& progress) {
  Attempt attempt;
  attempt.equilibrium.load = load;
  attempt.equilibrium.state = predicted(load);
  NewtonOptions newton = options_.newton;
  const auto report = [&](int iteration, double residual) {
    if (progress)
      progress("load " + number(magnitude(load)) + ", iteration " + std::to_string(iteration) +
               ", residual " + number(residual));
  };
  const NewtonResult result =
      newton_.solve(external_forces(space_, fibres_, load, options_.kernel_width),
                    attempt.equilibrium.state, newton, report);
  outcome.iterations += result.iterations();
  attempt.converged = result.converged;
  if (!result.converged) {
    attempt.trouble = result.reason + " (relative residuals " + history(result.residuals) + ")";
    return attempt;
  }
  attempt.equilibrium.applied_force = resultant(space_, result.external).dot(direction(load));
  attempt.applied = true;
  if (const auto* contact = std::get_if<ContactLoad>(&load))
    attempt.applied =
        attempt.equilibrium.applied_force >= contact->force * (1 - options_.force_shortfall);
  return attempt;
}

void LoadPathSolver::accept(Attempt&& attempt) {
  previous_ = std::move(current_);
  current_ = std::move(attempt.equilibrium);
}

LoadPathOutcome LoadPathSolver::advance(const Load& target, const Progress& progress) {
  LoadPathOutcome outcome;
  if (slipped_ && same_place(*slipped_, target) && same_place(current_.load, target) &&
      magnitude(target) >= magnitude(*slipped_))
    return slip_off(*slipped_, outcome, progress);
  if (!can_interpolate(current_.load, target)) restart(target);
  const Load start = current_.load;
  double t = 0;
  double step = 1;
  unsigned int cutbacks = 0;
  while (t < 1) {
    const double next = std::min(1.0, t + step);
    const Load load = next == 1 ? target : interpolate(start, target, next);
    Attempt result = attempt(load, outcome, progress);
    if (result.converged && !result.applied) return slip_off(load, outcome, progress);
    if (result.converged) {
      accept(std::move(result));
      t = next;
      continue;
    }
    if (cutbacks == options_.max_cutbacks) {
      outcome.message = "no equilibrium found at load " + number(magnitude(load)) + ": " +
                        result.trouble + "; the last load that converged is " +
                        number(magnitude(current_.load));
      return outcome;
    }
    ++cutbacks;
    step /= 2;
  }
  outcome.status = Status::converged;
  return outcome;
}

LoadPathOutcome LoadPathSolver::slip_off(const Load& slipped, LoadPathOutcome outcome,
                                         const Progress& progress) {
  slipped_ = slipped;
  while (same_place(current_.load, *slipped_) &&
         magnitude(*slipped_) - magnitude(current_.load) >
             options_.slip_off_bracket * magnitude(*slipped_)) {
    const Load middle = interpolate(current_.load, *slipped_, 0.5);
    Attempt result = attempt(middle, outcome, progress);
    if (result.converged && result.applied) {
      accept(std::move(result));
    } else {
      slipped_ = middle;
    }
  }
  outcome.status = Status::slipped_off;
  outcome.slip_off_force = magnitude(current_.load);
  outcome.message = "the cilium slips off: a contact force of " + number(magnitude(current_.load)) +
                    " N was borne in full, " + number(magnitude(*slipped_)) + " N was not";
  return outcome;
}

}  // namespace ciliaval::fem
