// SPDX-License-Identifier: LGPL-2.1-or-later
#include "analytic/elastica/sweep.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <sstream>
#include <utility>

#include "problem/error.h"

namespace ciliaval::analytic::elastica {
using namespace surroundings;
namespace {

constexpr double longest_step = 2e-3;      ///< of the surface, in L
constexpr double shortest_step = 1e-6;     ///< of the way between two places: shorter is a jump
constexpr double work_tolerance = 2e-6;    ///< of a step's work, over the elastic energy
constexpr double search_step = 1e-3;       ///< of ξ in a jump, in L
constexpr double farthest_jump = 4;        ///< in L
constexpr double cone_slack = 1e-10;       ///< of |T| over μN
constexpr double vanishing_energy = 1e-9;  ///< less is no jump
/// With less the cilium is so straight that its stiffness, which cannot be computed then, is that
/// of a rod that is pushed aside.
constexpr double straight_energy = 1e-6;

double sign_of(double value) {
  return value < 0 ? -1.0 : 1.0;
}

double on_surface(const TipContact& contact, const SurfacePlace& place) {
  return contact.contact_x - place.travel;
}

/// Height of the surface over the tip of the straight cilium.
double gap_of_straight(const TipProblem& problem, const Surface& surface,
                       const SurfacePlace& place) {
  return place.height - surface.at(-place.travel * problem.length).height / problem.length - 1;
}

/// The tip on its way under the surface.
class Follower {
 public:
  Follower(const TipProblem& problem, const Surface& surface)
      : problem_(problem), surface_(surface) {}

  /// Down from the straight cilium, while the surface slides and drags the tip along.
  SweepSample press(const SurfacePlace& place) {
    now_.place = place;
    const double depth = -gap_of_straight(problem_, surface_, place);
    if (depth <= 0) return now_;
    double pressed = 0;
    double step = std::min(depth, longest_step / 4);
    while (pressed < depth) {
      const double next = std::min(depth, pressed + step);
      now_.place.height = place.height + depth - next;
      if (slide_on(now_.place, next)) {
        pressed = next;
        step = longest_step;
        continue;
      }
      step /= 4;
      if (step < shortest_step * depth)
        throw SolverError("elastica: the tip cannot be pressed down to the surface's height");
    }
    now_.place = place;
    now_.state = TipState::slip;
    return now_;
  }

  SweepSample go(const SurfacePlace& target) {
    now_.jumps.clear();
    now_.friction_work = now_.surface_work = 0;
    const SurfacePlace start = now_.place;
    const double way =
        std::abs(target.travel - start.travel) + std::abs(target.height - start.height);
    double at = 0;
    while (at < 1) {
      double step = way > 0 ? step_ / way : 1;
      while (true) {
        const double next = at + 1.000001 * step >= 1 ? 1 : at + step;
        const bool last_try = step <= shortest_step;
        if (advance(between(start, target, next), next, last_try)) {
          at = next;
          break;
        }
        if (last_try)
          throw SolverError((std::ostringstream()
                             << "elastica: no equilibrium was found beyond the travel "
                             << now_.place.travel * problem_.length << " m of the surface")
                                .str());
        step = std::max(step / 4, shortest_step);
      }
      step_ = std::min(2 * step * way, longest_step);
    }
    return now_;
  }

 private:
  bool advance(const SurfacePlace& place, double at, bool last_try) {
    if (now_.state == TipState::open) return advance_open(place);
    const double held = on_surface(now_.contact, now_.place);
    const auto stuck = sticking(problem_, surface_, place, held, now_.contact);
    if (stuck && stuck->normal_force > 0 && is_in_cone(*stuck) &&
        (last_try || is_smooth(*stuck, place))) {
      accept(*stuck, place, TipState::stick);
      return true;
    }
    if (advance_sliding(place, stuck, last_try)) return true;
    if (last_try && !(stuck && stuck->normal_force > 0) && spring_back(place, at)) return true;
    return last_try && stuck && jump(place, at, *stuck);
  }

  bool is_in_cone(const TipContact& contact) const {
    return surface_.friction > 0 && std::abs(contact.friction_force) <=
                                        surface_.friction * contact.normal_force + cone_slack;
  }

  bool advance_open(const SurfacePlace& place) {
    const double gap = gap_of_straight(problem_, surface_, place);
    if (gap < 0 && !slide_on(place, -gap)) return false;
    if (gap < 0) now_.state = TipState::slip;
    now_.place = place;
    return true;
  }

  /// The tip under a surface that drags it along, from the present contact or from none.
  bool slide_on(const SurfacePlace& place, double depth) {
    const std::vector<TipContact> guesses =
        now_.contact.normal_force > 0 ? std::vector{now_.contact} : first_guesses(depth);
    for (const TipContact& guess : guesses) {
      const auto contact = sliding(problem_, surface_, place, 1, guess);
      if (!contact || !(contact->normal_force > 0) || is_backwards(*contact, place)) continue;
      now_.contact = *contact;
      return true;
    }
    return false;
  }

  /// Bent against the travel by a surface that does not push that way.
  bool is_backwards(const TipContact& contact, const SurfacePlace& place) const {
    return contact.x < 0 && force(contact, place).first >= 0;
  }

  /// Of a cilium that has just been touched and must give way by `depth`: pushed aside from rest;
  /// pushed down by a flat surface that drags it along (w = μN/3, depth = 0.6 w²), or that buckles
  /// it (depth = π² w²/16).
  std::vector<TipContact> first_guesses(double depth) const {
    TipContact rest;
    rest.z = rest.contact_z = 1;
    TipContact bent = rest;
    const double buckling = std::numbers::pi * std::numbers::pi / 4;
    bent.normal_force = buckling;
    if (surface_.friction > 0)
      bent.normal_force = std::min(buckling, std::sqrt(15 * depth) / surface_.friction);
    bent.friction_force = surface_.friction * bent.normal_force;
    bent.contact_x = bent.x = std::sqrt(depth);
    bent.base_moment = bent.friction_force + bent.normal_force * bent.x;
    return {rest, bent};
  }

