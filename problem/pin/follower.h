// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <optional>

#include "problem/pin/body.h"

namespace ciliaval::pin {

/// Follows the equilibria of a pin that is moved to and fro. The pin slides up the cilium with the
/// friction angle α = arctan μ, down with −α, and sticks at the slip s in between; what it does
/// next depends on where it is.
class Follower {
 public:
  enum class Motion { up, down, stick };
  enum class Stop {
    aim,   ///< it got there
    fold,  ///< H has its maximum
    tip    ///< the contact is at the tip
  };

  /// `body` must outlive it. Throws SolverError.
  explicit Follower(Body& body);

  const Equilibrium& state() const { return state_; }
  Motion motion() const { return motion_; }
  /// Moves the pin until its displacement, or the force H, is as given, or it comes to the tip,
  /// or, of a force, to the fold. A displacement before the first touch leaves the cilium alone.
  /// Throws SolverError if no equilibrium is found next.
  Stop advance(const Condition& given);

 private:
  /// The equilibrium at another displacement, and how the pin came there.
  struct Next {
    Equilibrium state;
    Motion motion;
  };
  /// An increment towards the aim, whose sign is `way`; ends where there is a stop.
  std::optional<Stop> go_on(const Condition& aim, double way);
  std::optional<Next> at(double displacement) const;
  /// True if the pin can have come there so from state_.
  bool is_possible(const Next& next) const;
  std::optional<Next> moved(Motion motion, const Condition& second, const Equilibrium& guess) const;
  Condition held_by(Motion motion) const;
  /// The equilibrium between state_ and `next` where a function of it is zero, in the motion of
  /// `next`, or in what motion there is on the way; none if its sign is the same at both.
  template <class Function>
  std::optional<Next> between(const Next& next, const Function& function, bool in_one_motion,
                              double accuracy) const;
  /// Where a pin that slides as in `next`, or as it has slid so far, turns round on the cilium: s
  /// has an extremum. None if it does not before `next`.
  std::optional<Next> turn(const Next& next, double way) const;
  /// The last equilibrium in which the pin sticks before it slides as in `next`, if it does.
  std::optional<Next> edge(const Next& next) const;
  /// The equilibrium with a force between state_ and `next`, if there is one in that motion.
  std::optional<Next> with_force(const Condition& force, const Next& next) const;
  void take(const Next& next);

  Body& body_;
  Equilibrium untouched_;
  Equilibrium state_;
  Motion motion_;  ///< on the mantle, which rises as the cilium turns, at first down
  double increment_;
  double last_way_ = 1;  ///< of the last increment: 1 forward, -1 back
};

/// The largest force that the pin bears when it is pushed forward from its first touch, where it
/// bears it, and where it comes to the tip.
struct Limits {
  Equilibrium largest_force;
  bool is_fold = false;  ///< the largest force is a maximum, not that at the tip
  Equilibrium at_tip;
};
Limits limits(Body& body);

}  // namespace ciliaval::pin
