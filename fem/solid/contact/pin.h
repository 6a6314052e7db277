// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include "fem/solid/contact/follower.h"
#include "problem/load.h"
#include "problem/mechanics_model.h"

namespace ciliaval::fem::solid::contact {

/// The pin of the load's touch where it just touches the undeformed body; the load's azimuth is
/// from the mesh's x axis.
RigidSurface untouched_pin(const discretisation::SolidSpace& space, const Load& load);

/// The place of a pin that has not touched yet.
SweepPlace before_touch(double diameter);

/// The pin acts so on the body. `displacement` is since it first touched.
struct PinContact {
  double force = 0;      ///< H along e, N
  double arclength = 0;  ///< S of the centre of pressure, m
  ProbeContact probe{};
};
PinContact pin_contact(const Follower& follower);

/// Outcome of the way to a displacement or a force.
struct PinOutcome {
  Status status = Status::failed;
  std::string message;
  int iterations = 0;
  // If the contact slips off:
  double largest_force = 0;         ///< that was borne, N
  double largest_displacement = 0;  ///< with which the body was touched, m
  double bracket = 0;               ///< of the pin's way, m
};

/// Moves the pin to the displacement (m) of a probe or until it bears the force (N) of a contact.
/// It slips off where it touches nothing any more, or where the force falls before it is reached;
/// that place is bracketed.
PinOutcome move_pin(Follower& follower, const Load& load, double length, const Progress& progress);

}  // namespace ciliaval::fem::solid::contact
