// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/contact/nodal_contact.h"

#include <deal.II/lac/full_matrix.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "fem/solid/discretisation/extruded_quadrature.h"
#include "meshes/boundary_ids.h"
#include "problem/error.h"

namespace ciliaval::fem::solid::contact {
using namespace discretisation;
namespace {

/// Local coordinates 0, 1, 2 of a lexicographic node.
std::array<unsigned int, 3> indices(unsigned int node) {
  return {node % 3, node / 3 % 3, node / 9};
}

/// True if the node lies on a face of the cell, in deal.II's order: ξ = 0, ξ = 1, η = 0, …
bool is_on_face(unsigned int node, unsigned int face) {
  return indices(node).at(face / 2) == 2 * (face % 2);
}

using dealii::types::global_dof_index;

constexpr double on_base = 1e-6;     ///< Z, in the size of a cell
constexpr double cone_slack = 1e-9;  ///< of |q| over μN

/// Normal force that Newton's method with N as an unknown predicts from the last iterate.
class ExpectedNormal {
 public:
  double move_to(const Vector3& x, const SurfacePoint& point, const NodeMemory& memory,
                 const ContactLaw& law) {
    if (!last_) {
      normal_ = memory.multiplier;
    } else if (x != last_->x) {
      const double gap = last_->gap + last_->gradient.dot(x - last_->x);
      normal_ = std::max(0.0, memory.multiplier - law.stiffness * gap);
    }
    last_ = {x, point.gap, point.gap_gradient};
    return normal_;
  }

