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

/// A point of the body's surface that may touch: a node, or a point of a line between nodes.
struct ContactNode {
  struct Share {
    std::array<dealii::types::global_dof_index, 3> dofs;  ///< of a node
    double weight;                                        ///< its shape function at the point
  };
  std::vector<Share> shares;
  Vector3 X;  ///< reference position, m

  Vector3 position(const discretisation::Vector& displacement) const;
};

/// The nodes of the tip's face and of the last segment's mantle, but for those on the base.
std::vector<ContactNode> contact_nodes(const discretisation::SolidSpace& space);

/// Points of the line along the mantle that looks against the direction, from near the base to the
/// tip, so far apart (m) or less. The line must be one of the mesh's; throws InputError else.
std::vector<ContactNode> mantle_line(const discretisation::SolidSpace& space,
                                     const Vector3& direction, double spacing);

/// The faces of these nodes, by the nodes' places in the list, in the order of plane_product().
using ContactFace = std::array<std::size_t, 9>;
std::vector<ContactFace> contact_faces(const discretisation::SolidSpace& space,
                                       const std::vector<ContactNode>& nodes);

enum class NodeState { free, stick, slip };

/// Contact data of a node at the last equilibrium, and its state in the next one as far as it is
/// known.
struct NodeMemory {
  double multiplier = 0;                               ///< λ ≥ 0, N: the normal force there
  Eigen::Vector2d friction = Eigen::Vector2d::Zero();  ///< τ₀ along t and b there, N
  Eigen::Vector2d place = Eigen::Vector2d::Zero();     ///< ξ₀ on the surface, there, m
  NodeState state = NodeState::free;
  Eigen::Vector2d along = Eigen::Vector2d::Zero();  ///< direction of τ if it slips
};

/// Coulomb's friction and the stiffness r of the augmented Lagrangian.
struct ContactLaw {
  double friction = 0;   ///< μ
  double stiffness = 0;  ///< r, N/m
  double deep = 0.3;     ///< part of the largest penetration that makes a node touch
};

/// The force of the surface on a node.
struct NodeForce {
  double gap = 0;                                      ///< g, m
  double normal = 0;                                   ///< N, N
  Eigen::Vector2d friction = Eigen::Vector2d::Zero();  ///< τ along t and b, N
  Eigen::Vector2d trial = Eigen::Vector2d::Zero();     ///< q, the friction of a node that sticks, N
  bool slides = false;                                 ///< |τ| = μN
  Vector3 force = Vector3::Zero();                     ///< N n + τ_t t + τ_b b
  Matrix3 derivative = Matrix3::Zero();                ///< ∂force/∂x, N/m
};

/// The augmented Lagrangian's force (Alart and Curnier, Comput. Methods Appl. Mech. Eng. 92, 353,
/// 1991), with ξ the place on the surface; none of a free node:
///
///   N = λ − r g,   q = τ₀ − r (ξ − ξ₀),   τ = q (stick), τ = μN q/|q| (slip).
///
/// With λ = N the node neither penetrates nor lifts off: g = 0. A node keeps its state while
/// Newton's method iterates, and N may fall below 0: the last node that holds the body would else
/// let it go in a mere trial state. So does the direction of slip turn by less than a right angle.
/// correct_states() comes after. The derivative is unsymmetric where the node slides. In it
/// `normal` stands for N in front of the derivatives of n and t: what the multiplier is expected to
/// be (of the very derivative: N itself).
NodeForce node_force(const SurfacePoint& point, const NodeMemory& memory, const ContactLaw& law,
                     double normal);

/// Frees nodes with N ≤ 0, holds nodes that penetrate by more than `penetration` (m) and by
/// law.deep of the deepest one or more, and lets nodes slip with |q| > μN and stick where they
/// would slip back. All but the node `led`. Returns whether there was anything to correct.
bool correct_states(const std::vector<NodeForce>& forces, const ContactLaw& law, double penetration,
                    const std::optional<std::size_t>& led, std::vector<NodeMemory>& memory);

/// The surface's forces on all nodes as external forces of one solution by Newton's method. Nodes
/// and memory must outlive them. A node's forces depend on its own position alone.
///
/// The tangent is that of Newton's method with N as an unknown of its own: from x_k to x_k+1 it
/// becomes λ − r (g + ∂g/∂x (x_k+1 − x_k)). On a curved surface λ − r g is far from it after a
/// large step, and times the curvature it would be a stiffness much larger than the body's.
loads::ExternalForces contact_forces(const std::vector<ContactNode>& nodes,
                                     const std::vector<NodeMemory>& memory,
                                     const RigidSurface& surface, const ContactLaw& law);

/// Forces of all nodes at a displacement.
std::vector<NodeForce> node_forces(const std::vector<ContactNode>& nodes,
                                   const std::vector<NodeMemory>& memory,
                                   const RigidSurface& surface, const ContactLaw& law,
                                   const discretisation::Vector& displacement);

/// Memory of the nodes after an equilibrium with these forces.
std::vector<NodeMemory> remembered(const std::vector<ContactNode>& nodes,
                                   const std::vector<NodeForce>& forces,
                                   const RigidSurface& surface,
                                   const discretisation::Vector& displacement);

/// The smallest gap of the nodes, m.
double smallest_gap(const std::vector<ContactNode>& nodes, const RigidSurface& surface,
                    const discretisation::Vector& displacement);

/// Largest depth of the faces in the surface, at 6 × 6 points of each, m: 0 or more.
double penetration_between(const std::vector<ContactNode>& nodes,
                           const std::vector<ContactFace>& faces, const RigidSurface& surface,
                           const discretisation::Vector& displacement);

}  // namespace ciliaval::fem::solid::contact
