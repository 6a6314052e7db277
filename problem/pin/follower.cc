// SPDX-License-Identifier: LGPL-2.1-or-later
#include "problem/pin/follower.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "problem/continuation/root.h"
#include "problem/error.h"

namespace ciliaval::pin {
namespace {

using Number = Condition::Number;

constexpr double longest_increment = 0.1;  ///< of the displacement, in heights
constexpr double shortest_increment = 1e-9;
constexpr double level = 1e-9;  ///< of ds/dδ, which is zero at the straight cilium

}  // namespace

Follower::Follower(Body& body)
    : body_(body),
      untouched_(body.untouched()),
      state_(untouched_),
      increment_(longest_increment * body.pin().height / 4) {}

Condition Follower::held_by(Motion motion) const {
  if (motion == Motion::stick) return {Number::slip, state_.slip};
  const double alpha = body_.pin().friction_angle;
  return {Number::friction, motion == Motion::up ? alpha : -alpha};
}

std::optional<Follower::Next> Follower::moved(Motion motion, const Condition& second,
                                              const Equilibrium& guess) const {
  auto state = body_.solve(held_by(motion), second, guess);
  if (!state) return std::nullopt;
  return Next{*std::move(state), motion};
}

std::optional<Follower::Next> Follower::at(double displacement) const {
  const double rounding = body_.rounding();
  if (displacement <= untouched_.displacement + rounding) return Next{untouched_, Motion::down};
  const Condition second{Number::displacement, displacement};
  const double before = state_.slip;
  const auto presses = [&](const Equilibrium& state) { return state.force >= -rounding; };
  const auto up = moved(Motion::up, second, state_);
  if (!body_.pin().has_history()) return up;
  if (up && up->state.slip >= before - rounding && presses(up->state)) return up;
  const auto down = moved(Motion::down, second, state_);
  if (down && down->state.slip <= before + rounding && presses(down->state)) return down;
  auto stick = moved(Motion::stick, second, state_);
  const double allowed = body_.pin().friction_angle + 1e-9;  // rounding, where the force is small
  if (stick && presses(stick->state) && std::abs(stick->state.friction_angle) <= allowed)
    return stick;
  return std::nullopt;
}

template <class Function>
std::optional<Follower::Next> Follower::between(const Next& next, const Function& function,
                                                bool in_one_motion) const {
  const double from = state_.displacement;
  const double to = next.state.displacement;
  std::optional<Next> found = next;
  const auto value = [&](double displacement) {
    found = in_one_motion ? moved(next.motion, {Number::displacement, displacement}, found->state)
                          : at(displacement);
    if (!found) throw SolverError("an event of the touch was not found");
    return function(found->state);
  };
  const bool is_same = next.motion == motion_ && from > untouched_.displacement;
  const double start = is_same || !in_one_motion ? from : std::lerp(from, to, 1e-6);
  const double first = is_same || !in_one_motion ? function(state_) : value(start);
  const double last = function(next.state);
  if ((first > 0) == (last > 0) && first != 0 && last != 0) return std::nullopt;
  const double place = continuation::root(value, start, to, first, last);
  value(place);
  return found;
}

std::optional<Follower::Next> Follower::edge(const Next& next) const {
  if (!body_.pin().has_history() || next.motion == Motion::stick || next.motion == motion_)
    return std::nullopt;
  const double from = state_.displacement;
  const auto begin = body_.solve(held_by(Motion::stick), held_by(next.motion), state_);
  if (!begin) return std::nullopt;
  const double place = begin->displacement;
  const double to = next.state.displacement;
  constexpr double same_place = 1e-12;
  if (std::abs(place - from) <= same_place || (place - from) * (place - to) >= 0)
    return std::nullopt;
  return moved(Motion::stick, {Number::displacement, place}, *begin);
}

void Follower::take(const Next& next) {
  state_ = next.state;
  motion_ = next.motion;
}

Follower::Stop Follower::advance(const Condition& given) {
  Condition aim = given;
  const bool by_force = aim.number == Number::force;
  if (!by_force) aim.value = std::max(aim.value, untouched_.displacement);
  const auto missing = [&](const Equilibrium& state) {
    return aim.value - (by_force ? state.force : state.displacement);
  };
  const auto rises = [](const Equilibrium& state) { return state.force_by_second; };
  const double way = missing(state_) < 0 ? -1 : 1;
  while (way * missing(state_) > 0) {
    const double from = state_.displacement;
    double to = std::max(from + way * increment_, untouched_.displacement);
    if (!by_force && way * (aim.value - to) <= 0) to = aim.value;
    std::optional<Next> next = at(to);
    if (next && next->motion != Motion::stick && body_.pin().has_history()) {
      // Within the increment the pin may turn round on the cilium: s has an extremum.
      const double direction = next->motion == Motion::up ? way : -way;
      const auto slides_on = [&](const Equilibrium& state) {
        return direction * state.slip_by_second;
      };
      if (slides_on(next->state) < -level) next = between(*next, slides_on, true);
    }
    if (next) next = edge(*next).value_or(*next);
    if (!next) {
      increment_ /= 2;
      if (increment_ < shortest_increment * body_.pin().height)
        throw SolverError("no equilibrium of the touch found next");
      continue;
    }
    increment_ = std::min(2 * increment_, longest_increment * body_.pin().height);
    const bool is_beyond_tip = next->state.S > body_.tip();
    if (is_beyond_tip) {
      const auto at_tip = moved(next->motion, {Number::arclength, body_.tip()}, next->state);
      if (at_tip)
        next =
            moved(next->motion, {Number::displacement, at_tip->state.displacement}, at_tip->state);
      if (!at_tip || !next) throw SolverError("the slip-off of the touch was not found");
    }
    if (by_force && way > 0 && rises(next->state) < 0) {
      const bool is_before = rises(state_) > 0 || from == untouched_.displacement;
      const Next top =
          is_before ? between(*next, rises, true).value_or(*next) : Next{state_, motion_};
      if (missing(top.state) > 0) {
        take(top);
        return Stop::fold;
      }
      next = top;
    }
    const bool is_reached = by_force && way * missing(next->state) <= 0;
    if (is_reached) next = between(*next, missing, false).value_or(*next);
    const bool is_at_end = std::abs(next->state.displacement - to) <= body_.rounding();
    take(*next);
    if (is_reached || (is_at_end && to == (by_force ? untouched_.displacement : aim.value))) break;
    if (is_beyond_tip) return Stop::tip;
  }
  return Stop::aim;
}

Limits limits(Body& body) {
  const Condition unbearable{Number::force, 1e9};
  const Condition beyond_tip{Number::displacement, 10 * body.tip()};
  Follower follower(body);
  Limits result;
  result.is_fold = follower.advance(unbearable) == Follower::Stop::fold;
  result.largest_force = follower.state();
  if (result.is_fold) follower.advance(beyond_tip);
  result.at_tip = follower.state();
  return result;
}

}  // namespace ciliaval::pin
