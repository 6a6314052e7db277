// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/beam/sweep/contact_law.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace ciliaval::fem::beam::sweep {
namespace {

constexpr double slack = 1e-9;         ///< of gaps in L, of angles, and of |T| over μN
constexpr double slide_slack = 1e-12;  ///< of a way, in L
constexpr double near_gap = 1e-2;      ///< more than a step may close, in L
constexpr double near_angle = 0.1;     ///< likewise, rad
constexpr double most_samples = 64;    ///< of the end section

/// True if another part of the end section than the touching end is near the surface, so that a
/// step may bring it there.
bool is_near(const Tip& tip, const TipState& state) {
  const double R = tip.radius();
  const double eta = state.status.touch == Touch::rear ? -R : R;
  if (std::abs(tip.slope_angle(state.pair.xi) - state.angle()) < near_angle) return true;
  const double end = -eta;
  const Depth rest =
      deepest(tip, state, state.place, std::min(end, -end / 2), std::max(end, -end / 2));
  return rest.depth > -near_gap;
}

/// Touches that may follow one.
std::vector<Touch> neighbours(const Tip& tip, const TipState& before) {
  using enum Touch;
  const Touch touch = before.status.touch;
  if (touch == face)
    return before.pair.eta < 0
               ? std::vector{face, rear, rear_and_face, both_ends, face_and_front, front}
               : std::vector{face, front, face_and_front, both_ends, rear_and_face, rear};
  if (touch == both_ends) return {both_ends, rear, front, rear_and_face, face_and_front, face};
  if (touch == rear_and_face) return {rear_and_face, rear, face, both_ends, front};
  if (touch == face_and_front) return {face_and_front, front, face, both_ends, rear};
  const bool is_alone = tip.radius() == 0 || !is_near(tip, before);
  if (touch == front)
    return is_alone ? std::vector{front}
                    : std::vector{front, face, face_and_front, both_ends, rear};
  return is_alone ? std::vector{rear} : std::vector{rear, face, rear_and_face, both_ends, front};
}

/// A guess of the state with another touch: the points that go on, and at the others the place that
/// `through`, which has gone through the surface, shows.
TipState guess_of(const Tip& tip, const TipState& before, const TipState& through, Touch touch) {
  TipState guess = through;
  guess.points.clear();
  guess.ratio = before.ratio;
  for (const Touch part : parts(touch)) {
    double eta = part == Touch::rear ? -tip.radius() : tip.radius();
    if (part == Touch::face) eta = deepest(tip, through, through.place).eta;
    ContactPoint point{part, 0, {tip.point_at(through, eta)[0] - through.place.travel, eta}};
    for (const ContactPoint& last : before.points)
      if (last.part == part) point = last;
    guess.points.push_back(point);
  }
  guess.pair = guess.points.front().pair;
  return guess;
}

/// The frictions to try after one: what holds must give way towards T, what slides must stop first.
std::vector<int> frictions(const Tip& tip, int first) {
  if (tip.friction() == 0) return {1};
  if (first == 0) return {0, 1, -1};
  return {first, 0, -first};
}

}  // namespace

bool is_admissible(const Tip& tip, const TipState& state, const Pair& start) {
  const double mu = tip.friction();
  if (!(state.normal_force > 0)) return false;
  if (state.status.slip == 0) {
    if (mu == 0 || std::abs(state.friction_force) > mu * state.normal_force * (1 + slack))
      return false;
  } else if (mu > 0 && tip.slid(state, start) * state.status.slip > slide_slack) {
    return false;
  }
  const double R = tip.radius();
  if (R == 0) return true;
  for (const ContactPoint& point : state.points)
    if (!(point.normal_force > 0 && std::abs(point.pair.eta) <= R * (1 + slack))) return false;
  if (deepest(tip, state, state.place).depth > slack) return false;
  if (state.status.touch != Touch::rear && state.status.touch != Touch::front) return true;
  // Inwards along the section the surface must not come nearer.
  const double side = state.status.touch == Touch::rear ? -1 : 1;
  return side * std::sin(tip.slope_angle(state.pair.xi) - state.angle()) > -slack;
}

