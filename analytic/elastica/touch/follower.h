// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <optional>

#include "analytic/elastica/touch/equilibrium.h"

namespace ciliaval::analytic::elastica::touch {

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

  explicit Follower(const Problem& problem);

  const Equilibrium& state() const { return state_; }
  Motion motion() const { return motion_; }
  /// Moves the pin until its displacement, or the force H, is the aim, or it comes to the tip, or,
  /// of a force, to the fold. Throws SolverError if no equilibrium is found next.
  Stop advance(const Condition& aim);

 private:
  /// The equilibrium at another displacement, and how the pin came there.
  struct Next {
    Equilibrium state;
    Motion motion;
  };
  std::optional<Next> at(double displacement) const;
  std::optional<Next> moved(Motion motion, const Condition& second, const Equilibrium& guess) const;
  Condition held_by(Motion motion) const;
  /// The equilibrium between state_ and `next` where a function of it is zero, in the motion of
  /// `next`, or in what motion there is on the way; none if its sign is the same at both.
  template <class Function>
  std::optional<Next> between(const Next& next, const Function& function, bool in_one_motion) const;
  /// The last equilibrium in which the pin sticks before it slides as in `next`, if it does.
  std::optional<Next> edge(const Next& next) const;
  void take(const Next& next);
  /// True if where the pin goes next depends on where it has been.
  bool has_history() const { return !problem_.is_horizontal && problem_.friction_angle > 0; }

  Problem problem_;
  Equilibrium state_;
  Motion motion_ = Motion::up;
  double increment_;
};

/// The largest force that the pin bears when it is pushed forward from the straight cilium, where
/// it bears it, and where it comes to the tip.
struct Limits {
  Equilibrium largest_force;
  bool is_fold = false;  ///< the largest force is a maximum, not that at the tip
  Equilibrium at_tip;
};
Limits limits(const Problem& problem);

}  // namespace ciliaval::analytic::elastica::touch
