// SPDX-License-Identifier: LGPL-2.1-or-later
#include "problem/solid_body.h"

#include <array>
#include <span>

#include "problem/error.h"

namespace ciliaval {
namespace {

constexpr std::size_t max_nodes = 16;

/// Values and derivatives of the one-dimensional basis at a coordinate, on the stack.
struct Shape {
  std::array<double, max_nodes> value;
  std::array<double, max_nodes> derivative;

  Shape(const LagrangeBasis& basis, double x) : value{}, derivative{} {
    if (basis.size() > max_nodes)
      throw InputError("a solid cell has at most 16 nodes along an edge");
    basis.values_and_derivatives(x, std::span(value).first(basis.size()),
                                 std::span(derivative).first(basis.size()));
  }
};

}  // namespace

SolidPoint evaluate(const LagrangeBasis& nodes, const SolidCell& cell, const Vector3& xi) {
  const std::size_t n = nodes.size();
  const Shape a(nodes, xi[0]);
  const Shape b(nodes, xi[1]);
  const Shape c(nodes, xi[2]);
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
  const Shape a(nodes, xi);
  const Shape b(nodes, eta);
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
