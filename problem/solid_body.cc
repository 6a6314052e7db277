// SPDX-License-Identifier: LGPL-2.1-or-later
#include "problem/solid_body.h"

namespace ciliaval {

SolidPoint evaluate(const LagrangeBasis& nodes, const SolidCell& cell, const Vector3& xi) {
  const std::size_t n = nodes.size();
  const LagrangeValues a(nodes, xi[0]);
  const LagrangeValues b(nodes, xi[1]);
  const LagrangeValues c(nodes, xi[2]);
  SolidPoint point{Vector3::Zero(), Vector3::Zero(), Matrix3::Zero(), Matrix3::Zero()};
  Matrix3 current_gradient = Matrix3::Zero();
  std::size_t node = 0;
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t j = 0; j < n; ++j) {
      for (std::size_t i = 0; i < n; ++i, ++node) {
        const double value = a.value[i] * b.value[j] * c.value[k];
        const Vector3 gradient(a.derivative[i] * b.value[j] * c.value[k],
                               a.value[i] * b.derivative[j] * c.value[k],
                               a.value[i] * b.value[j] * c.derivative[k]);
        point.reference += value * cell.reference[node];
        point.current += value * cell.current[node];
        point.reference_gradient += cell.reference[node] * gradient.transpose();
        current_gradient += cell.current[node] * gradient.transpose();
      }
    }
  }
  point.deformation_gradient = current_gradient * point.reference_gradient.inverse();
  return point;
}

FacePoint evaluate(const LagrangeBasis& nodes, const ChargedFace& face, double xi, double eta) {
  const std::size_t n = nodes.size();
  const LagrangeValues a(nodes, xi);
  const LagrangeValues b(nodes, eta);
  FacePoint point{Vector3::Zero(), Vector3::Zero()};
  Vector3 along_xi = Vector3::Zero();
  Vector3 along_eta = Vector3::Zero();
  std::size_t node = 0;
  for (std::size_t j = 0; j < n; ++j) {
    for (std::size_t i = 0; i < n; ++i, ++node) {
      point.current += a.value[i] * b.value[j] * face.current[node];
      along_xi += a.derivative[i] * b.value[j] * face.reference[node];
      along_eta += a.value[i] * b.derivative[j] * face.reference[node];
    }
  }
  point.reference_area = along_xi.cross(along_eta);
  return point;
}

}  // namespace ciliaval
