// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/beam/sweep/relaxation.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>

#include "fem/beam/sweep/contact_law.h"
#include "problem/error.h"

namespace ciliaval::fem::beam::sweep {
namespace {

constexpr double first_step = 1e-2;  ///< of time, in τ
constexpr double shortest_time_step = 1e-12;
constexpr double resting_step = 1e2;  ///< such steps with hardly a change end the motion
constexpr double resting_change = 1e-4;
constexpr double no_change = 1e-11;      ///< of a step of any length
constexpr double landing_depth = 1e-3;   ///< of a step that lands, in L
constexpr double straight_angle = 1e-9;  ///< rad
constexpr int most_steps = 20'000;

double change_of(const TipState& a, const TipState& b) {
  const double turned = (a.angles - b.angles).lpNorm<Eigen::Infinity>();
  const bool touches = a.status.touch != Touch::none && a.status.touch == b.status.touch;
  return std::max(
      {turned, touches ? std::abs(a.pair.xi - b.pair.xi) : 0.0, (a.tip - b.tip).norm()});
}

class Motion {
 public:
  Motion(const Tip& tip, const TipState& from, const Place& place, int drag,
         const RelaxationOptions& options)
      : tip_(tip), place_(place), drag_(drag), options_(options) {
    result_.end = from;
    result_.end.place = place;
  }

  Relaxed run() {
    for (int i = 0; i < most_steps; ++i) {
      const Viscosity viscosity{1 / step_, tip_.beam().curvature(result_.end.angles)};
      const auto next = state_after(viscosity);
      const bool found = next && is_minimum(*next);
      const double change = found ? change_of(*next, result_.end) : 0;
      if (!found || change > 1.5 * options_.largest_change) {
        step_ *= found ? std::max(0.1, options_.largest_change / change) : 0.25;
        if (step_ < shortest_time_step) fail("no state of contact is admissible");
        continue;
      }
      accept(*next, viscosity);
      const bool rests = (step_ >= resting_step && change < resting_change) ||
                         (step_ >= first_step && change < no_change);
      if (rests && rest()) return result_;
      step_ *= std::clamp(options_.largest_change / (change + 1e-300), 0.5, 2.0);
    }
    fail("no end after " + std::to_string(most_steps) + " steps of its motion");
  }

 private:
  [[noreturn]] void fail(const std::string& why) const {
    std::ostringstream text;
    text << "beam: the tip finds no equilibrium at the travel " << place_.travel * tip_.length()
         << " m of the surface: " << why;
    throw SolverError(text.str());
  }

  /// A step is a minimum of the energy and its viscous work. Beyond the rate of an instability it
  /// would converge to the unstable equilibrium.
  static bool is_minimum(const TipState& next) {
    if (next.status.touch == Touch::none) return true;
    const bool is_end = next.status.touch == Touch::rear || next.status.touch == Touch::front;
    return (next.status.slip == 0 || next.stiffness > 0) && (!is_end || next.is_held_stable);
  }

  bool is_open() const { return result_.end.status.touch == Touch::none; }

  std::optional<TipState> state_after(const Viscosity& viscosity) {
    if (!is_open()) {
      auto next = go_on(tip_, place_, result_.end, result_.end, viscosity, result_.iterations);
      if (next) return next;
    }
    TipState guess = result_.end;
    guess.force.setZero();
    auto open = tip_.solve({}, place_, guess, {}, viscosity);
    if (!open) return open;
    result_.iterations += open->iterations;
    const Depth depth = deepest(tip_, *open, place_);
    if (depth.depth <= 0) return open;
    if (!is_open() || depth.depth > landing_depth) return std::nullopt;
    return landed(*open, depth, viscosity);
  }

  std::optional<TipState> landed(const TipState& open, const Depth& depth,
                                 const Viscosity& viscosity) {
    const double moved =
        tip_.point_at(open, depth.eta)[0] - tip_.point_at(result_.end, depth.eta)[0];
    const int drag = moved == 0 ? drag_ : (moved < 0 ? 1 : -1);
    auto next = land(tip_, place_, result_.end, open, drag, viscosity, result_.iterations);
    if (next || open.energy > straight_angle) return next;
    // A straight beam that can hardly get shorter gives way to the side, by depth = f²/15.
    TipState bent = open;
    bent.angles = tip_.beam().pulled_aside(drag * std::sqrt(15 * depth.depth));
    bent.tip = tip_.beam().respond(bent.angles, bent.force).tip;
    return land(tip_, place_, result_.end, bent, drag, viscosity, result_.iterations);
  }

  /// The friction's work of a step from one state of contact to the next.
  double friction_work(const TipState& next) const {
    if (next.status.slip == 0 || next.status.touch == Touch::none || is_open()) return 0;
    return tip_.friction_between(result_.end, next);
  }

  void accept(const TipState& next, const Viscosity& viscosity) {
    result_.friction += friction_work(next);
    result_.dissipation += tip_.beam().dissipation(next.angles, viscosity);
    result_.end = next;
  }

  /// From an unstable equilibrium, to which long steps in time converge as well, further than a
  /// step may go back: against the friction, or without friction the way the surface moves.
  void leave(const TipState& unstable) {
    const double side =
        tip_.friction() > 0
            ? -unstable.status.slip * (unstable.sliding_way < 0 ? -1 : 1)
            : drag_ * (unstable.sliding_mode[unstable.sliding_mode.size() - 1] < 0 ? -1 : 1);
    result_.end.angles += 10 * options_.largest_change * side * unstable.sliding_mode;
    step_ = first_step;
  }

  /// True if the state is an equilibrium, which becomes the end of the relaxation.
  bool rest() {
    if (is_open()) {
      const TipState straight = tip_.straight(place_);
      if (deepest(tip_, straight, place_).depth > 0) return false;
      result_.end = straight;
      return true;
    }
    const auto end = go_on(tip_, place_, result_.end, result_.end, {}, result_.iterations);
    if (!end || change_of(*end, result_.end) > options_.largest_change) return false;
    if (end->status.slip != 0 && !(end->stiffness > 0)) {
      leave(*end);
      return false;
    }
    result_.friction += friction_work(*end);
    result_.end = *end;
    return true;
  }

  const Tip& tip_;
  Place place_;
  int drag_;
  RelaxationOptions options_;
  Relaxed result_;
  double step_ = first_step;  ///< of time, in τ
};

}  // namespace

Relaxed relax(const Tip& tip, const TipState& from, const Place& place, int drag,
              const RelaxationOptions& options) {
  return Motion(tip, from, place, drag, options).run();
}

}  // namespace ciliaval::fem::beam::sweep
