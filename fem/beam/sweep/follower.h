// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <optional>
#include <vector>

#include "fem/beam/sweep/relaxation.h"
#include "fem/beam/sweep/tip.h"

namespace ciliaval::fem::beam::sweep {

/// A jump: the branch of equilibria ended, and the tip went on to the next one.
struct Jump {
  double at = 0;           ///< part of the way from the sample before, 0 to 1
  double energy_lost = 0;  ///< E before − E after − friction on the way
  double dissipation = 0;  ///< the same by the viscous work of the damped motion
};

/// The state at one place of the surface.
struct Sample {
  TipState state;
  double friction_work = 0;   ///< since the sample before
  double surface_work = 0;    ///< done by the surface since the sample before
  std::vector<Jump> jumps{};  ///< since the sample before
  int iterations = 0;
};

/// Follows the branch of equilibria under the surface, place by place. At the first place the tip
/// comes back from far ahead, bent aside, until the surface holds it. A step is divided until its
/// status goes on and its works balance with the elastic energy; a change of status is bracketed to
/// 1e-6 lengths. Where none goes on over 1e-8 lengths, damped dynamics leads to the next
/// equilibrium (relaxation.h).
class Follower {
 public:
  explicit Follower(const Tip& tip, const RelaxationOptions& relaxation = {});

  /// Throws SolverError where no equilibrium is found, InputError if the surface presses on too far
  /// to begin, or as Surface::at().
  Sample begin(const Place& place);
  Sample go(const Place& target);

 private:
  /// Over a step, without units.
  struct Works {
    double surface = 0;
    double friction = 0;
  };

  bool advance(const Place& place, double at, double step);
  bool is_smooth(const TipState& next, double step) const;
  void fall(const Place& place, double at);
  void accept(const TipState& next);
  Works works_until(const TipState& next) const;
  /// The state that the rates promise.
  TipState predicted(const Place& place) const;
  /// Throws InputError where the touching point is beyond the ends of a profile.
  void require_on_profile() const;

  const Tip& tip_;
  RelaxationOptions relaxation_;
  double longest_step_;
  double step_;
  int drag_ = 1;  ///< way of the surface: +1 forward, −1 back
  Sample now_;
};

}  // namespace ciliaval::fem::beam::sweep
