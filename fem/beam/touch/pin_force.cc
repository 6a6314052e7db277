// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/beam/touch/pin_force.h"

#include <Eigen/Geometry>

namespace ciliaval::fem::beam::touch {
namespace {

/// v × as a matrix.
Matrix3 cross(const Vector3& v) {
  Matrix3 matrix;
  matrix << 0, -v[2], v[1], v[2], 0, -v[0], -v[1], v[0], 0;
  return matrix;
}

}  // namespace

Directions directions(const Pin& pin, const Quaternion& rotation) {
  Directions d;
  d.t.value = rotation * Vector3::UnitZ();
  d.t.by_spin = -cross(d.t.value);
  const Vector3 across = pin.axis.cross(d.t.value);
  d.n.value = across.normalized();
  d.n.by_spin = (Matrix3::Identity() - d.n.value * d.n.value.transpose()) / across.norm() *
                cross(pin.axis) * d.t.by_spin;
  d.couple.value = d.n.value.cross(d.t.value);
  d.couple.by_spin = cross(d.n.value) * d.t.by_spin - cross(d.t.value) * d.n.by_spin;
  return d;
}

PinForce pin_force(const Pin& pin, const Quaternion& rotation, const Eigen::Vector2d& unknowns) {
  const Directions d = directions(pin, rotation);
  PinForce result;
  const double N = unknowns[0];
  const double T = unknowns[1];
  result.force = {N * d.n.value + T * d.t.value, N * d.n.by_spin + T * d.t.by_spin};
  result.couple = {-pin.mantle * T * d.couple.value, -pin.mantle * T * d.couple.by_spin};
  result.force_by << d.n.value, d.t.value;
  result.couple_by << Vector3::Zero(), -pin.mantle * d.couple.value;
  return result;
}

}  // namespace ciliaval::fem::beam::touch
