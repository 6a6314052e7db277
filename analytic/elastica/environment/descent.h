// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>

#include "analytic/elastica/environment/equilibrium.h"
#include "analytic/elastica/environment/series.h"
#include "problem/error.h"
#include "problem/support/interruption.h"

namespace ciliaval::analytic::elastica::environment {

/// Accuracy of the series.
struct Accuracy {
  double tolerance = 1e-17;
  double fraction = 1;  ///< of the longest step
};

/// Integration from the tip, or from a node, down to the next node and at last to the base. Forces
/// that act at the section of a node count to the part above it.
template <class T>
class Descent {
 public:
  /// At the tip, where M is the couple and w = z = 0.
  Descent(const Rod& rod, const T& tip_angle, const T& force, const T& at, const Accuracy& accuracy)
      : rod_(rod),
        accuracy_(accuracy),
        force_(force),
        at_(at),
        segment_(rod.compliance.size() - 1) {
    state_.S = T(1.0);
    state_.theta = tip_angle;
    state_.moment = T(rod.tip_moment);
    add(rod.at_ends.back());
    if (value_of(at) >= 1) pass();
  }

  /// Goes on with other θ, M and H than it has come to; the other values are constants from here.
  void begin_anew(const T& theta, const T& moment, const T& along) {
    for (T* value : {&state_.S, &state_.w, &state_.z, &state_.vertical})
      *value = T(value_of(*value));
    state_.theta = theta;
    state_.moment = moment;
    state_.along = along;
    at_force_.reset();
  }

  /// Down to S; calls each(step) with every Series. Throws SolverError if the rod coils up.
  template <class Each>
  void to(double S, const Each& each) {
    while (true) {
      const double lower = std::max(rod_.ends[segment_], S);
      if (!is_passed_ && value_of(at_) >= lower) {
        march(at_, each);
        pass();
      }
      march(T(lower), each);
      if (lower == rod_.ends[segment_]) {
        if (segment_ == 0) return;
        add(rod_.at_ends[segment_--]);
      }
      if (lower <= S) return;
    }
  }

  const State<T>& state() const { return state_; }
  /// The section of the point force, if it has been passed since the beginning.
  const std::optional<State<T>>& at_force() const { return at_force_; }
  bool is_passed() const { return is_passed_; }

 private:
  /// Steps in a part of a segment. A rod that stays in equilibrium turns in a part between two
  /// nodes by some radians, in a dozen steps.
  static constexpr int most_steps = 200;

  void add(const PlanarForce& force) {
    state_.along += T(force.along);
    state_.vertical += T(force.vertical);
  }
  void pass() {
    at_force_ = state_;
    state_.along += force_;
    is_passed_ = true;
  }
  template <class Each>
  void march(const T& target, const Each& each) {
    const Forces forces{rod_.compliance[segment_], rod_.per_length[segment_].along,
                        rod_.per_length[segment_].vertical, rod_.per_height};
    for (int k = 0; k < most_steps; ++k) {
      support::check_interruption();
      const Series<T> step(state_, forces, target, accuracy_.tolerance, accuracy_.fraction);
      state_ = step.at_end();
      each(step);
      if (step.complete()) {
        state_.S = target;
        return;
      }
    }
    throw SolverError("elastica: the rod coils up");
  }

  const Rod& rod_;
  Accuracy accuracy_;
  T force_;
  T at_;
  std::size_t segment_;
  State<T> state_;
  bool is_passed_ = false;
  std::optional<State<T>> at_force_;
};

}  // namespace ciliaval::analytic::elastica::environment
