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

/// Whether more of the end section than the end that touches is near the surface, so that a step
/// may bring it there.
bool is_near(const Tip& tip, const TipState& state) {
  const double R = tip.radius();
  const double eta = state.status.touch == Touch::rear ? -R : R;
  if (std::abs(tip.slope_angle(state.pair.xi) - state.angle()) < near_angle) return true;
  const Depth rest = deepest(tip, state, state.place, -eta / 2, -eta);
  return rest.depth > -near_gap;
}

/// Which touches come next to one.
std::vector<Touch> neighbours(const Tip& tip, const TipState& before) {
  const auto is_alone = [&] { return tip.radius() == 0 || !is_near(tip, before); };
  switch (before.status.touch) {
    case Touch::front:
      if (is_alone()) return {Touch::front};
      return {Touch::front, Touch::face, Touch::both, Touch::rear};
    case Touch::both:
      return {Touch::both, Touch::rear, Touch::front, Touch::face};
    case Touch::face:
      return before.pair.eta < 0 ? std::vector{Touch::face, Touch::rear, Touch::both, Touch::front}
                                 : std::vector{Touch::face, Touch::front, Touch::both, Touch::rear};
    default:
      if (is_alone()) return {Touch::rear};
      return {Touch::rear, Touch::face, Touch::both, Touch::front};
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
  if (state.status.touch == Touch::both && !(state.both.head<2>().minCoeff() > 0)) return false;
  if (deepest(tip, state, state.place).depth > slack) return false;
  if (state.status.touch == Touch::both) return true;
  if (state.status.touch == Touch::face) return std::abs(state.pair.eta) <= R * (1 + slack);
  // Inwards along the section the surface must not come nearer.
  const double side = state.status.touch == Touch::rear ? -1 : 1;
  return side * std::sin(tip.slope_angle(state.pair.xi) - state.angle()) > -slack;
}

std::optional<TipState> go_on(const Tip& tip, const Place& place, const TipState& before,
                              const TipState& guess, const Viscosity& viscosity, int& iterations) {
  // Where the face comes to lie on the surface: where the end that touches would let it through.
  TipState through = before;
  for (const Touch touch : neighbours(tip, before)) {
    const bool same_touch = touch == before.status.touch;
    TipState first = same_touch ? guess : before;
    if (!same_touch && touch != Touch::both && before.status.touch != Touch::face) {
      first = through;
      const double eta = touch == Touch::face    ? deepest(tip, through, place).eta
                         : touch == Touch::front ? tip.radius()
                                                 : -tip.radius();
      first.pair = {tip.point_at(through, eta)[0] - place.travel, eta};
    }
    const Pair start = tip.start_of(before, first.pair, touch);
    for (const int slip : frictions(tip, before.status.slip)) {
      const bool same = same_touch && slip == before.status.slip;
      const auto state =
          tip.solve({touch, slip}, place, same_touch && !same ? before : first, start, viscosity);
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
    const Pair start = tip.start_of(open, {0, eta}, touch);
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
  if (from == to) return result;
  const double finest = tip.surface().finest_length() / tip.length();
  const double samples =
      std::ceil(std::min(most_samples, std::max(2.0, 4 * std::abs(to - from) / finest)));
  for (double i = 1; i <= samples; ++i) {
    const double eta = std::lerp(from, to, i / samples);
    const double depth = -tip.gap(state, place, eta);
    if (depth > result.depth) result = {depth, eta};
  }
  // Between the neighbours of this sample: where the slopes agree.
  const auto is_rising = [&](double eta) {
    return tip.slope_angle(tip.point_at(state, eta)[0] - place.travel) > state.angle();
  };
  const double spacing = std::abs(to - from) / samples;
  double low = std::max(result.eta - spacing, std::min(from, to));
  double high = std::min(result.eta + spacing, std::max(from, to));
  if (!is_rising(low) || is_rising(high)) return result;
  while (high - low > 1e-9 * spacing) {
    const double middle = std::midpoint(low, high);
    (is_rising(middle) ? low : high) = middle;
  }
  const double eta = std::midpoint(low, high);
  const double depth = -tip.gap(state, place, eta);
  return depth > result.depth ? Depth{depth, eta} : result;
}

}  // namespace ciliaval::fem::beam::sweep
