// SPDX-License-Identifier: LGPL-2.1-or-later
#include "analytic/elastica/sweep.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <sstream>
#include <utility>

#include "problem/error.h"

namespace ciliaval::analytic::elastica {
using namespace surroundings;
namespace {

constexpr double longest_step = 2e-3;    ///< of the surface, in L
constexpr double shortest_step = 1e-8;   ///< shorter is a jump
constexpr double feature_steps = 10;     ///< steps on the smallest feature of a surface, at least
constexpr double work_tolerance = 2e-6;  ///< of a step's work, over the elastic energy
constexpr double longest_search = 1e-3;  ///< step of ξ in a jump, in L
constexpr double shortest_search = 1e-7;
constexpr double farthest_jump = 4;        ///< in L
constexpr double cone_slack = 1e-10;       ///< of |T| over μN
constexpr double touch_depth = 1e-8;       ///< of the first contact, in L
constexpr double vanishing_energy = 1e-9;  ///< less is no jump
/// With less the cilium is so straight that its stiffness, which cannot be computed then, is that
/// of a rod that is pushed aside.
constexpr double straight_energy = 1e-6;
constexpr double brush_height = 0.6;  ///< of the tip, bent aside, before it is pressed on, in L

double sign_of(double value) {
  return value < 0 ? -1.0 : 1.0;
}

double on_surface(const TipContact& contact, const SurfacePlace& place) {
  return contact.contact_x - place.travel;
}

/// The tip on its way under the surface.
class Follower {
 public:
  Follower(const TipProblem& problem, const Surface& surface)
      : problem_(problem), surface_(surface) {
    const double feature = surface.finest_length() / problem.length / feature_steps;
    longest_step_ = step_ = std::min(longest_step, feature);
    longest_search_ = std::min(longest_search, feature);
    if (longest_search_ < shortest_search)
      throw InputError("the surface is too fine to be followed: its smallest feature is " +
                       std::to_string(1e6 * surface.finest_length()) + " um long");
  }

  /// From far ahead, where the cilium is bent aside, the tip comes back until the surface, which
  /// slides, holds it.
  SweepSample press(const SurfacePlace& place) {
    now_.place = place;
    TipContact aside;
    constexpr int pulls = 40;
    for (int i = 0; i <= pulls; ++i) {
      const double height = std::lerp(1 - 1e-4, brush_height, static_cast<double>(i) / pulls);
      const auto tip = pulled_aside(problem_, height, i == 0 ? pulled_guess(1 - height) : aside);
      if (!tip) throw SolverError("elastica: the tip cannot be bent aside");
      aside = *tip;
    }
    if (extended_gap(place, aside) < 0)
      throw InputError(
          "the surface is pressed on too far: a cilium bent to 0.6 of its length must "
          "have room under it");
    const Flight flight = fly_back(place, aside);
    if (!flight.met) return now_;
    double friction = 0;
    const auto end =
        flight.contact ? walk(place, *flight.contact, friction) : std::optional<TipContact>{};
    if (!end || !(end->normal_force > 0))
      throw SolverError("elastica: the tip finds no hold under the surface at the beginning");
    set(*end, place, TipState::slip);
    return now_;
  }

  SweepSample go(const SurfacePlace& target) {
    now_.jumps.clear();
    now_.friction_work = now_.surface_work = 0;
    const SurfacePlace start = now_.place;
    const double way =
        std::abs(target.travel - start.travel) + std::abs(target.height - start.height);
    if (way == 0) return now_;
    drag_ = sign_of(target.travel - start.travel);
    double at = 0;
    while (at < 1) {
      double step = step_ / way;
      const double shortest = shortest_step / way;
      while (true) {
        const double next = at + 1.000001 * step >= 1 ? 1 : at + step;
        const bool last_try = step <= shortest;
        if (advance(between(start, target, next), next, last_try)) {
          at = next;
          break;
        }
        if (last_try)
          throw SolverError((std::ostringstream()
                             << "elastica: no equilibrium was found beyond the travel "
                             << now_.place.travel * problem_.length << " m of the surface")
                                .str());
        step = std::max(step / 4, shortest);
      }
      step_ = std::min(2 * step * way, longest_step_);
    }
    return now_;
  }

