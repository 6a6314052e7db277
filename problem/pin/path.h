// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "problem/pin/follower.h"

namespace ciliaval::pin {

/// Solves the steps of a path one after the other. Where only the magnitude differs from that of
/// the step before, the pin moves on from there; else it touches the cilium anew, as it does after
/// a slip-off.
class PathSolver {
 public:
  using MakeBody = std::function<std::unique_ptr<Body>(const Load&)>;

  /// `with_range`: whether the largest force of a contact is looked for under each load, as the
  /// largest displacement of a probe always is.
  PathSolver(MakeBody make_body, bool with_range);

  /// Solves step.load; uncertainties are the model's to state. Throws SolverError.
  void solve(MechanicsStep& step);

 private:
  void find_limits(MechanicsStep& step);
  void say_slipped_off(MechanicsStep& step);
  void put_state(MechanicsStep& step);

  MakeBody make_body_;
  bool with_range_;
  Load last_;
  std::unique_ptr<Body> body_;
  std::optional<Follower> follower_;  ///< none: the pin touches anew
  std::optional<Limits> limits_;      ///< largest force and displacement, if looked for
};

}  // namespace ciliaval::pin