  /// How fast the pull on the held tip, beyond what friction bears, grows with ξ: where it grows,
  /// a tip that slides away from its equilibrium comes back.
  double stiffness(const TipContact& contact, double direction) const {
    return contact.friction_slope - direction * surface_.friction * contact.normal_slope;
  }

  /// Whether the works of a step, by the trapezoidal rule, are exact enough.
  bool is_smooth(const TipContact& contact, const SurfacePlace& place) const {
    const auto [x_before, z_before] = force(now_.contact, now_.place);
    const auto [x_after, z_after] = force(contact, place);
    const double way =
        std::abs(place.travel - now_.place.travel) + std::abs(place.height - now_.place.height);
    return way * (std::abs(x_after - x_before) + std::abs(z_after - z_before)) <=
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

  void set(const TipContact& contact, const SurfacePlace& place, TipState state) {
    now_.contact = contact;
    now_.place = place;
    now_.state = state;
  }

  /// The cilium has sprung back to its straight shape, if the surface leaves it room.
  bool spring_back(const SurfacePlace& place, double at) {
    if (gap_of_straight(problem_, surface_, place) < 0) return false;
    if (now_.contact.energy > vanishing_energy) now_.jumps.push_back({at, now_.contact.energy});
    set({}, place, TipState::open);
    return true;
  }

  /// Where a tip that has lost the surface meets it again on its way back; empty where it does not.
  /// On the way it is taken to be held back by a horizontal force, the drag of the air, say.
  std::optional<TipContact> landing(const SurfacePlace& place, const TipContact& from) const {
    const auto gap = [&](const TipContact& contact) {
      return place.height - contact.z -
             surface_.at((contact.x - place.travel) * problem_.length).height / problem_.length;
    };
    TipContact before = from;
    for (double height = from.z; height < 1; height += search_step) {
      const auto tip = pulled_aside(problem_, std::min(height, 1 - search_step / 10), before);
      if (!tip) return std::nullopt;
      if (height > from.z && gap(*tip) < 0) {
        double low = before.z;
        double high = tip->z;
        TipContact middle = before;
        while (high - low > 1e-14) {
          const auto at = pulled_aside(problem_, std::midpoint(low, high), middle);
          if (!at) return std::nullopt;
          middle = *at;
          (gap(middle) < 0 ? high : low) = middle.z;
        }
        return sticking(problem_, surface_, place, on_surface(middle, place), middle);
      }
      before = *tip;
    }
    return std::nullopt;
  }

  /// Moves the held tip the way that it is pulled, until it is in equilibrium.
  bool jump(const SurfacePlace& place, double at, const TipContact& stuck) {
    const double first_energy = now_.contact.energy;
    TipContact contact = stuck;
    double friction = 0;
    bool has_landed = false;
    for (double moved = 0; moved < farthest_jump; moved += search_step) {
      const double direction = sign_of(contact.friction_force);
      const double xi = on_surface(contact, place) - direction * search_step;
      const auto next = sticking(problem_, surface_, place, xi, contact);
      if (!next) return false;
      if (next->normal_force <= 0) {
        if (spring_back(place, at)) return true;
        const auto landed = landing(place, contact);
        if (!landed || std::exchange(has_landed, true)) return false;
        contact = *landed;
        continue;
      }
      friction += surface_.friction * (contact.normal_force + next->normal_force) / 2 *
                  std::hypot(search_step, next->contact_z - contact.contact_z);
      if (direction * next->friction_force <= surface_.friction * next->normal_force) {
        const auto end = sliding(problem_, surface_, place, direction, *next);
        if (!end || !(end->normal_force > 0) ||
            std::abs(on_surface(*end, place) - xi) > 2 * search_step)
          return false;
        now_.jumps.push_back({at, first_energy - end->energy - friction});
        now_.friction_work += friction;
        set(*end, place, TipState::slip);
        return true;
      }
      contact = *next;
    }
    return false;
  }

  /// The force that the surface exerts on the tip.
  std::pair<double, double> force(const TipContact& contact, const SurfacePlace& place) const {
    const double slope = surface_.at(on_surface(contact, place) * problem_.length).slope;
    const double norm = std::hypot(1, slope);
    return {(-slope * contact.normal_force + contact.friction_force) / norm,
            (-contact.normal_force - slope * contact.friction_force) / norm};
  }

  void accept(const TipContact& contact, const SurfacePlace& place, TipState state) {
    const auto [x_before, z_before] = force(now_.contact, now_.place);
    const auto [x_after, z_after] = force(contact, place);
    now_.surface_work += (x_before + x_after) / 2 * (place.travel - now_.place.travel) +
                         (z_before + z_after) / 2 * (place.height - now_.place.height);
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
  double step_ = longest_step;
};

}  // namespace

std::vector<SweepSample> sweep(const TipProblem& problem, const Surface& surface,
                               const std::vector<SurfacePlace>& places) {
  require_valid(surface);
  std::vector<SweepSample> samples;
  if (places.empty()) return samples;
  Follower tip(problem, surface);
  samples.push_back(tip.press(places.front()));
  for (std::size_t i = 1; i < places.size(); ++i) samples.push_back(tip.go(places[i]));
  return samples;
}

}  // namespace ciliaval::analytic::elastica
