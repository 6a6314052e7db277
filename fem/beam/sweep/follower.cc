// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/beam/sweep/follower.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "fem/beam/sweep/contact_law.h"
#include "problem/error.h"

namespace ciliaval::fem::beam::sweep {
namespace {

using Eigen::Index;

constexpr double longest_step = 2e-3;    ///< of the surface, in L
constexpr double shortest_step = 1e-8;   ///< shorter is a jump
constexpr double feature_steps = 10;     ///< steps on the smallest feature of a surface, at least
constexpr double bracket = 1e-6;         ///< of a change of status, in L
constexpr double touch_depth = 1e-8;     ///< of the first contact, in L
constexpr double largest_turn = 0.05;    ///< of a step, rad
constexpr double work_tolerance = 3e-7;  ///< of the balance of a step, over its works
constexpr double energy_tolerance = 1e-10;  ///< of the same, over the elastic energy
constexpr double small_energy = 1e-3;       ///< floor of the elastic energy there
constexpr double vanishing_loss = 1e-7;     ///< less is no jump
constexpr double straight_energy = 1e-6;    ///< with less, stiffnesses change without bounds
constexpr double brush_height = 0.6;        ///< of the tip, bent aside, before it is pressed on
constexpr double steepest_brush = 2.2;      ///< angle up to which it is bent aside, rad

/// ∫ f dx over a step by the trapezoidal rule with the end correction Δx² (f₀′ − f₁′)/12 that makes
/// it Hermite's, of order 4; at most a quarter of |Δf Δx|, for at a fold slopes say nothing.
double integral(double f0, double f1, double slope0, double slope1, double dx) {
  const double most = std::abs((f1 - f0) * dx) / 4;
  const double correction = (slope0 - slope1) * dx * dx / 12;
  return (f0 + f1) / 2 * dx + (std::isfinite(correction) ? std::clamp(correction, -most, most) : 0);
}

/// Rates of a state along a way of the surface (unit vector in height and travel).
struct Rates {
  Vector2d force;
  double friction_by_slide;  ///< dT/dg
  double slide;              ///< dg

