// SPDX-License-Identifier: LGPL-2.1-or-later
#include "analytic/elastica/sweep.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <sstream>
#include <utility>

#include "analytic/elastica/outline.h"
#include "analytic/elastica/point_forces/work.h"
#include "problem/error.h"

namespace ciliaval::analytic::elastica {
using namespace surroundings;
namespace {

constexpr double longest_step = 2e-3;    ///< of the surface, in L
constexpr double shortest_step = 1e-8;   ///< shorter is a jump
constexpr double feature_steps = 10;     ///< steps on the smallest feature of a surface, at least
constexpr double work_tolerance = 2e-8;  ///< of the correction of a step's work, over the energy
constexpr double shortest_jump = 1e-6;   ///< a shorter slip in the shortest step is none
constexpr double step_imbalance = 1e-5;  ///< of the works of the shortest step, over the energy
constexpr double longest_search = 1e-3;  ///< step of ξ in a jump, in L
constexpr double shortest_search = 1e-7;
constexpr int most_landings = 50;    ///< in a jump, and as often it may snap through
constexpr double farthest_jump = 4;  ///< in L
/// Steps after which a way is given up: a hundred for each that the longest ones would take, and
/// some for a short way through jumps. Only a tip that gets on by the shortest steps alone comes to
/// them.
constexpr double most_steps = 100;
constexpr double most_steps_anyway = 10000;
constexpr double cone_slack = 1e-10;        ///< of |T| over μN
constexpr double touch_depth = 1e-8;        ///< of the first contact, in L
constexpr int most_changes = 8;             ///< of the touching points at a place
constexpr double most_touch_energy = 0.01;  ///< of a cilium that has just been touched
constexpr double slight_force = 0.01;       ///< far less than buckles
constexpr double vanishing_energy = 1e-9;   ///< less is no jump
/// With less the cilium is so straight that its stiffness, which cannot be computed then, is that
/// of a rod that is pushed aside.
constexpr double straight_energy = 1e-6;
constexpr double brush_height = 0.6;  ///< of the tip, bent aside, before it is pressed on, in L
constexpr double first_pull = 0.02;   ///< by which it is bent aside, in L
constexpr double pull_step = 0.02;
constexpr double leaving_depth = 1e-10;  ///< of a point that has just lost the surface

double sign_of(double value) {
  return value < 0 ? -1.0 : 1.0;
}

/// The tip on its way under the surface.
class Follower {
 public:
  Follower(const TipProblem& problem, const Surface& surface,
           const std::vector<SurfacePlace>& places)
      : problem_(problem), surface_(surface), outline_(problem, surface, places) {
    const double feature = surface.finest_length() / problem.length / feature_steps;
    longest_step_ = step_ = std::min(longest_step, feature);
    longest_search_ = std::min(longest_search, feature);
    if (longest_search_ < shortest_search)
      throw InputError("the surface is too fine to be followed: its smallest feature is " +
                       std::to_string(1e6 * surface.finest_length()) + " um long");
  }

  SweepSample press(const SurfacePlace& place) {
    now_.place = place;
    if (!from_afar(place))
      throw SolverError("elastica: the tip finds no hold under the surface at the beginning");
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
    double steps_left = steps_of(way / longest_step_);
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
        if (last_try || --steps_left < 0)
          throw SolverError(
              (std::ostringstream()
               << "elastica: " << (last_try ? "no equilibrium was found" : "only tiny steps lead")
               << " beyond the travel " << now_.place.travel * problem_.length
               << " m of the surface; take another tip, or the beam")
                  .str());
        step = std::max(step / 4, shortest);
      }
      step_ = std::min(2 * step * way, longest_step_);
    }
    return now_;
  }

