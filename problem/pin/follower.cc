// SPDX-License-Identifier: LGPL-2.1-or-later
#include "problem/pin/follower.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "problem/continuation/root.h"
#include "problem/error.h"

namespace ciliaval::pin {
namespace {

using Number = Condition::Number;

constexpr double longest_increment = 0.4;  ///< of the displacement, in heights
constexpr double shortest_increment = 1e-9;
double missing_to(const Condition& aim, const Equilibrium& state) {
  return aim.value - (aim.number == Number::force ? state.force : state.displacement);
}

constexpr double to_rounding = 1e-15;
constexpr double at_extremum = 1e-8;  ///< of the displacement; the slip's error is its square
/// An equilibrium or an event is not found; a shorter increment may find it.
struct NotFound : SolverError {
  using SolverError::SolverError;
};

constexpr double level = 1e-9;  ///< of ds/dδ, which is zero at the straight cilium

}  // namespace

Follower::Follower(Body& body)
    : body_(body),
      untouched_(body.untouched()),
      state_(untouched_),
      motion_(body.pin().mantle > 0 ? Motion::down : Motion::up),
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

bool Follower::is_possible(const Next& next) const {
  const double rounding = body_.rounding();
  if (next.state.normal < -rounding) return false;
  const double slid = next.state.slip - state_.slip;
  if (next.motion == Motion::up) return slid >= -rounding;
  if (next.motion == Motion::down) return slid <= rounding;
  // Rounding, where the force is small.
  return std::abs(next.state.friction_angle) <= body_.pin().friction_angle + 1e-9;
}

std::optional<Follower::Next> Follower::at(double displacement) const {
  if (displacement <= untouched_.displacement + body_.rounding())
    return Next{untouched_, Motion::down};
  const Condition second{Number::displacement, displacement};
  if (!body_.pin().has_history()) return moved(Motion::up, second, state_);
  std::array motions{Motion::up, Motion::down, Motion::stick};
  if (motion_ == Motion::down)
    std::swap(motions[0], motions[1]);  // it goes on as before, if it can
  for (const Motion motion : motions)
    if (auto next = moved(motion, second, state_); next && is_possible(*next)) return next;
  return std::nullopt;
}

template <class Function>
std::optional<Follower::Next> Follower::between(const Next& next, const Function& function,
                                                bool in_one_motion, double accuracy) const {
  const double from = state_.displacement;
  const double to = next.state.displacement;
  std::optional<Next> found = next;
  const auto value = [&](double displacement) {
    const Condition second{Number::displacement, displacement};
    const double to_found = std::abs(displacement - found->state.displacement);
    const bool is_near = to_found < std::abs(displacement - from);
    auto there = in_one_motion ? moved(next.motion, second, is_near ? found->state : state_)
                               : at(displacement);
    if (!there) throw NotFound("an event of the touch was not found");
    found = std::move(there);
    return function(found->state);
  };
  const bool is_same = next.motion == motion_ && from > untouched_.displacement;
  const double start = is_same || !in_one_motion ? from : std::lerp(from, to, 1e-6);
  const double first = is_same || !in_one_motion ? function(state_) : value(start);
  const double last = function(next.state);
  if ((first > 0) == (last > 0) && first != 0 && last != 0) return std::nullopt;
  const double place = continuation::root(value, start, to, first, last, accuracy);
  value(place);
  return found;
}

std::optional<Follower::Next> Follower::turn(const Next& next, double way) const {
  if (!body_.pin().has_history()) return std::nullopt;
  const bool slid = motion_ != Motion::stick && last_way_ == way;
  Next end = next;
  if (slid && next.motion != motion_) {
    // It goes on otherwise than it slid, so it has turned before.
    auto same = moved(motion_, {Number::displacement, next.state.displacement}, state_);
    if (!same) throw NotFound("no place found where the pin turns round");
    end = *std::move(same);
  }
  if (end.motion == Motion::stick) return std::nullopt;
  const double direction = end.motion == Motion::up ? way : -way;
  const auto slides_on = [&](const Equilibrium& state) { return direction * state.slip_by_second; };
  if (slides_on(end.state) >= -level) return std::nullopt;
  return between(end, slides_on, true, at_extremum);
}

std::optional<Follower::Next> Follower::edge(const Next& next) const {
  if (!body_.pin().has_history() || next.motion == Motion::stick || next.motion == motion_)
    return std::nullopt;
  const double from = state_.displacement;
  if (from == untouched_.displacement) return std::nullopt;
  const double to = next.state.displacement;
  constexpr double same_place = 1e-12;
  // Where the slip has an extremum, there are two places with one s: from both sides.
  for (const Equilibrium& guess : {state_, next.state}) {
    const auto begin = body_.solve(held_by(Motion::stick), held_by(next.motion), guess);
    if (!begin) continue;
    const double place = begin->displacement;
    if (std::abs(place - from) > same_place && (place - from) * (place - to) < 0)
      return moved(Motion::stick, {Number::displacement, place}, *begin);
  }
  return std::nullopt;
}

std::optional<Follower::Next> Follower::with_force(const Condition& force, const Next& next) const {
  auto found = moved(next.motion, force, next.state);
  if (!found) return std::nullopt;
  const double from = state_.displacement;
  const double to = next.state.displacement;
  const double at = found->state.displacement;
  const double slid = found->state.slip - state_.slip;
  const bool is_between = (at - from) * (at - to) <= 0;
  const bool is_in_motion =
      next.motion == Motion::stick
          ? std::abs(found->state.friction_angle) <= body_.pin().friction_angle
          : !body_.pin().has_history() || (next.motion == Motion::up ? slid >= 0 : slid <= 0);
  return is_between && is_in_motion ? found : std::nullopt;
}

void Follower::take(const Next& next) {
  state_ = next.state;
  motion_ = next.motion;
}

std::optional<Follower::Stop> Follower::go_on(const Condition& aim, double way) {
  const bool by_force = aim.number == Number::force;
  const auto missing = [&](const Equilibrium& state) { return way * missing_to(aim, state); };
  const auto rises = [](const Equilibrium& state) { return state.force_by_second; };
  const double from = state_.displacement;
  double to = std::max(from + way * increment_, untouched_.displacement);
  if (!by_force && way * (aim.value - to) <= 0) to = aim.value;
  std::optional<Next> next = at(to);
  if (!next) throw NotFound("no equilibrium of the touch found next");
  if (next->motion == Motion::stick) {
    // It may have slid in between, and stick again.
    for (const double part : {0.25, 0.5, 0.75}) {
      const auto there =
          moved(Motion::stick, {Number::displacement, std::lerp(from, to, part)}, state_);
      if (!there || !is_possible(*there)) throw NotFound("the pin does not stick all the way");
    }
  }
  if (const auto turned = turn(*next, way)) {
    // It sticks there, and goes on from there.
    take({turned->state, Motion::stick});
    last_way_ = way;
    return std::nullopt;
  }
  next = edge(*next).value_or(*next);
  last_way_ = way;
  const bool is_beyond_tip = next->state.S > body_.tip();
  if (is_beyond_tip) {
    const auto at_tip = moved(next->motion, {Number::arclength, body_.tip()}, next->state);
    if (at_tip)
      next = moved(next->motion, {Number::displacement, at_tip->state.displacement}, at_tip->state);
    if (!at_tip || !next) throw NotFound("the slip-off of the touch was not found");
  }
  if (by_force && way > 0 && rises(next->state) < 0) {
    const bool is_before = rises(state_) > 0 || from == untouched_.displacement;
    const Next top = is_before ? between(*next, rises, true, to_rounding).value_or(*next)
                               : Next{state_, motion_};
    if (missing(top.state) > 0) {
      take(top);
      return Stop::fold;
    }
    next = top;
  }
  const bool is_reached = by_force && missing(next->state) <= 0;
  if (is_reached) {
    std::optional<Next> found = with_force(aim, *next);
    if (!found) found = between(*next, missing, false, to_rounding);
    if (found) next = std::move(found);
  }
  const bool is_at_end = std::abs(next->state.displacement - to) <= body_.rounding();
  take(*next);
  if (is_reached || (is_at_end && to == (by_force ? untouched_.displacement : aim.value)))
    return Stop::aim;
  if (is_beyond_tip) return Stop::tip;
  return std::nullopt;
}

Follower::Stop Follower::advance(const Condition& given) {
  Condition aim = given;
  if (aim.number == Number::displacement) aim.value = std::max(aim.value, untouched_.displacement);
  const double height = body_.pin().height;
  const double way = missing_to(aim, state_) < 0 ? -1 : 1;
  while (way * missing_to(aim, state_) > 0) {
    try {
      if (const auto stop = go_on(aim, way)) return *stop;
      increment_ = std::min(2 * increment_, longest_increment * height);
    } catch (const NotFound&) {
      increment_ /= 2;
      if (increment_ < shortest_increment * height) throw;
    }
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