  Rates(const Tip& tip, const TipState& state, const Vector2d& way) {
    const Eigen::VectorXd rates = state.rates * way;
    const Index n = rates.size() - 4;
    force = rates.segment<2>(n);
    const double xi = state.pair.xi;
    const double slope = tip.profile(xi).slope;
    const double q = std::hypot(1, slope);
    slide = q * rates[n + 2] - rates[n + 3];
    const double turning = tip.profile(xi).curvature / (q * q) * rates[n + 2];
    const Vector2d t(1 / q, -slope / q);
    friction_by_slide = (t.dot(force) + state.normal_force * turning) / slide;
  }
};

}  // namespace

Follower::Follower(const Tip& tip, const RelaxationOptions& relaxation)
    : tip_(tip), relaxation_(relaxation) {
  const double feature = tip.surface().finest_length() / tip.length() / feature_steps;
  longest_step_ = step_ = std::min(longest_step, feature);
  if (longest_step_ < 100 * shortest_step)
    throw InputError("the surface is too fine to be followed: its smallest feature is " +
                     std::to_string(1e6 * tip.surface().finest_length()) + " um long");
}

void Follower::require_on_profile() const {
  if (now_.state.status.touch != Touch::none) tip_.surface().at(now_.state.pair.xi * tip_.length());
}

Sample Follower::begin(const Place& place) {
  TipState aside = tip_.straight(place);
  for (double force = 0;; force += 0.02) {
    aside.angles = tip_.beam().pulled_aside(force);
    aside.tip = tip_.beam().respond(aside.angles, aside.force).tip;
    if (std::abs(aside.angle()) > steepest_brush)
      throw InputError(
          "the surface is pressed on too far: a cilium bent to 0.6 of its length must have room "
          "under it");
    if (aside.tip[1] < brush_height && deepest(tip_, aside, place).depth < 0) break;
  }
  const Relaxed relaxed = relax(tip_, aside, place, 1, relaxation_);
  now_ = {};
  now_.state = relaxed.end;
  now_.iterations = relaxed.iterations;
  require_on_profile();
  return now_;
}

Sample Follower::go(const Place& target) {
  now_.jumps.clear();
  now_.friction_work = now_.surface_work = 0;
  now_.iterations = 0;
  const Place start = now_.state.place;
  const double way = std::hypot(target.travel - start.travel, target.height - start.height);
  if (way == 0) return now_;
  if (target.travel != start.travel) drag_ = target.travel < start.travel ? -1 : 1;
  double at = 0;
  while (at < 1) {
    double step = step_;
    while (true) {
      const bool last = at + 1.000001 * step / way >= 1;
      const double next = last ? 1 : at + step / way;
      const double length = last ? (1 - at) * way : step;
      if (advance(last ? target : between(start, target, next), next, length)) {
        at = next;
        break;
      }
      step = std::max(length / 4, shortest_step);
    }
    step_ = std::min(2 * step, longest_step_);
  }
  require_on_profile();
  return now_;
}

TipState Follower::predicted(const Place& place) const {
  TipState guess = now_.state;
  const Vector2d way(place.height - guess.place.height, place.travel - guess.place.travel);
  const Eigen::VectorXd change = guess.rates * way;
  const Index n = guess.angles.size();
  guess.angles += change.head(n);
  if (guess.points.size() == 2) {
    for (Index k = 0; k < 2; ++k) {
      ContactPoint& point = guess.points[static_cast<std::size_t>(k)];
      point.normal_force += change[n + 3 * k];
      point.pair.xi += change[n + 3 * k + 1];
      point.pair.eta += change[n + 3 * k + 2];
    }
    guess.ratio += change[n + 6];
  } else {
    guess.force += change.segment<2>(n);
    guess.pair.xi += change[n + 2];
    guess.pair.eta += change[n + 3];
  }
  return guess;
}

bool Follower::advance(const Place& place, double at, double step) {
  const bool last_try = step <= shortest_step * 1.001;
  if (now_.state.status.touch == Touch::none) {
    const double depth = deepest(tip_, now_.state, place).depth;
    if (depth > touch_depth && !last_try) return false;
    if (depth > 0)
      fall(place, at);
    else
      now_.state.place = place;
    return true;
  }
  const auto next = go_on(tip_, place, now_.state, predicted(place), {}, now_.iterations);
  if (next && is_smooth(*next, step)) {
    accept(*next);
    return true;
  }
  if (last_try) fall(place, at);
  return last_try;
}

bool Follower::is_smooth(const TipState& next, double step) const {
  const TipState& last = now_.state;
  const bool slides = next.status.slip != 0;
  if (slides && !(next.stiffness > 0)) return false;
  const bool is_end = next.status.touch == Touch::rear || next.status.touch == Touch::front;
  if (is_end && !next.is_held_stable) return false;
  if ((next.angles - last.angles).lpNorm<Eigen::Infinity>() > largest_turn) return false;
  if (next.status != last.status && step > bracket) return false;
  // The forces have corners where the slope's curvature jumps; the works do not balance beyond one.
  const Works works = works_until(next);
  if (std::abs(next.energy - last.energy - works.surface + works.friction) >
      work_tolerance * (std::abs(works.surface) + works.friction) +
          energy_tolerance * std::max(next.energy, small_energy))
    return false;
  const bool is_straight = std::max(next.energy, last.energy) < straight_energy;
  return step <= bracket || !slides || is_straight ||
         (next.stiffness > last.stiffness / 4 && next.stiffness < 4 * last.stiffness);
}

Follower::Works Follower::works_until(const TipState& next) const {
  const TipState& last = now_.state;
  const Vector2d way(next.place.height - last.place.height, next.place.travel - last.place.travel);
  const double length = way.norm();
  const Vector2d unit = way / length;
  const Vector2d pull(unit[1], unit[0]);  // along travel and height
  const bool both = last.points.size() + next.points.size() > 2;
  const bool same = next.status == last.status;
  Works works;
  if (both) {
    works.surface = (last.force + next.force).dot(pull) / 2 * length;
    works.friction = tip_.friction_between(last, next);
    return works;
  }
  const Rates r0(tip_, last, unit);
  const Rates r1(tip_, next, unit);
  works.surface = integral(last.force.dot(pull), next.force.dot(pull),
                           same ? r0.force.dot(pull) : 0, same ? r1.force.dot(pull) : 0, length);
  if (next.status.slip == 0 || tip_.friction() == 0) return works;
  const double slide = tip_.slid(next, tip_.start_of(last, next.points.front()));
  const bool along = same && r0.slide * slide > 0 && r1.slide * slide > 0;
  works.friction =
      -integral(last.friction_force, next.friction_force, along ? r0.friction_by_slide : 0,
                along ? r1.friction_by_slide : 0, slide);
  return works;
}

void Follower::accept(const TipState& next) {
  const Works works = works_until(next);
  now_.surface_work += works.surface;
  now_.friction_work += works.friction;
  now_.state = next;
}

void Follower::fall(const Place& place, double at) {
  const TipState before = now_.state;
  const Relaxed relaxed = relax(tip_, before, place, drag_, relaxation_);
  now_.iterations += relaxed.iterations;
  now_.state = relaxed.end;
  now_.friction_work += relaxed.friction;
  const double lost = before.energy - relaxed.end.energy - relaxed.friction;
  if (lost > vanishing_loss)
    now_.jumps.push_back({at, lost, relaxed.dissipation});
  else  // the surface's work over the last step
    now_.surface_work -= lost;
}

}  // namespace ciliaval::fem::beam::sweep