 private:
  /// From far ahead, where the cilium is bent aside, the tip comes back until the surface, which
  /// slides, holds it. False if that is not found.
  bool from_afar(const SurfacePlace& place) {
    TipContact aside = pulled_guess(first_pull);
    for (double x = first_pull; aside.z > brush_height; x += pull_step) {
      const auto tip = pulled_aside(problem_, drag_ * x + aside.touches.front().offset, 0, aside);
      if (!tip) throw SolverError("elastica: the tip cannot be bent aside");
      aside = *tip;
    }
    if (outline_.nearest(place, aside).gap < 0)
      throw InputError(
          "the surface is pressed on too far: a cilium bent to 0.6 of its length must "
          "have room under it");
    const Flight flight = fly_back(place, aside);
    if (!flight.met) {
      set({}, place, TipState::open);
      return true;
    }
    double friction = 0;
    const auto end =
        flight.contact ? walk(place, *flight.contact, friction) : std::optional<TipContact>{};
    if (!end) return false;
    const bool holds = end->normal_force > 0;
    set(slipping(*end, place), place, holds ? TipState::slip : TipState::open);
    return true;
  }

  bool advance(const SurfacePlace& place, double at, bool last_try) {
    if (now_.state == TipState::open) return advance_open(place, last_try);
    // A tip that slides goes on sliding, if it does.
    if (now_.state == TipState::slip && !last_try && advance_sliding(place, now_.contact, false))
      return true;
    const auto stuck = stick(place, last_try);
    if (stuck && stuck->normal_force > 0 && is_in_cone(*stuck) &&
        is_continuous(*stuck, place, last_try)) {
      accept(*stuck, place, TipState::stick);
      return true;
    }
    if (advance_sliding(place, stuck ? *stuck : now_.contact, last_try)) return true;
    return last_try && jump(place, at, stuck);
  }

  /// The equilibrium in which the touching points stick. One of two between which the rod bends may
  /// slide, if it would be beyond the cone of friction when it sticks.
  std::optional<TipContact> stick(const SurfacePlace& place, bool last_try) const {
    FrictionLaw law{FrictionLaw::Kind::moved, 0};
    const std::vector<Touch>& touches = now_.contact.touches;
    const bool bends_between =
        touches.size() > 1 && std::ranges::any_of(touches, [](const Touch& touch) {
          return touch.where == TouchPoint::mantle;
        });
    if (bends_between) law.kind = FrictionLaw::Kind::stick;
    auto contact = settle(place, law, now_.contact, last_try);
    if (!contact || !bends_between || contact->touches.size() != touches.size()) return contact;
    const auto beyond = std::ranges::find_if_not(
        contact->touches, [&](const Touch& touch) { return is_in_cone(touch); });
    if (beyond == contact->touches.end()) return contact;
    law.sliding = beyond - contact->touches.begin();
    law.value = sign_of(beyond->friction_force) * surface_.friction;
    auto partly = settle(place, law, *contact, last_try);
    if (!partly || partly->touches.size() != touches.size()) return contact;
    const Touch& sliding = partly->touches[static_cast<std::size_t>(law.sliding)];
    return sliding.slip * law.value <= 1e-12 ? partly : contact;
  }

  /// The equilibrium with its touching points changed until it is admissible; if they may change.
  std::optional<TipContact> settle(const SurfacePlace& place, FrictionLaw law, TipContact guess,
                                   bool may_change) const {
    for (int turn = 0; turn <= most_changes; ++turn) {
      auto contact = solve_contact(problem_, surface_, place, law, guess);
      if (!contact) return std::nullopt;
      std::vector<Touch> changed = outline_.changed(place, *contact);
      if (changed.empty()) return contact;
      if (!may_change) return std::nullopt;
      if (law.kind == FrictionLaw::Kind::moved && changed.size() < contact->touches.size())
        law.value = changed.front().slip;
      if (changed.size() > contact->touches.size()) begin_touch(changed.back(), place);
      guess = std::move(*contact);
      guess.touches = std::move(changed);
    }
    return std::nullopt;
  }

  static void begin_touch(Touch& touch, const SurfacePlace& place) {
    touch.before.on_surface = touch.x - place.travel;
    touch.before.below = touch.z - place.height;
    touch.before.S = touch.S;
    touch.before.offset = touch.offset;
  }

