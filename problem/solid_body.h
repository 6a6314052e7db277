// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "problem/lagrange.h"
#include "problem/types.h"

namespace ciliaval {

/// One hexahedral cell of a solid body: tensor-product Lagrange nodes, first index fastest, on
/// SolidBody::nodes³. Neighbouring cells repeat their common nodes, so that fields may jump between
/// them.
struct SolidCell {
  std::size_t segment = 0;  ///< index of the cilium's segment
  Vector3 magnetization =
      Vector3::Zero();             ///< M in the reference configuration, A/m, constant in the cell
  std::vector<Vector3> reference;  ///< X, m, one for each node
  std::vector<Vector3> current;    ///< x, m
  std::vector<double> jacobian;    ///< J = det F at the nodes; may be empty when undeformed
  std::vector<Matrix3> cauchy_stress;  ///< σ at the nodes, Pa; may be empty when undeformed
};

/// A quadrilateral face across which the normal component of the reference magnetisation jumps. It
/// carries the reference charge [M·N] dA₀, which a deformation with m = F·M/J carries along
/// unchanged (Piola).
struct ChargedFace {
  Vector3 magnetization_jump = Vector3::Zero();  ///< M inside − M outside, A/m
  std::vector<Vector3> reference;  ///< X at the nodes, on SolidBody::nodes², first index fastest;
                                   ///< ∂X/∂ξ × ∂X/∂η points outwards
  std::vector<Vector3> current;    ///< x at the nodes
};

/// A deformed solid as polynomial patches x(ξ), X(ξ), ξ ∈ [0,1]³, that can be evaluated at any
/// order.
struct SolidBody {
  LagrangeBasis
      nodes;  ///< the one-dimensional nodes on [0, 1], both ends included; (size())³ nodes a cell
  std::vector<SolidCell> cells;
  std::vector<ChargedFace> charged_faces;
};

/// A point of a cell.
struct SolidPoint {
  Vector3 reference;             ///< X, m
  Vector3 current;               ///< x, m
  Matrix3 reference_gradient;    ///< ∂X/∂ξ, m
  Matrix3 deformation_gradient;  ///< F = ∂x/∂X
};
SolidPoint evaluate(const LagrangeBasis& nodes, const SolidCell& cell, const Vector3& xi);

/// A point of a face.
struct FacePoint {
  Vector3 current;         ///< x, m
  Vector3 reference_area;  ///< ∂X/∂ξ × ∂X/∂η = N dA₀/(dξ dη), m²
};
FacePoint evaluate(const LagrangeBasis& nodes, const ChargedFace& face, double xi, double eta);

}  // namespace ciliaval
