// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/contact/nodal_contact.h"

#include <deal.II/lac/full_matrix.h>

#include <algorithm>
#include <limits>
#include <map>

#include "meshes/boundary_ids.h"

namespace ciliaval::fem::solid::contact {
using namespace discretisation;
namespace {

/// Local coordinates 0, 1, 2 of a lexicographic node.
std::array<unsigned int, 3> indices(unsigned int node) {
  return {node % 3, node / 3 % 3, node / 9};
}

/// Whether the node lies on a face of the cell, in deal.II's order: ξ = 0, ξ = 1, η = 0, …
bool is_on_face(unsigned int node, unsigned int face) {
  return indices(node).at(face / 2) == 2 * (face % 2);
}

void subtract(const ContactNode& node, const Matrix3& derivative,
              const dealii::AffineConstraints<double>& constraints,
              dealii::SparseMatrix<double>& matrix) {
  dealii::FullMatrix<double> block(3, 3);
  for (unsigned int i = 0; i < 3; ++i)
    for (unsigned int j = 0; j < 3; ++j) block(i, j) = -derivative(i, j);
  constraints.distribute_local_to_global(
      block, std::vector<dealii::types::global_dof_index>(node.dofs.begin(), node.dofs.end()),
      matrix);
}

}  // namespace

Vector3 ContactNode::position(const dealii::Vector<double>& displacement) const {
  return X + Vector3(displacement[dofs[0]], displacement[dofs[1]], displacement[dofs[2]]);
}

std::vector<ContactNode> contact_nodes(const SolidSpace& space) {
  dealii::types::material_id last = 0;
  double smallest = std::numeric_limits<double>::infinity();
  for (const SolidElement& element : space.elements()) {
    last = std::max(last, element.cell->material_id());
    smallest = std::min(smallest, element.size);
  }
  std::map<dealii::types::global_dof_index, ContactNode> found;
  for (const SolidElement& element : space.elements())
    for (const unsigned int face : element.cell->face_indices()) {
      if (!element.cell->at_boundary(face) || element.cell->material_id() != last) continue;
      const auto id = element.cell->face(face)->boundary_id();
      if (id != meshes::tip_id && id != meshes::mantle_id) continue;
      for (unsigned int a = 0; a < element_nodes; ++a) {
        const Vector3 X = element.nodes.row(a).transpose();
        if (!is_on_face(a, face) || X.z() < 1e-6 * smallest) continue;
        const auto& dofs = element.dofs;
        found[dofs[a]] = {{dofs[a], dofs[element_nodes + a], dofs[2 * element_nodes + a]}, X};
      }
    }
  std::vector<ContactNode> nodes;
  for (const auto& [dof, node] : found) nodes.push_back(node);
  return nodes;
}

NodeForce node_force(const SurfacePoint& point, const Vector3& direction, const NodeMemory& memory,
                     const ContactLaw& law) {
  NodeForce result;
  const double N = memory.multiplier - law.stiffness * point.gap;
  if (!(N > 0)) return result;
  result.normal = N;
  const Eigen::RowVector3d dN = -law.stiffness * point.gap_gradient.transpose();
  Eigen::Matrix<double, 2, 3> dq;  // of the trial friction q
  dq << -law.stiffness * direction.transpose(), -law.stiffness * point.tangents.col(1).transpose();
  const Eigen::Vector2d q = memory.friction - law.stiffness * (point.place - memory.place);
  const double size = q.norm();
  result.slides = size >= law.friction * N;
  Eigen::Matrix<double, 2, 3> dtau = dq;
  result.friction = q;
  if (result.slides) {
    const Eigen::Vector2d along = size > 0 ? Eigen::Vector2d(q / size) : Eigen::Vector2d::Zero();
    result.friction = law.friction * N * along;
    dtau = law.friction * along * dN;
    if (size > 0)
      dtau += law.friction * N / size *
              (Eigen::Matrix2d::Identity() - along * along.transpose()) * dq;
  }
  const Vector3 t = point.tangents.col(0);
  result.force = N * point.normal + point.tangents * result.friction;
  result.derivative = point.normal * dN + point.tangents * dtau +
                      point.curvature * (result.friction[0] * point.normal - N * t) *
                          direction.transpose();
  return result;
}

std::vector<NodeForce> node_forces(const std::vector<ContactNode>& nodes,
                                   const std::vector<NodeMemory>& memory,
                                   const RigidSurface& surface, const ContactLaw& law,
                                   const dealii::Vector<double>& displacement) {
  std::vector<NodeForce> forces;
  forces.reserve(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i)
    forces.push_back(node_force(surface_point(surface, nodes[i].position(displacement)),
                                surface.direction, memory[i], law));
  return forces;
}

loads::ExternalForces contact_forces(const std::vector<ContactNode>& nodes,
                                     const std::vector<NodeMemory>& memory,
                                     const RigidSurface& surface, const ContactLaw& law) {
  return [&nodes, &memory, surface, law](const dealii::Vector<double>& displacement,
                                         dealii::Vector<double>& forces,
                                         const dealii::AffineConstraints<double>& constraints,
                                         dealii::SparseMatrix<double>* matrix) {
    const std::vector<NodeForce> all = node_forces(nodes, memory, surface, law, displacement);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      if (all[i].normal == 0) continue;
      for (unsigned int c = 0; c < 3; ++c) forces[nodes[i].dofs[c]] += all[i].force[c];
      if (matrix != nullptr) subtract(nodes[i], all[i].derivative, constraints, *matrix);
    }
  };
}

std::vector<NodeMemory> remembered(const std::vector<ContactNode>& nodes,
                                   const std::vector<NodeForce>& forces,
                                   const RigidSurface& surface,
                                   const dealii::Vector<double>& displacement) {
  std::vector<NodeMemory> memory;
  memory.reserve(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i)
    memory.push_back({forces[i].normal, forces[i].friction,
                      surface_point(surface, nodes[i].position(displacement)).place});
  return memory;
}

double smallest_gap(const std::vector<ContactNode>& nodes, const RigidSurface& surface,
                    const dealii::Vector<double>& displacement) {
  double smallest = std::numeric_limits<double>::infinity();
  for (const ContactNode& node : nodes)
    smallest =
        std::min(smallest, surface_point(surface, node.position(displacement)).gap);
  return smallest;
}

}  // namespace ciliaval::fem::solid::contact
