// SPDX-License-Identifier: LGPL-2.1-or-later
#include "analytic/elastica/touch/step.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <sstream>
#include <utility>

#include "analytic/elastica/planar.h"
#include "analytic/elastica/tip_contact.h"
#include "problem/error.h"
#include "problem/types.h"

namespace ciliaval::analytic::elastica::touch {
namespace {

Problem problem_of(const Cilium& cilium, const Load& load) {
  const double L = cilium.length();
  const double B = tip_stiffness(cilium, azimuth(load));
  const TouchLaw& touch = load.touch();
  Problem problem;
  for (const double end : cilium.interfaces()) problem.ends.push_back(end / L);
  problem.ends.back() = 1;
  for (const Segment& segment : cilium.segments)
    problem.compliance.push_back(B / (segment.young_modulus * cilium.second_moment(azimuth(load))));
  problem.height = contact_height(load).value() / L;
  problem.pin = touch.radius / L;
  if (touch.at == TouchLaw::At::mantle) problem.mantle = cilium.extent(azimuth(load)) / 2 / L;
  problem.is_horizontal = touch.law == TouchLaw::Law::horizontal;
  problem.friction_angle = std::atan(touch.friction);
  return problem;
}

/// The shape under the forces of the contact, straight above it.
PlanarShape shape_of(const Problem& problem, const Equilibrium& at) {
  const auto steps =
      std::make_shared<const std::vector<point_forces::Step>>(steps_along(problem, at));
  PlanarShape shape;
  shape.breaks.push_back(0);
  for (const point_forces::Step& step : *steps) shape.breaks.push_back(step.end());
  for (const double end : problem.ends)
    if (end > shape.breaks.back() + shortest_piece) shape.breaks.push_back(end);
  if (shape.breaks.back() < 1) shape.breaks.back() = 1;
  shape.contact = std::min(at.S(), 1.0);
  shape.state = [steps, problem, at](double S, std::size_t i) {
    PlanarState state;
    state.S = S;
    if (i >= steps->size()) {
      const double above = S - std::min(at.S(), 1.0);
      state.theta = at.theta;
      state.w = at.x + above * std::sin(at.theta);
      state.z = at.z + above * std::cos(at.theta);
    } else {
      const point_forces::Step& step = (*steps)[i];
      const point_forces::Section section = step.at(S);
      const double middle = std::midpoint(step.start(), step.end());
      std::size_t segment = 0;
      while (problem.ends[segment + 1] < middle) ++segment;
      state.theta = section.theta;
      state.w = section.x;
      state.z = section.z;
      state.curvature = section.curvature;
      state.moment = section.curvature / problem.compliance[segment];
      state.force = at.force();
      state.vertical = -at.vertical();
    }
    state.phi = std::numbers::pi / 2 - state.theta;
    return state;
  };
  return shape;
}

/// The same touch, but for the magnitude.
bool is_same_touch(const Load& a, const Load& b) {
  return with_magnitude(a, 0) == with_magnitude(b, 0);
}

}  // namespace

PathSolver::PathSolver(const Cilium& cilium, double tolerance, bool with_range)
    : cilium_(cilium), tolerance_(tolerance), with_range_(with_range) {}

bool PathSolver::goes_on(const Load& load) const {
  return force_unit_ > 0 && is_same_touch(last_, load);
}

void PathSolver::start(const Load& load) {
  const double L = cilium_.length();
  problem_ = problem_of(cilium_, load);
  if (problem_.pin >= problem_.height)
    throw InputError(
        "the pin of the touch must lie above the base: its radius is its height or more");
  force_unit_ = tip_stiffness(cilium_, azimuth(load)) / (L * L);
  limits_.reset();
  follower_.reset();
}

void PathSolver::find_limits(MechanicsStep& step) {
  const bool is_probe = step.load.is<ProbeLoad>();
  if (!limits_ && (with_range_ || is_probe)) limits_ = limits(problem_);
  if (!limits_) return;
  const Equilibrium& at = is_probe ? limits_->at_tip : limits_->largest_force;
  step.slip_off_force = force_unit_ * at.force();
  if (is_probe) step.slip_off_displacement = cilium_.length() * at.displacement(problem_);
  step.slip_off_uncertainty = tolerance_ * *slip_off_limit(step);
}

void PathSolver::say_slipped_off(MechanicsStep& step) const {
  step.status = Status::slipped_off;
  const Limits at = limits_ ? *limits_ : limits(problem_);
  const bool is_probe = step.load.is<ProbeLoad>();
  const Equilibrium& last = is_probe ? at.at_tip : at.largest_force;
  const double mm = 1e3 * cilium_.length();
  std::ostringstream message;
  message.precision(8);
  message << "the contact slips off: the largest " << (is_probe ? "displacement" : "force")
          << " in an equilibrium is ";
  if (is_probe)
    message << mm * last.displacement(problem_) << " mm, under " << 1e3 * force_unit_ * last.force()
            << " mN, where the contact reaches the tip";
  else
    message << 1e3 * force_unit_ * last.force() << " mN, at a displacement of the probe of "
            << mm * last.displacement(problem_) << " mm with the contact at the arc length "
            << mm * last.S()
            << (at.is_fold
                    ? " mm: a fold, from which the cilium slides away under a force that stays"
                    : " mm: it reaches the tip");
  step.message = message.str();
}

void PathSolver::put_state(MechanicsStep& step) const {
  const Equilibrium& state = follower_->state();
  const double L = cilium_.length();
  const PlanarUnits units{L, force_unit_};
  step.deformation =
      Deformation{planar_centreline(shape_of(problem_, state), units, direction(step.load),
                                    std::max(tolerance_ / 10, 1e-13)),
                  nullptr};
  step.status = Status::converged;
  step.applied_force = force_unit_ * state.force();
  step.contact_arclength = L * std::min(state.S(), 1.0);
  step.touch = ProbeContact{.vertical_force = force_unit_ * state.vertical(),
                            .base_moment = force_unit_ * L * state.base_moment(),
                            .displacement = L * state.displacement(problem_),
                            .state = follower_->motion() == Follower::Motion::stick
                                         ? ProbeContact::State::stick
                                         : ProbeContact::State::slip};
  step.tip_uncertainty = L * tolerance_;
  step.tip_angle_uncertainty = tolerance_;
  step.applied_force_uncertainty = tolerance_ * std::abs(step.applied_force);
  step.unknowns = static_cast<std::size_t>(state.unknowns.size());
  step.iterations = state.iterations;
}

void PathSolver::solve(MechanicsStep& step) {
  const Load& load = step.load;
  if (!goes_on(load)) start(load);
  last_ = load;
  find_limits(step);
  if (!follower_) follower_.emplace(problem_);
  const Condition aim =
      load.is<ProbeLoad>()
          ? Condition{Condition::Number::displacement, magnitude(load) / cilium_.length()}
          : Condition{Condition::Number::force, magnitude(load) / force_unit_};
  try {
    if (follower_->advance(aim) == Follower::Stop::aim) return put_state(step);
  } catch (const SolverError&) {
    follower_.reset();
    throw;
  }
  follower_.reset();
  say_slipped_off(step);
}

}  // namespace ciliaval::analytic::elastica::touch
