// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "fem/solid/contact/rigid_surface.h"
#include "fem/solid/discretisation/space.h"
#include "fem/solid/loads/external_forces.h"
#include "problem/types.h"

namespace ciliaval::fem::solid::contact {

/// A node of the body's surface that may touch.
struct ContactNode {
  std::array<dealii::types::global_dof_index, 3> dofs;
  Vector3 X;  ///< reference position, m

  Vector3 position(const dealii::Vector<double>& displacement) const;
};

/// The nodes of the tip's face and of the last segment's mantle, but for those on the base.
std::vector<ContactNode> contact_nodes(const discretisation::SolidSpace& space);

/// What a node remembers from the last equilibrium.
struct NodeMemory {
  double multiplier = 0;                                ///< λ ≥ 0, N: the normal force there
  Eigen::Vector2d friction = Eigen::Vector2d::Zero();   ///< τ along t and b there, N
  Eigen::Vector2d place = Eigen::Vector2d::Zero();      ///< on the surface, there, m
};

/// Coulomb's friction and the stiffness r of the augmented Lagrangian.
struct ContactLaw {
  double friction = 0;   ///< μ
  double stiffness = 0;  ///< r, N/m
};

/// The force of the surface on a node.
struct NodeForce {
  double normal = 0;                                   ///< N ≥ 0, N
  Eigen::Vector2d friction = Eigen::Vector2d::Zero();  ///< τ along t and b, N
  bool slides = false;                                 ///< |τ| = μN
  Vector3 force = Vector3::Zero();                     ///< N n + τ_t t + τ_b b
  Matrix3 derivative = Matrix3::Zero();                ///< ∂force/∂x, N/m
};

/// The augmented Lagrangian's force (Alart and Curnier, Comput. Methods Appl. Mech. Eng. 92, 353,
/// 1991), with ⟨·⟩ the positive part and ξ the place on the surface:
///
///   N = ⟨λ − r g⟩,   q = τ₀ − r (ξ − ξ₀),   τ = q if |q| ≤ μN (stick), else μN q/|q| (slip).
///
/// With λ = N the node neither penetrates nor lifts off: g = 0. The derivative is unsymmetric where
/// the node slides.
NodeForce node_force(const SurfacePoint& point, const Vector3& direction, const NodeMemory& memory,
                     const ContactLaw& law);

/// The surface's forces on all nodes as external forces. All arguments but the last must outlive
/// them. A node's forces depend on its own position alone.
loads::ExternalForces contact_forces(const std::vector<ContactNode>& nodes,
                                     const std::vector<NodeMemory>& memory,
                                     const RigidSurface& surface, const ContactLaw& law);

/// Of all nodes at a displacement.
std::vector<NodeForce> node_forces(const std::vector<ContactNode>& nodes,
                                   const std::vector<NodeMemory>& memory,
                                   const RigidSurface& surface, const ContactLaw& law,
                                   const dealii::Vector<double>& displacement);

/// What the nodes remember of an equilibrium with these forces.
std::vector<NodeMemory> remembered(const std::vector<ContactNode>& nodes,
                                   const std::vector<NodeForce>& forces,
                                   const RigidSurface& surface,
                                   const dealii::Vector<double>& displacement);

/// The smallest gap of the nodes, m.
double smallest_gap(const std::vector<ContactNode>& nodes, const RigidSurface& surface,
                    const dealii::Vector<double>& displacement);

}  // namespace ciliaval::fem::solid::contact