 private:
  bool advance(const SurfacePlace& place, double at, bool last_try) {
    if (now_.state == TipState::open) return advance_open(place, last_try);
    const double held = on_surface(now_.contact, now_.place);
    const auto stuck = sticking(problem_, surface_, place, held, now_.contact);
    if (stuck && stuck->normal_force > 0 && is_in_cone(*stuck) &&
        (last_try || is_smooth(*stuck, place))) {
      accept(*stuck, place, TipState::stick);
      return true;
    }
    if (advance_sliding(place, stuck, last_try)) return true;
    return last_try && jump(place, at, stuck);
  }

  bool is_in_cone(const TipContact& contact) const {
    return surface_.friction > 0 && std::abs(contact.friction_force) <=
                                        surface_.friction * contact.normal_force + cone_slack;
  }

  bool advance_open(const SurfacePlace& place, bool last_try) {
    const double depth =
        1 - place.height + surface_.at(-place.travel * problem_.length).height / problem_.length;
    if (depth > touch_depth && !last_try) return false;
    if (depth > 0) {
      const auto touched = first_contact(place, depth);
      if (!touched) return false;
      now_.surface_work += touched->energy;
      now_.contact = *touched;
      now_.state = TipState::slip;
    }
    now_.place = place;
    return true;
  }

  static TipContact rest() {
    TipContact straight;
    straight.z = straight.contact_z = 1;
    return straight;
  }

  /// Of a tip that a horizontal force has pulled down by `depth`, by the slender cantilever.
  static TipContact pulled_guess(double depth) {
    TipContact guess = rest();
    guess.x = guess.contact_x = std::sqrt(depth / 0.6);
    guess.force_x = guess.base_moment = 3 * guess.x;
    return guess;
  }

  /// Of a cilium that has just been touched and must give way by `depth`: pushed aside from rest;
  /// pushed down by a flat surface that drags it along (w = μN/3, depth = 0.6 w²), or that buckles
  /// it (depth = π² w²/16).
  std::optional<TipContact> first_contact(const SurfacePlace& place, double depth) const {
    TipContact bent = rest();
    double normal_force = std::numbers::pi * std::numbers::pi / 4;  // that buckles
    if (surface_.friction > 0)
      normal_force = std::min(normal_force, std::sqrt(15 * depth) / surface_.friction);
    bent.force_z = -normal_force;
    bent.force_x = drag_ * surface_.friction * normal_force;
    bent.contact_x = bent.x = drag_ * std::sqrt(depth);
    bent.base_moment = bent.force_x - bent.force_z * bent.x;
    for (const TipContact& guess : {rest(), bent}) {
      const auto contact = sliding(problem_, surface_, place, drag_, guess);
      // Not one that is bent against the travel by a surface that does not push that way.
      if (contact && contact->normal_force > 0 &&
          !(drag_ * contact->x < 0 && drag_ * contact->force_x >= 0))
        return contact;
    }
    return std::nullopt;
  }

  /// How fast the pull on the held tip, beyond what friction bears, grows with ξ: where it grows,
  /// a tip that slides away from its equilibrium comes back.
  double stiffness(const TipContact& contact, double direction) const {
    return contact.friction_slope - direction * surface_.friction * contact.normal_slope;
  }

  /// Whether the works of a step, by the trapezoidal rule, are exact enough.
  bool is_smooth(const TipContact& contact, const SurfacePlace& place) const {
    const double way =
        std::abs(place.travel - now_.place.travel) + std::abs(place.height - now_.place.height);
    return way * (std::abs(contact.force_x - now_.contact.force_x) +
                  std::abs(contact.force_z - now_.contact.force_z)) <=
           work_tolerance * std::max({contact.energy, now_.contact.energy, 1e-3});
  }