 private:
  struct Iterate {
    Vector3 x;
    double gap;
    Vector3 gradient;
  };
  std::optional<Iterate> last_;
  double normal_ = 0;
};

/// Calls visit(element, face) for the faces that may touch.
template <class Visit>
void for_each_face(const SolidSpace& space, const Visit& visit) {
  dealii::types::material_id last = 0;
  for (const SolidElement& element : space.elements())
    last = std::max(last, element.cell->material_id());
  for (const SolidElement& element : space.elements())
    for (const unsigned int face : element.cell->face_indices()) {
      if (!element.cell->at_boundary(face) || element.cell->material_id() != last) continue;
      const auto id = element.cell->face(face)->boundary_id();
      if (id == meshes::tip_id || id == meshes::mantle_id) visit(element, face);
    }
}

void subtract(const ContactNode& node, const Matrix3& derivative, TangentMatrix& tangent) {
  const auto n = static_cast<unsigned int>(node.shares.size());
  dealii::FullMatrix<double> block(3 * n, 3 * n);
  std::vector<global_dof_index> dofs;
  for (unsigned int a = 0; a < n; ++a) {
    dofs.insert(dofs.end(), node.shares[a].dofs.begin(), node.shares[a].dofs.end());
    for (unsigned int b = 0; b < n; ++b)
      for (unsigned int i = 0; i < 3; ++i)
        for (unsigned int j = 0; j < 3; ++j)
          block(3 * a + i, 3 * b + j) =
              -node.shares[a].weight * node.shares[b].weight * derivative(i, j);
  }
  tangent.add(block, dofs);
}

std::array<global_dof_index, 3> dofs_of(const SolidElement& element, unsigned int node) {
  return {element.dofs[node], element.dofs[element_nodes + node],
          element.dofs[2 * element_nodes + node]};
}

}  // namespace

Vector3 ContactNode::position(const Vector& displacement) const {
  Vector3 x = X;
  for (const auto& [dofs, weight] : shares)
    x += weight * Vector3(displacement[dofs[0]], displacement[dofs[1]], displacement[dofs[2]]);
  return x;
}

std::vector<ContactNode> contact_nodes(const SolidSpace& space) {
  std::map<global_dof_index, ContactNode> found;
  for_each_face(space, [&found](const SolidElement& element, unsigned int face) {
    for (unsigned int a = 0; a < element_nodes; ++a) {
      const Vector3 X = element.nodes.row(a).transpose();
      if (!is_on_face(a, face) || X.z() < on_base * element.size) continue;
      found[element.dofs[a]] = {{{dofs_of(element, a), 1}}, X};
    }
  });
  std::vector<ContactNode> nodes;
  for (const auto& [dof, node] : found) nodes.push_back(node);
  return nodes;
}

std::vector<ContactNode> mantle_line(const SolidSpace& space, const Vector3& direction,
                                     double spacing) {
  constexpr double on_line = 1e-6;  // in the size of a cell
  const Vector3 across = Vector3::UnitZ().cross(direction);
  struct Edge {
    const SolidElement* element;
    std::array<unsigned int, 3> nodes;  ///< upwards
  };
  std::map<double, Edge> edges;  // by the height of their middles
  for (const SolidElement& element : space.elements())
    for (const unsigned int face : element.cell->face_indices()) {
      if (!element.cell->at_boundary(face) ||
          element.cell->face(face)->boundary_id() != meshes::mantle_id)
        continue;
      std::vector<unsigned int> on_it;
      for (unsigned int a = 0; a < element_nodes; ++a) {
        const Vector3 X = element.nodes.row(a).transpose();
        if (is_on_face(a, face) && std::abs(X.dot(across)) < on_line * element.size &&
            X.dot(direction) < 0)
          on_it.push_back(a);
      }
      if (on_it.size() != 3) continue;
      const auto height = [&](unsigned int a) { return element.nodes(a, 2); };
      std::ranges::sort(on_it, {}, height);
      edges[height(on_it[1])] = {&element, {on_it[0], on_it[1], on_it[2]}};
    }
  std::vector<ContactNode> points;
  for (const auto& [middle, edge] : edges) {
    const Vector3 low = edge.element->nodes.row(edge.nodes[0]).transpose();
    const Vector3 high = edge.element->nodes.row(edge.nodes[2]).transpose();
    const int parts = static_cast<int>(std::ceil((high - low).norm() / spacing));
    for (int k = 1; k <= parts; ++k) {  // none at the base
      const Eigen::Vector3d weights = quadratic_basis(static_cast<double>(k) / parts);
      ContactNode point{{}, Vector3::Zero()};
      for (Eigen::Index a = 0; a < 3; ++a) {
        const unsigned int node = edge.nodes.at(static_cast<std::size_t>(a));
        point.shares.push_back({dofs_of(*edge.element, node), weights[a]});
        point.X += weights[a] * edge.element->nodes.row(node).transpose();
      }
      points.push_back(std::move(point));
    }
  }
  if (points.empty())
    throw InputError(
        "the pin of the touch comes to where the mesh has no line of nodes along the cilium: take "
        "the built-in mesh, or an azimuth at which it has one");
  return points;
}

std::vector<ContactFace> contact_faces(const SolidSpace& space,
                                       const std::vector<ContactNode>& nodes) {
  std::map<global_dof_index, std::size_t> places;
  for (std::size_t i = 0; i < nodes.size(); ++i) places[nodes[i].shares.front().dofs[0]] = i;
  std::vector<ContactFace> faces;
  for_each_face(space, [&](const SolidElement& element, unsigned int face) {
    std::vector<std::size_t> on_face;
    for (unsigned int a = 0; a < element_nodes; ++a)
      if (const auto place = places.find(element.dofs[a]);
          is_on_face(a, face) && place != places.end())
        on_face.push_back(place->second);
    if (on_face.size() != 9) return;  // on the base
    std::copy_n(on_face.begin(), 9, faces.emplace_back().begin());
  });
  return faces;
}

double penetration_between(const std::vector<ContactNode>& nodes,
                           const std::vector<ContactFace>& faces, const RigidSurface& surface,
                           const Vector& displacement) {
  constexpr int intervals = 5;
  double deepest = 0;
  for (const ContactFace& face : faces)
    for (int i = 0; i <= intervals; ++i)
      for (int j = 0; j <= intervals; ++j) {
        const Eigen::Matrix<double, 9, 1> weights =
            plane_product(quadratic_basis(static_cast<double>(i) / intervals),
                          quadratic_basis(static_cast<double>(j) / intervals));
        Vector3 x = Vector3::Zero();
        for (std::size_t a = 0; a < face.size(); ++a)
          x += weights[static_cast<Eigen::Index>(a)] * nodes[face.at(a)].position(displacement);
        deepest = std::max(deepest, -surface_point(surface, x).gap);
      }
  return deepest;
}

NodeForce node_force(const SurfacePoint& point, const NodeMemory& memory, const ContactLaw& law,
                     double normal) {
  NodeForce result;
  result.gap = point.gap;
  const Eigen::Vector2d q = memory.friction - law.stiffness * (point.place - memory.place);
  result.trial = q;
  if (memory.state == NodeState::free) return result;
  const double N = memory.multiplier - law.stiffness * point.gap;
  result.normal = N;
  const Eigen::RowVector3d dN = -law.stiffness * point.gap_gradient.transpose();
  Eigen::Matrix<double, 2, 3> dq;  // of the trial friction q
  dq << -law.stiffness * point.place_gradient.transpose(),
      -law.stiffness * point.tangents.col(1).transpose();
  const double size = q.norm();
  result.slides = memory.state == NodeState::slip;
  Eigen::Matrix<double, 2, 3> dtau = dq;
  result.friction = q;
  Eigen::Vector2d friction = memory.friction;  // what it is expected to be
  if (result.slides) {
    const bool turns = q.dot(memory.along) > 0;
    const Eigen::Vector2d along = turns ? Eigen::Vector2d(q / size) : memory.along;
    result.friction = law.friction * N * along;
    friction = law.friction * normal * along;
    dtau = law.friction * along * dN;
    if (turns)
      dtau += law.friction * normal / size *
              (Eigen::Matrix2d::Identity() - along * along.transpose()) * dq;
  }
  const Vector3 t = point.tangents.col(0);
  result.force = N * point.normal + point.tangents * result.friction;
  result.derivative = point.normal * dN + point.tangents * dtau +
                      point.curvature * (friction[0] * point.normal - normal * t) *
                          point.place_gradient.transpose();
  return result;
}

bool correct_states(const std::vector<NodeForce>& forces, const ContactLaw& law, double penetration,
                    const std::optional<std::size_t>& led, std::vector<NodeMemory>& memory) {
  double deepest = 0;
  for (std::size_t i = 0; i < memory.size(); ++i)
    if (memory[i].state == NodeState::free) deepest = std::min(deepest, forces[i].gap);
  bool changed = false;
  for (std::size_t i = 0; i < memory.size(); ++i) {
    if (led == i) continue;
    NodeMemory& node = memory[i];
    const NodeForce& force = forces[i];
    const NodeState before = node.state;
    const double size = force.trial.norm();
    if (before == NodeState::free) {
      if (force.gap >= -penetration || force.gap > law.deep * deepest) continue;
      // A node that has not moved on the surface sticks.
      node.state = size > 0 || law.friction == 0 ? NodeState::slip : NodeState::stick;
      if (size > 0) node.along = force.trial / size;
    } else if (!(force.normal > 0)) {
      node.state = NodeState::free;
      node.multiplier = 0;
    } else if (before == NodeState::stick &&
               size > (1 + cone_slack) * law.friction * force.normal) {
      node.state = NodeState::slip;
      node.along = force.trial / size;
    } else if (before == NodeState::slip && law.friction > 0 && force.trial.dot(node.along) < 0) {
      node.state = NodeState::stick;
    }
    changed = changed || node.state != before;
  }
  return changed;
}

std::vector<NodeForce> node_forces(const std::vector<ContactNode>& nodes,
                                   const std::vector<NodeMemory>& memory,
                                   const RigidSurface& surface, const ContactLaw& law,
                                   const Vector& displacement) {
  std::vector<NodeForce> forces;
  forces.reserve(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i)
    forces.push_back(node_force(surface_point(surface, nodes[i].position(displacement)), memory[i],
                                law, memory[i].multiplier));
  return forces;
}

loads::ExternalForces contact_forces(const std::vector<ContactNode>& nodes,
                                     const std::vector<NodeMemory>& memory,
                                     const RigidSurface& surface, const ContactLaw& law) {
  return [&nodes, &memory, surface, law, expected = std::vector<ExpectedNormal>(nodes.size())](
             const Vector& displacement, Vector& forces, TangentMatrix* tangent) mutable {
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const Vector3 x = nodes[i].position(displacement);
      const SurfacePoint point = surface_point(surface, x);
      const double normal = expected[i].move_to(x, point, memory[i], law);
      const NodeForce force = node_force(point, memory[i], law, normal);
      if (memory[i].state == NodeState::free) continue;
      for (const auto& [dofs, weight] : nodes[i].shares)
        for (unsigned int c = 0; c < 3; ++c) forces[dofs[c]] += weight * force.force[c];
      if (tangent != nullptr) subtract(nodes[i], force.derivative, *tangent);
    }
  };
}

std::vector<NodeMemory> remembered(const std::vector<ContactNode>& nodes,
                                   const std::vector<NodeForce>& forces,
                                   const RigidSurface& surface, const Vector& displacement) {
  std::vector<NodeMemory> memory;
  memory.reserve(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const NodeForce& force = forces[i];
    NodeMemory& node = memory.emplace_back();
    node.multiplier = force.normal;
    node.friction = force.friction;
    node.place = surface_point(surface, nodes[i].position(displacement)).place;
    if (force.normal > 0) node.state = force.slides ? NodeState::slip : NodeState::stick;
    if (force.slides && force.trial.norm() > 0) node.along = force.trial.normalized();
  }
  return memory;
}

double smallest_gap(const std::vector<ContactNode>& nodes, const RigidSurface& surface,
                    const Vector& displacement) {
  double smallest = std::numeric_limits<double>::infinity();
  for (const ContactNode& node : nodes)
    smallest = std::min(smallest, surface_point(surface, node.position(displacement)).gap);
  return smallest;
}

}  // namespace ciliaval::fem::solid::contact
