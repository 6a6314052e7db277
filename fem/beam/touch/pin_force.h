// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "problem/types.h"

namespace ciliaval::fem::beam::touch {

/// A rigid pin that presses on a vertex; how much is of the state (State::pin).
struct Pin {
  std::size_t vertex = 0;
  Vector3 axis = Vector3::UnitY();  ///< a, horizontal and across e
  double mantle = 0;                ///< R, distance of the mantle from the axis, m
};

/// A vector and its derivative by the spatial spin of the section.
struct Turning {
  Vector3 value;
  Matrix3 by_spin;
};

/// The directions of a contact: t = d₃ along the cilium, n = a × t/|a × t| from the pin's axis to
/// the cilium's, and n × t, of the couple that friction makes.
struct Directions {
  Turning n, t, couple;
};
Directions directions(const Pin& pin, const Quaternion& rotation);

/// Force N n + T t and couple −R T n × t about the cilium's axis, of the unknowns (N, T).
struct PinForce {
  Turning force, couple;
  Eigen::Matrix<double, 3, 2> force_by, couple_by;  ///< by (N, T)
};
PinForce pin_force(const Pin& pin, const Quaternion& rotation, const Eigen::Vector2d& unknowns);

}  // namespace ciliaval::fem::beam::touch
