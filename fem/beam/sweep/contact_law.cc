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
constexpr double most_samples = 64;    ///< of the end section

/// Which touches come next to one.
std::vector<Touch> neighbours(const Tip& tip, const TipState& before) {
  if (tip.radius() == 0) return {Touch::rear};
  switch (before.status.touch) {
    case Touch::front:
      return {Touch::front, Touch::face, Touch::rear};
    case Touch::face:
      return before.pair.eta < 0 ? std::vector{Touch::face, Touch::rear, Touch::front}
                                 : std::vector{Touch::face, Touch::front, Touch::rear};
    default:
      return {Touch::rear, Touch::face, Touch::front};
  }
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
  if (state.status.touch == Touch::face)
    return std::abs(state.pair.eta) <= R * (1 + slack) &&
           std::min(tip.gap(state, state.place, -R), tip.gap(state, state.place, R)) > -slack;
  const double side = state.status.touch == Touch::rear ? -1 : 1;
  // Inwards along the section the surface must not come nearer.
  return side * std::sin(tip.slope_angle(state.pair.xi) - state.angle()) > -slack &&
         tip.gap(state, state.place, -side * R) > -slack;
}

Pair start_of(const Tip& tip, const TipState& before, Touch touch) {
  if (before.status.touch != Touch::none &&
      (before.status.touch == touch || before.status.touch == Touch::face || touch == Touch::face))
    return before.pair;
  const double eta = touch == Touch::front ? tip.radius() : -tip.radius();
  return {tip.point_at(before, eta)[0] - before.place.travel, eta};
}

std::optional<TipState> go_on(const Tip& tip, const Place& place, const TipState& before,
                              const TipState& guess, const Viscosity& viscosity, int& iterations) {
  for (const Touch touch : neighbours(tip, before)) {
    const Pair start = start_of(tip, before, touch);
    const bool same_touch = touch == before.status.touch;
    for (const int slip : frictions(tip, before.status.slip)) {
      TipState first = same_touch && slip == before.status.slip ? guess : before;
      if (!same_touch) first.pair = start;
      const auto state = tip.solve({touch, slip}, place, first, start, viscosity);
      iterations += state ? state->iterations : 0;
      if (state && is_admissible(tip, *state, start)) return state;
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
    Pair start = start_of(tip, open, touch);
    if (touch == Touch::face)
      start = {tip.point_at(open, deep.eta)[0] - open.place.travel, deep.eta};
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
  const double R = tip.radius();
  Depth result{-tip.gap(state, place, -R), -R};
  if (R == 0) return result;
  const double finest = tip.surface().finest_length() / tip.length();
  const double samples = std::ceil(std::min(most_samples, std::max(2.0, 8 * R / finest)));
  for (double i = 1; i <= samples; ++i) {
    const double eta = std::lerp(-R, R, i / samples);
    const double depth = -tip.gap(state, place, eta);
    if (depth > result.depth) result = {depth, eta};
  }
  return result;
}

}  // namespace ciliaval::fem::beam::sweep
