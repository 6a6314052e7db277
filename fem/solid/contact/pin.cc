// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/contact/pin.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ciliaval::fem::solid::contact {
using namespace discretisation;
namespace {

constexpr double just_before = 1e-9;      ///< the first touch, in d
constexpr double longest_way = 0.02;      ///< of the pin at a time, in L
constexpr double shortest_way = 1e-4;     ///< where it slips off, in L
constexpr double force_tolerance = 1e-8;  ///< relative
constexpr int most_trials = 60;           ///< of a place with the force
constexpr double least_part = 1e-3;       ///< of the largest force: of a node that counts

double force_of(const Follower& follower) {
  const Follower& f = follower;
  return f.current().force.dot(f.surface_at(f.current().place).direction);
}

}  // namespace

RigidSurface untouched_pin(const SolidSpace& space, const Load& load) {
  RigidSurface pin;
  pin.pin = load.touch().radius;
  pin.friction = load.touch().friction;
  pin.direction = direction(load);
  pin.height = contact_height(load).value();
  const ContactNode any = mantle_line(space, pin.direction, pin.pin).front();
  pin.travel = any.X.dot(pin.direction) - pin.pin;
  return pin;
}

SweepPlace before_touch(double diameter) {
  return {0, -just_before * diameter, 0};
}

PinContact pin_contact(const Follower& follower) {
  const ContactState& now = follower.current();
  const RigidSurface pin = follower.surface_at(now.place);
  const Vector3& e = pin.direction;
  PinContact contact;
  contact.force = now.force.dot(e);
  contact.probe.vertical_force = -now.force.z();
  contact.probe.displacement = now.place.travel;
  double largest = 0;
  for (const NodeForce& force : now.forces) largest = std::max(largest, force.normal);
  double sum = 0;
  bool sticks = false;
  for (std::size_t i = 0; i < now.forces.size(); ++i) {
    const NodeForce& force = now.forces[i];
    const Vector3 x = follower.nodes()[i].position(now.solid.displacement);
    contact.probe.base_moment +=
        follower.copies() * (x.z() * force.force.dot(e) - x.dot(e) * force.force.z());
    contact.arclength += force.normal * follower.nodes()[i].X.z();
    sum += force.normal;
    sticks = sticks || (force.normal > least_part * largest && !force.slides);
  }
  if (sum > 0) contact.arclength /= sum;
  contact.probe.state = sticks ? ProbeContact::State::stick : ProbeContact::State::slip;
  return contact;
}

PinOutcome move_pin(Follower& follower, const Load& load, double length, const Progress& progress) {
  const bool by_force = load.is<ContactLoad>();
  const double aim = magnitude(load);
  PinOutcome outcome;
  const auto go = [&](double travel) {
    const FollowerOutcome went = follower.go({0, travel, 0}, progress);
    outcome.iterations += went.iterations;
    outcome.message = went.trouble;
    return went.converged;
  };
  const auto place = [&] { return follower.current().place.travel; };
  const auto is_there = [&] {
    return by_force ? std::abs(force_of(follower) - aim) <= force_tolerance * aim : place() == aim;
  };
  const double way = (by_force ? force_of(follower) : place()) > aim ? -1 : 1;
  double step = longest_way * length;
  while (!is_there()) {
    FollowerState before = follower.state();
    const double force_before = force_of(follower);
    const double from = place();
    double to = from + way * step;
    if (!by_force && way * (to - aim) >= -just_before * length) to = aim;
    if (to <= 0) {  // it lets go of the straight body
      to = by_force ? before_touch(length).travel : std::max(to, before_touch(length).travel);
    }
    if (!go(to)) return outcome;
    const double force = force_of(follower);
    const bool is_lost = way > 0 && to > 0 && force <= 0;
    const bool is_beyond_fold = by_force && way > 0 && force < force_before;
    if (is_lost || is_beyond_fold) {
      follower.restore(before);
      outcome.largest_force = std::max(outcome.largest_force, force_before);
      outcome.largest_displacement = from;
      outcome.bracket = to - from;
      step /= 4;
      if (step >= shortest_way * length) continue;
      outcome.status = Status::slipped_off;
      outcome.message = fmt::format(
          "the contact slips off: the largest {} found in an equilibrium is {:.6g} {}",
          by_force ? "force" : "displacement", 1e3 * (by_force ? force_before : from),
          by_force ? fmt::format("mN, at a displacement of the probe of {:.6g} mm", 1e3 * from)
                   : fmt::format("mm, under {:.6g} mN", 1e3 * force_before));
      return outcome;
    }
    if (!by_force || way * (force - aim) < 0) continue;
    // The place with the force, by the Illinois method.
    double a = from;
    double b = to;
    double f_a = force_before - aim;
    double f_b = force - aim;
    for (int trial = 0; !is_there(); ++trial) {
      if (trial == most_trials) {
        outcome.message = "the place at which the pin bears the force was not found";
        return outcome;
      }
      const double c = (a * f_b - b * f_a) / (f_b - f_a);
      follower.restore(before);
      if (!go(c)) return outcome;
      const double f_c = force_of(follower) - aim;
      if (way * f_c < 0) before = follower.state();
      if ((f_c > 0) == (f_b > 0)) {
        f_a /= 2;
      } else {
        a = b;
        f_a = f_b;
      }
      b = c;
      f_b = f_c;
    }
  }
  outcome.status = Status::converged;
  outcome.message.clear();
  return outcome;
}

}  // namespace ciliaval::fem::solid::contact
