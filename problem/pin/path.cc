// SPDX-License-Identifier: LGPL-2.1-or-later
#include "problem/pin/path.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "problem/error.h"

namespace ciliaval::pin {

Pin pin_of(const Cilium& cilium, const Load& load, double unit) {
  const TouchLaw& touch = load.touch();
  Pin pin;
  pin.height = contact_height(load).value() / unit;
  pin.radius = touch.radius / unit;
  if (touch.at == TouchLaw::At::mantle) pin.mantle = cilium.extent(azimuth(load)) / 2 / unit;
  pin.is_horizontal = touch.law == TouchLaw::Law::horizontal;
  pin.friction_angle = std::atan(touch.friction);
  if (pin.radius >= pin.height)
    throw InputError(
        "the pin of the touch must lie above the base: its radius is its height or more");
  return pin;
}

PathSolver::PathSolver(MakeBody make_body, bool with_range)
    : make_body_(std::move(make_body)), with_range_(with_range) {}

void PathSolver::find_limits(MechanicsStep& step) {
  const bool is_probe = step.load.is<ProbeLoad>();
  if (!limits_ && (with_range_ || is_probe)) limits_ = limits(*body_);
  if (!limits_) return;
  const Equilibrium& at = is_probe ? limits_->at_tip : limits_->largest_force;
  step.slip_off_force = body_->force_unit() * at.force;
  if (is_probe) step.slip_off_displacement = body_->length() * at.displacement;
}

void PathSolver::say_slipped_off(MechanicsStep& step) {
  step.status = Status::slipped_off;
  if (!limits_) limits_ = limits(*body_);
  const bool is_probe = step.load.is<ProbeLoad>();
  const Equilibrium& last = is_probe ? limits_->at_tip : limits_->largest_force;
  const double mm = 1e3 * body_->length();
  const double mN = 1e3 * body_->force_unit();
  std::ostringstream message;
  message.precision(8);
  message << "the contact slips off: the largest " << (is_probe ? "displacement" : "force")
          << " in an equilibrium is ";
  if (is_probe)
    message << mm * last.displacement << " mm, under " << mN * last.force
            << " mN, where the contact reaches the tip";
  else
    message << mN * last.force << " mN, at a displacement of the probe of "
            << mm * last.displacement << " mm with the contact at the arc length " << mm * last.S
            << (limits_->is_fold
                    ? " mm: a fold, from which the cilium slides away under a force that stays"
                    : " mm: it reaches the tip");
  step.message = message.str();
}

void PathSolver::put_state(MechanicsStep& step) {
  const Equilibrium& state = follower_->state();
  const double L = body_->length();
  const double P = body_->force_unit();
  step.deformation = body_->deformation(state);
  step.status = Status::converged;
  step.applied_force = P * state.force;
  step.contact_arclength = L * std::min(state.S, body_->tip());
  step.touch = ProbeContact{.vertical_force = P * state.vertical,
                            .base_moment = P * L * state.base_moment,
                            .displacement = L * state.displacement,
                            .state = follower_->motion() == Follower::Motion::stick
                                         ? ProbeContact::State::stick
                                         : ProbeContact::State::slip};
  step.unknowns = body_->n_unknowns();
  step.iterations = state.iterations;
}

void PathSolver::solve(MechanicsStep& step) {
  const Load& load = step.load;
  const bool goes_on = body_ && with_magnitude(last_, 0) == with_magnitude(load, 0);
  if (!goes_on) {
    follower_.reset();
    limits_.reset();
    body_ = make_body_(load);
  }
  last_ = load;
  try {
    find_limits(step);
    if (!follower_) follower_.emplace(*body_);
    using Number = Condition::Number;
    const Condition aim = load.is<ProbeLoad>()
                              ? Condition{Number::displacement, magnitude(load) / body_->length()}
                              : Condition{Number::force, magnitude(load) / body_->force_unit()};
    if (follower_->advance(aim) == Follower::Stop::aim) return put_state(step);
  } catch (const SolverError&) {
    follower_.reset();
    throw;
  }
  follower_.reset();
  say_slipped_off(step);
}

}  // namespace ciliaval::pin
