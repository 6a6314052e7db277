// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

namespace ciliaval {

/// How a probe touches the cilium: a rigid pin, its axis horizontal across e and its centre at the
/// load's height. The default is the paper's force, horizontal and on the axis
/// (docs/theory/touch.md).
struct TouchLaw {
  enum class Law {
    horizontal,  ///< the force stays along e, whatever the friction that this takes
    coulomb  ///< friction |T| ≤ μN along the cilium, N across it; T is opposed to the sliding
  };
  enum class At {
    axis,   ///< on the centreline, as if the cilium had no thickness
    mantle  ///< on the side from which the probe comes
  };
  Law law = Law::horizontal;
  double friction = 0;  ///< μ
  At at = At::axis;
  double radius = 0;  ///< of the pin, m; 0: a knife edge

  bool operator==(const TouchLaw&) const = default;
  bool is_plain() const { return *this == TouchLaw{}; }
};

/// A touch has these numbers besides the horizontal force.
struct ProbeContact {
  enum class State { stick, slip };
  double vertical_force = 0;  ///< V on the cilium, downwards, N
  double base_moment = 0;     ///< about the axis across e, positive where it bends towards e, N·m
  double displacement = 0;    ///< of the probe along e since it first touched, m
  State state = State::slip;
};

}  // namespace ciliaval