  bool advance_sliding(const SurfacePlace& place, const std::optional<TipContact>& stuck,
                       bool last_try) {
    // A nearly straight cilium, which cannot get longer, cannot be held.
    const TipContact& start = stuck ? *stuck : now_.contact;
    const double direction = sign_of(start.friction_force);
    const auto contact = sliding(problem_, surface_, place, direction, start);
    if (!contact || !(contact->normal_force > 0)) return false;
    // No other equilibrium lies between if the stiffness hardly changes on the way.
    const double first = stiffness(start, direction);
    const double last = stiffness(*contact, direction);
    const bool is_straight = std::max(contact->energy, now_.contact.energy) < straight_energy;
    if (!is_straight && !(first > 0 && last > first / 4 && last < 4 * first)) return false;
    const double moved = on_surface(*contact, place) - on_surface(now_.contact, now_.place);
    if (surface_.friction > 0 && moved * direction > 1e-12) return false;
    if (!last_try && !is_smooth(*contact, place)) return false;
    accept(*contact, place, TipState::slip);
    return true;
  }

  /// Height of the surface over the tip, in L.
  double extended_gap(const SurfacePlace& place, const TipContact& tip) const {
    return place.height - tip.z -
           surface_.extended((tip.x - place.travel) * problem_.length).height / problem_.length;
  }

  double search_of(double length) const { return std::min(length, longest_search_); }

  /// What a tip that has lost the surface comes to.
  struct Flight {
    bool met = false;                   ///< the surface, on the way back to the straight cilium
    std::optional<TipContact> contact;  ///< there; empty if it could not be computed
  };

  /// On the way the tip is taken to be held back by a horizontal force, the drag of the air, say.
  Flight fly_back(const SurfacePlace& place, const TipContact& from) const {
    const auto gap_of = [&](const TipContact& tip) { return extended_gap(place, tip); };
    TipContact before = from;
    bool has_left = false;
    double last_gap = -std::numeric_limits<double>::infinity();
    double step = search_of(1e-5);
    for (double height = from.z; height < 1 - 1e-6; step = search_of(1.5 * step)) {
      height = std::min(height + step, 1 - 1e-6);
      const auto tip = pulled_aside(problem_, height, before);
      if (!tip) return {true, {}};
      // At first the surface is still near: its pull was along it, not horizontal.
      const double next_gap = gap_of(*tip);
      if (next_gap < 0 && has_left) return {true, landing(place, before, *tip)};
      if (next_gap < 0 && next_gap <= last_gap) return {true, {}};
      has_left = next_gap >= 0;
      last_gap = next_gap;
      before = *tip;
    }
    return {};
  }

  /// Where the tip meets the surface, between a place under it and one beyond.
  std::optional<TipContact> landing(const SurfacePlace& place, const TipContact& under,
                                    const TipContact& beyond) const {
    double low = under.z;
    double high = beyond.z;
    TipContact tip = under;
    while (high - low > 1e-14) {
      const auto middle = pulled_aside(problem_, std::midpoint(low, high), tip);
      if (!middle) return std::nullopt;
      tip = *middle;
      (extended_gap(place, tip) < 0 ? high : low) = tip.z;
    }
    return sticking(problem_, surface_, place, on_surface(tip, place), tip);
  }

  /// Moves a held tip the way that it is pulled, with friction, until friction alone holds it;
  /// empty if it finds no such place; N = 0 if it has left the surface for the straight cilium.
  std::optional<TipContact> walk(const SurfacePlace& place, TipContact contact,
                                 double& friction) const {
    bool has_landed = false;
    double step = longest_search_;
    for (double moved = 0; moved < farthest_jump;) {
      const double direction = sign_of(contact.friction_force);
      const auto next = sticking(problem_, surface_, place,
                                 on_surface(contact, place) - direction * step, contact);
      if (!next || next->normal_force <= 0) {
        step /= 4;
        if (step > shortest_search) continue;
        const Flight flight = fly_back(place, contact);
        if (!flight.met) return TipContact{};
        if (!flight.contact || has_landed) return std::nullopt;
        has_landed = true;
        contact = *flight.contact;
        step = longest_search_;
        continue;
      }
      if (excess(*next, direction) <= 0) {
        const auto end = hold(place, contact, *next, direction);
        if (end) friction += friction_between(contact, *end);
        return end;
      }
      friction += friction_between(contact, *next);
      contact = *next;
      moved += step;
      step = std::min(2 * step, longest_search_);
    }
    return std::nullopt;
  }