  bool is_in_cone(const Touch& touch) const {
    return surface_.friction > 0 &&
           std::abs(touch.friction_force) <= surface_.friction * touch.normal_force + cone_slack;
  }
  bool is_in_cone(const TipContact& contact) const {
    return std::ranges::all_of(contact.touches,
                               [&](const Touch& touch) { return is_in_cone(touch); });
  }

  bool advance_open(const SurfacePlace& place, bool last_try) {
    const OutlinePoint first = outline_.nearest(place, rest());
    if (first.gap < -touch_depth && !last_try) return false;
    if (first.gap < 0) {
      const auto touched = first_contact(place, first);
      if (!touched) return false;
      now_.surface_work += touched->energy;
      set(*touched, place, TipState::slip);
    }
    now_.place = place;
    return true;
  }

  static TipContact rest() {
    TipContact straight;
    straight.z = straight.contact_z = 1;
    return straight;
  }

  /// Guess of a tip, or of the corner behind, that a horizontal force has pulled aside: a slender
  /// cantilever.
  TipContact pulled_guess(double deflection) const {
    TipContact guess = rest();
    guess.force_x = guess.base_moment = 3 * drag_ * deflection;
    Touch touch;
    touch.where = problem_.rim > 0 ? TouchPoint::rim : TouchPoint::tip;
    touch.side = -drag_;
    touch.offset = touch.side * problem_.rim;
    touch.force_x = guess.force_x;
    guess.touches = {touch};
    return guess;
  }

  /// Guess of a cilium that has just been touched and must give way by `depth`: pushed aside from
  /// rest; pushed down by a flat surface that drags it along (w = μN/3, depth = 0.6 w²), or that
  /// buckles it (depth = π² w²/16).
  std::optional<TipContact> first_contact(const SurfacePlace& place,
                                          const OutlinePoint& first) const {
    const double depth = -first.gap;
    TipContact bent = rest();
    double normal_force = std::numbers::pi * std::numbers::pi / 4;  // that buckles
    if (surface_.friction > 0)
      normal_force = std::min(normal_force, std::sqrt(15 * depth) / surface_.friction);
    bent.force_z = -normal_force;
    bent.force_x = drag_ * surface_.friction * normal_force;
    bent.contact_x = bent.x = drag_ * std::sqrt(depth);
    bent.base_moment = bent.force_x - bent.force_z * bent.x;
    std::vector<Touch> points{first.touch};
    if (problem_.rim > 0)
      for (const double side : {-drag_, 0.0, drag_}) {
        Touch touch = first.touch;
        touch.where = side == 0 ? TouchPoint::face : TouchPoint::rim;
        touch.side = side == 0 ? 1 : side;
        touch.offset = side * problem_.rim;
        points.push_back(touch);
      }
    for (Touch& point : points)
      for (TipContact guess : {rest(), bent}) {
        point.force_x = guess.force_x;
        point.force_z = guess.force_z;
        guess.touches = {point};
        const auto contact =
            settle(place, {FrictionLaw::Kind::slip, drag_ * surface_.friction}, guess, true);
        // Not one that is bent against the travel by a surface that does not push that way, unless
        // its first touch, off the axis, tilts it so.
        if (contact && contact->normal_force > 0 && contact->energy < most_touch_energy &&
            (contact->normal_force < slight_force ||
             !(drag_ * contact->x < 0 && drag_ * contact->force_x >= 0)))
          return contact;
      }
    return std::nullopt;
  }

  /// Growth with ξ of the pull on the held tip, beyond what friction bears: if it is positive, a
  /// tip that slides away from its equilibrium comes back.
  double stiffness(const TipContact& contact, double direction) const {
    return contact.friction_slope - direction * surface_.friction * contact.normal_slope;
  }

  bool has_same_points(const TipContact& contact) const {
    return std::ranges::equal(contact.touches, now_.contact.touches, {}, &Touch::where,
                              &Touch::where);
  }

  /// True if the works of a step are exact enough: the ends' derivatives correct the trapezoidal
  /// rule by less than work_tolerance of the energy.
  bool is_smooth(const TipContact& contact, const SurfacePlace& place) const {
    const point_forces::Work work =
        point_forces::work_between(now_.contact, now_.place, contact, place, surface_.friction);
    return std::abs(work.surface_correction) + std::abs(work.friction_correction) <=
           work_tolerance * std::max({contact.energy, now_.contact.energy, 1e-3});
  }