std::optional<TipState> go_on(const Tip& tip, const Place& place, const TipState& before,
                              const TipState& guess, const Viscosity& viscosity, int& iterations) {
  TipState through = before;  // with the touch that was, through the surface elsewhere
  through.place = place;
  for (const Touch touch : neighbours(tip, before)) {
    const bool same_touch = touch == before.status.touch;
    // From a face alone the touching point moves on without a break.
    const bool is_face = before.status.touch == Touch::face && parts(touch).size() == 1;
    const TipState other = same_touch || is_face ? before : guess_of(tip, before, through, touch);
    const Pair start = same_touch || is_face ? before.points.front().pair
                                             : tip.start_of(before, other.points.front());
    for (const int slip : frictions(tip, before.status.slip)) {
      const bool same = same_touch && slip == before.status.slip;
      const auto state = tip.solve({touch, slip}, place, same ? guess : other, start, viscosity);
      iterations += state ? state->iterations : 0;
      if (state && is_admissible(tip, *state, start)) return state;
      if (state && same) through = *state;
    }
  }
  return std::nullopt;
}

std::optional<TipState> land(const Tip& tip, const Place& place, const TipState& before,
                             const TipState& through, int drag, const Viscosity& viscosity,
                             int& iterations) {
  TipState open = before;
  open.status = {};
  const Depth deep = deepest(tip, through, place);
  std::vector<Touch> touches{Touch::rear};
  if (tip.radius() > 0)
    touches = deep.eta < 0 ? std::vector{Touch::rear, Touch::face, Touch::front}
                           : std::vector{Touch::front, Touch::face, Touch::rear};
  for (const Touch touch : touches) {
    const double eta = touch == Touch::face    ? deep.eta
                       : touch == Touch::front ? tip.radius()
                                               : -tip.radius();
    const Pair start{tip.point_at(open, eta)[0] - open.place.travel, eta};
    for (const int slip : frictions(tip, drag)) {
      TipState guess = through;
      guess.pair = {tip.point_at(through, start.eta)[0] - place.travel, start.eta};
      const auto state = tip.solve({touch, slip}, place, guess, start, viscosity);
      iterations += state ? state->iterations : 0;
      if (state && is_admissible(tip, *state, start)) return state;
    }
  }
  return std::nullopt;
}

Depth deepest(const Tip& tip, const TipState& state, const Place& place) {
  return deepest(tip, state, place, -tip.radius(), tip.radius());
}

Depth deepest(const Tip& tip, const TipState& state, const Place& place, double from, double to) {
  Depth result{-tip.gap(state, place, from), from};
  const auto compare = [&](double eta) {
    const double depth = -tip.gap(state, place, eta);
    if (depth > result.depth) result = {depth, eta};
  };
  const auto is_rising = [&](double eta) {
    return tip.slope_angle(tip.point_at(state, eta)[0] - place.travel) > state.angle();
  };
  const double finest = tip.surface().finest_length() / tip.length();
  const double samples = std::ceil(std::min(most_samples, std::max(2.0, 4 * (to - from) / finest)));
  bool rises = is_rising(from);
  for (double i = 1; i <= samples && from < to; ++i) {
    double high = std::lerp(from, to, i / samples);
    compare(high);
    const bool rose = rises;
    rises = is_rising(high);
    if (!rose || rises) continue;
    // The deepest point lies between two samples: where the slopes agree.
    double low = std::lerp(from, to, (i - 1) / samples);
    while (high - low > 1e-9 * tip.radius()) {
      const double middle = std::midpoint(low, high);
      (is_rising(middle) ? low : high) = middle;
    }
    compare(std::midpoint(low, high));
  }
  return result;
}

}  // namespace ciliaval::fem::beam::sweep
