// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <memory>

#include "analytic/elastica/touch/follower.h"
#include "problem/mechanics_model.h"

namespace ciliaval::analytic::elastica::touch {

/// Solves the steps of a path one after the other. Where only the magnitude differs from that of
/// the step before, the pin moves on from there; else it touches the straight cilium anew, as it
/// does after a slip-off.
class PathSolver {
 public:
  /// `with_range`: whether the largest force of a contact is looked for under each load.
  PathSolver(const Cilium& cilium, double tolerance, bool with_range);

  /// Solves step.load. Throws SolverError.
  void solve(MechanicsStep& step);

 private:
  bool goes_on(const Load& load) const;
  void start(const Load& load);
  void find_limits(MechanicsStep& step);
  void say_slipped_off(MechanicsStep& step) const;
  void put_state(MechanicsStep& step) const;

  const Cilium& cilium_;
  double tolerance_;
  bool with_range_;
  double force_unit_ = 0;  ///< B/L², N
  Load last_;
  Problem problem_;
  std::optional<Follower> follower_;  ///< none: the pin touches anew
  std::optional<Limits> limits_;      ///< largest force and displacement, if looked for
};

}  // namespace ciliaval::analytic::elastica::touch