  /// True if the state follows from the last one: the works of the step balance the change of
  /// energy, and are exact enough, except for the shortest step.
  bool is_continuous(const TipContact& contact, const SurfacePlace& place, bool last_try) const {
    const point_forces::Work work =
        point_forces::work_between(now_.contact, now_.place, contact, place, surface_.friction);
    const double imbalance = work.surface - work.friction - (contact.energy - now_.contact.energy);
    const double size = std::max({contact.energy, now_.contact.energy, 1e-3});
    if (last_try) return std::abs(imbalance) < step_imbalance * size;
    return is_smooth(contact, place) && std::abs(imbalance) < 10 * work_tolerance * size;
  }

  bool advance_sliding(const SurfacePlace& place, const TipContact& start, bool last_try) {
    const double direction = sign_of(start.friction_force);
    const FrictionLaw law{FrictionLaw::Kind::slip, direction * surface_.friction};
    const bool goes_on = &start == &now_.contact;
    auto contact =
        settle(place, law, goes_on ? predicted(now_.contact, now_.place, place) : start, last_try);
    if (!contact || !(contact->normal_force > 0)) return false;
    // No other equilibrium lies between if the stiffness hardly changes on the way.
    const double first = stiffness(start, direction);
    const double last = stiffness(*contact, direction);
    const bool is_straight = std::max(contact->energy, now_.contact.energy) < straight_energy;
    const bool is_similar = first > 0 && last > first / 4 && last < 4 * first;
    // Where the surface's curvature jumps, or the touching points change, so does the stiffness.
    const bool is_close = last_try && std::abs(contact->touches.front().slip) < shortest_jump;
    if (!is_straight && !(last > 0 && (is_similar || is_close))) return false;
    if (surface_.friction > 0 && contact->touches.front().slip * direction > 1e-12) return false;
    if (!is_continuous(*contact, place, last_try)) return false;
    accept(*contact, place, TipState::slip);
    return true;
  }

  /// Steps after which a way of so many of the longest ones is given up.
  static double steps_of(double longest) { return most_steps * longest + most_steps_anyway; }

  double search_of(double length) const { return std::min(length, longest_search_); }

  /// Outcome of a tip's way back after it has lost the surface.
  struct Flight {
    bool met = false;                   ///< the surface, on the way back to the straight cilium
    std::optional<TipContact> contact;  ///< there; empty if it could not be computed
  };

  /// On the way back to the straight cilium the point that touched last is taken to be held by a
  /// force of the direction with which it lost the surface.
  Flight fly_back(const SurfacePlace& place, const TipContact& from) const {
    TipContact before = from;
    Touch& held = before.touches.front();
    if (held.where != TouchPoint::tip) {
      held.where = TouchPoint::rim;
      if (std::abs(held.offset) < problem_.rim) held.side = drag_ > 0 ? -1 : 1;
      held.offset = held.side * problem_.rim;
      held.S = 1;
    }
    held.force_x = from.force_x;
    held.force_z = from.force_z;
    before.touches.resize(1);
    const double inclination = std::atan2(-from.force_z, from.force_x);
    const double rest_x = held.offset;
    const double start_x = from.x + held.offset * std::cos(from.theta);
    const double way = rest_x - start_x;
    bool has_left = false;
    double last_gap = -std::numeric_limits<double>::infinity();
    double step = search_of(1e-5);
    double flown = 0;
    while (flown < std::abs(way) - 1e-4) {
      const double next_flown = std::min(flown + step, std::abs(way) - 1e-4);
      const auto tip =
          pulled_aside(problem_, start_x + std::copysign(next_flown, way), inclination, before);
      if (!tip) return {true, {}};
      // At first the surface is still near.
      const double next_gap = outline_.nearest(place, *tip).gap;
      if (next_gap < 0 && has_left) return {true, landing(place, inclination, before, *tip)};
      if (next_gap < -leaving_depth && next_gap <= last_gap) return {true, {}};
      has_left = next_gap >= 0;
      last_gap = next_gap;
      before = *tip;
      flown = next_flown;
      step = search_of(1.5 * step);
    }
    return {outline_.nearest(place, rest()).gap < 0, {}};
  }