  /// The pull beyond what friction bears.
  double excess(const TipContact& contact, double direction) const {
    return direction * contact.friction_force - surface_.friction * contact.normal_force;
  }

  double friction_between(const TipContact& a, const TipContact& b) const {
    return surface_.friction * (a.normal_force + b.normal_force) / 2 *
           std::hypot(b.contact_x - a.contact_x, b.contact_z - a.contact_z);
  }

  /// Where the excess vanishes between two places of the held tip.
  std::optional<TipContact> hold(const SurfacePlace& place, const TipContact& pulled,
                                 const TipContact& held, double direction) const {
    double a = on_surface(pulled, place);
    double b = on_surface(held, place);
    TipContact contact = held;
    while (std::abs(b - a) > 1e-13) {
      const double middle = std::midpoint(a, b);
      if (middle == a || middle == b) break;
      const auto there = sticking(problem_, surface_, place, middle, contact);
      if (!there) return std::nullopt;
      contact = *there;
      (excess(contact, direction) > 0 ? a : b) = middle;
    }
    return contact;
  }

  bool jump(const SurfacePlace& place, double at, const std::optional<TipContact>& stuck) {
    double friction = 0;
    std::optional<TipContact> end;
    if (stuck && stuck->normal_force > 0) {
      end = walk(place, *stuck, friction);
    } else {
      const Flight flight = fly_back(place, now_.contact);
      if (!flight.met)
        end = TipContact{};
      else if (flight.contact)
        end = walk(place, *flight.contact, friction);
    }
    if (!end) return false;
    const double lost = now_.contact.energy - end->energy - friction;
    if (now_.contact.energy > vanishing_energy) now_.jumps.push_back({at, lost});
    now_.friction_work += friction;
    set(*end, place, end->normal_force > 0 ? TipState::slip : TipState::open);
    return true;
  }

  void set(const TipContact& contact, const SurfacePlace& place, TipState state) {
    now_.contact = contact;
    now_.place = place;
    now_.state = state;
  }

  void accept(const TipContact& contact, const SurfacePlace& place, TipState state) {
    now_.surface_work +=
        (now_.contact.force_x + contact.force_x) / 2 * (place.travel - now_.place.travel) +
        (now_.contact.force_z + contact.force_z) / 2 * (place.height - now_.place.height);
    const double along = on_surface(contact, place) - on_surface(now_.contact, now_.place);
    const double across =
        (contact.contact_z - place.height) - (now_.contact.contact_z - now_.place.height);
    now_.friction_work += std::abs(contact.friction_force + now_.contact.friction_force) / 2 *
                          std::hypot(along, across);
    set(contact, place, state);
  }

  const TipProblem& problem_;
  const Surface& surface_;
  SweepSample now_;
  double longest_step_ = longest_step;
  double longest_search_ = longest_search;
  double step_ = longest_step;
  double drag_ = 1;  ///< way of the surface: +1 forward, −1 back
};

}  // namespace

void sweep(const TipProblem& problem, const Surface& surface,
           const std::vector<SurfacePlace>& places,
           const std::function<void(const SweepSample&)>& each) {
  require_valid(surface);
  if (places.empty()) return;
  Follower tip(problem, surface);
  each(tip.press(places.front()));
  for (std::size_t i = 1; i < places.size(); ++i) each(tip.go(places[i]));
}

std::vector<SweepSample> sweep(const TipProblem& problem, const Surface& surface,
                               const std::vector<SurfacePlace>& places) {
  std::vector<SweepSample> samples;
  sweep(problem, surface, places, [&](const SweepSample& sample) { samples.push_back(sample); });
  return samples;
}

}  // namespace ciliaval::analytic::elastica