  /// Contact where the outline meets the surface, between a place under it and one beyond.
  std::optional<TipContact> landing(const SurfacePlace& place, double inclination,
                                    const TipContact& under, const TipContact& beyond) const {
    double low = under.touches.front().x;
    double high = beyond.touches.front().x;
    TipContact tip = under;
    OutlinePoint touching = outline_.nearest(place, beyond);
    while (std::abs(high - low) > 1e-12) {
      const double middle = std::midpoint(low, high);
      const auto there = pulled_aside(problem_, middle, inclination, tip);
      if (!there) return std::nullopt;
      tip = *there;
      const OutlinePoint point = outline_.nearest(place, tip);
      if (point.gap < 0) touching = point;
      (point.gap < 0 ? high : low) = middle;
    }
    touching.touch.force_x = tip.force_x;
    touching.touch.force_z = tip.force_z;
    tip.touches = {touching.touch};
    begin_touch(tip.touches.front(), place);
    const FrictionLaw law{FrictionLaw::Kind::place, touching.touch.x - place.travel};
    const auto contact = settle(place, law, tip, true);
    if (!contact) return std::nullopt;
    return anchored(*contact, place);
  }

  /// Moves a held tip the way that it is pulled, with friction, until friction alone holds it;
  /// empty if it finds no such place; N = 0 if it has left the surface for the straight cilium.
  std::optional<TipContact> walk(const SurfacePlace& place, const TipContact& from,
                                 double& friction) const {
    TipContact contact = anchored(from, place);
    int landings = from.normal_force > 0 ? 0 : 1;
    int snaps = 0;
    double step = longest_search_;
    double steps_left = steps_of(farthest_jump / longest_search_);
    for (double moved = 0; moved < farthest_jump && steps_left > 0; --steps_left) {
      const double direction = sign_of(contact.friction_force);
      const auto next = held_after(place, contact, -direction * step, step <= shortest_search);
      // A point that has just landed comes nearer to the surface, not away from it.
      const bool is_landing = next && landings > 0 && contact.normal_force <= 0 &&
                              next->normal_force > contact.normal_force;
      if (!next || (next->normal_force <= 0 && !is_landing)) {
        step /= 4;
        if (step > shortest_search / 4) continue;
        if (const auto snapped = next ? std::nullopt : snap(place, contact, -direction)) {
          if (++snaps > most_landings) return std::nullopt;
          contact = *snapped;
          step = longest_search_;
          continue;
        }
        const Flight flight = fly_back(place, contact);
        if (!flight.met) return TipContact{};
        if (!flight.contact || ++landings > most_landings) return std::nullopt;
        contact = *flight.contact;
        step = longest_search_;
        continue;
      }
      if (excess(*next, direction) <= 0) {
        const auto end = hold(place, contact, -direction * step, direction);
        if (end) friction += friction_between(contact, *end, direction);
        return end;
      }
      friction += friction_between(contact, *next, direction);
      contact = anchored(*next, place);
      moved += step;
      step = std::min(2 * step, longest_search_);
    }
    return std::nullopt;
  }

  /// State of a rod that snaps through while its tip is held; none if its energy would grow.
  std::optional<TipContact> snap(const SurfacePlace& place, const TipContact& from,
                                 double direction) const {
    const auto contact =
        beyond_fold(problem_, surface_, place, from, direction, direction * shortest_search);
    if (!contact || contact->energy > from.energy) return std::nullopt;
    const auto settled =
        settle(place, {FrictionLaw::Kind::moved, direction * shortest_search}, *contact, true);
    if (!settled) return std::nullopt;
    return anchored(*settled, place);
  }

  std::optional<TipContact> held_after(const SurfacePlace& place, const TipContact& from,
                                       double slip, bool may_change) const {
    return settle(place, {FrictionLaw::Kind::moved, slip}, from, may_change);
  }

  /// The pull beyond what friction bears.
  double excess(const TipContact& contact, double direction) const {
    return direction * contact.friction_force - surface_.friction * contact.normal_force;
  }

  double friction_between(const TipContact& a, const TipContact& b, double direction) const {
    double sum = 0;
    for (const Touch& touch : b.touches)
      sum += (touch.before.normal_force + touch.normal_force) / 2 * std::abs(touch.slip);
    if (a.touches.size() == 1 && b.touches.size() == 1) {
      const double slip = b.touches.front().slip;
      sum += slip * slip / 12 * direction * (b.normal_slope - a.normal_slope);
    }
    return surface_.friction * sum;
  }

  /// Held contact at which the excess vanishes within a slip of the held tip.
  std::optional<TipContact> hold(const SurfacePlace& place, const TipContact& pulled, double slip,
                                 double direction) const {
    double a = 0;
    double b = slip;
    std::optional<TipContact> contact;
    TipContact guess = pulled;
    while (std::abs(b - a) > 1e-13) {
      const double middle = std::midpoint(a, b);
      if (middle == a || middle == b) break;
      auto there = held_after(place, guess, middle, true);
      if (!there) return std::nullopt;
      (excess(*there, direction) > 0 ? a : b) = middle;
      guess = *there;
      contact = std::move(there);
    }
    return contact;
  }

  bool jump(const SurfacePlace& place, double at, const std::optional<TipContact>& stuck) {
    double friction = 0;
    std::optional<TipContact> end;
    if (stuck && stuck->normal_force > 0) {
      end = walk(place, *stuck, friction);
    } else if (const auto snapped = stuck ? std::nullopt : snap(now_.place, now_.contact, drag_)) {
      end = walk(place, *snapped, friction);
    } else {
      const Flight flight = fly_back(place, now_.contact);
      if (!flight.met)
        end = TipContact{};
      else if (flight.contact)
        end = walk(place, *flight.contact, friction);
    }
    if (!end) return begin_again(place, at);
    const double lost = now_.contact.energy - end->energy - friction;
    if (std::abs(lost) > vanishing_energy) now_.jumps.push_back({at, lost});
    now_.friction_work += friction;
    set(slipping(*end, place), place, end->normal_force > 0 ? TipState::slip : TipState::open);
    return true;
  }

  /// Where no way to the next equilibrium is found: that which a long sweep in the present
  /// direction leaves.
  bool begin_again(const SurfacePlace& place, double at) {
    const double energy = now_.contact.energy;
    const SweepSample before = now_;
    if (!from_afar(place) || now_.contact.energy > energy) {
      now_ = before;
      return false;
    }
    now_.jumps.push_back({at, energy - now_.contact.energy, false});
    return true;
  }

  /// The state at which a walk has ended, with the derivatives of a tip that slides.
  TipContact slipping(const TipContact& end, const SurfacePlace& place) const {
    if (!(end.normal_force > 0)) return end;
    const double ratio = sign_of(end.friction_force) * surface_.friction;
    const auto contact =
        settle(place, {FrictionLaw::Kind::slip, ratio}, anchored(end, place), false);
    const bool is_same = contact && std::abs(contact->contact_x - end.contact_x) < 1e-9;
    return is_same ? *contact : end;
  }

  void set(const TipContact& contact, const SurfacePlace& place, TipState state) {
    now_.contact = anchored(contact, place);
    now_.place = place;
    now_.state = state;
  }

  void accept(const TipContact& contact, const SurfacePlace& place, TipState state) {
    const point_forces::Work work =
        point_forces::work_between(now_.contact, now_.place, contact, place, surface_.friction);
    now_.surface_work += work.surface;
    now_.friction_work += work.friction;
    if (state == now_.state && has_same_points(contact) && is_smooth(contact, place)) {
      now_.surface_work += work.surface_correction;
      now_.friction_work += work.friction_correction;
    }
    set(contact, place, state);
  }

  const TipProblem& problem_;
  const Surface& surface_;
  Outline outline_;
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
  Follower tip(problem, surface, places);
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
