// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/discretisation/space.h"

#include <deal.II/base/function.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_renumbering.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/component_mask.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/numerics/vector_tools_boundary.h>

#include <Eigen/LU>
#include <map>
#include <string>
#include <utility>

#include "fem/parallel.h"
#include "problem/error.h"

namespace ciliaval::fem::solid::discretisation {
using namespace material;
namespace {

using dealii::types::global_dof_index;

/// Places of the nodes of an element in the unit cell, lexicographic.
dealii::Quadrature<3> unit_nodes() {
  std::vector<dealii::Point<3>> points;
  for (const double zeta : {0.0, 0.5, 1.0})
    for (const double eta : {0.0, 0.5, 1.0})
      for (const double xi : {0.0, 0.5, 1.0}) points.emplace_back(xi, eta, zeta);
  return dealii::Quadrature<3>(points);
}

/// Calls act(a, q, element, node, point) for each lexicographic node a, which is deal.II's `node`,
/// and each Gauss point q of the unit cell.
void for_nodes_and_points(const auto& act) {
  const dealii::FE_Q<3> element(element_degree);
  const dealii::QGauss<3> gauss(element_degree + 1);
  const std::vector<unsigned int> nodes = element.get_poly_space_numbering_inverse();
  for (unsigned int a = 0; a < element_nodes; ++a)
    for (unsigned int q = 0; q < element_points; ++q) act(a, q, element, nodes[a], gauss.point(q));
}

std::map<global_dof_index, double> boundary_values(const SolidSpace& space,
                                                   const DirichletCondition& condition) {
  dealii::ComponentMask mask(3, false);
  std::vector<std::function<double(const dealii::Point<3>&)>> components;
  for (unsigned int c = 0; c < 3; ++c) {
    mask.set(c, condition.components[c]);
    components.emplace_back([&condition, c](const dealii::Point<3>& X) {
      return condition.displacement ? condition.displacement(Vector3(X[0], X[1], X[2]))[c] : 0.0;
    });
  }
  std::map<global_dof_index, double> values;
  dealii::VectorTools::interpolate_boundary_values(
      space.mapping(), space.dof_handler(), condition.boundary,
      dealii::FunctionFromFunctionObjects<3>(components), values, mask);
  return values;
}

}  // namespace

const ShapeGradients& unit_gradients() {
  static const ShapeGradients result = [] {
    ShapeGradients gradients;
    for_nodes_and_points([&](unsigned int a, unsigned int q, const auto& element, unsigned int node,
                             const dealii::Point<3>& point) {
      for (unsigned int j = 0; j < 3; ++j)
        gradients(a, 3 * q + j) = element.shape_grad(node, point)[j];
    });
    return gradients;
  }();
  return result;
}

const ShapeValues& unit_values() {
  static const ShapeValues result = [] {
    ShapeValues values;
    for_nodes_and_points(
        [&](unsigned int a, unsigned int q, const auto& element, unsigned int node,
            const dealii::Point<3>& point) { values(a, q) = element.shape_value(node, point); });
    return values;
  }();
  return result;
}

ShapeGradients GaussPoints::gradients() const {
  ShapeGradients result;
  for (Eigen::Index q = 0; q < element_points; ++q)
    result.middleCols<3>(3 * q) =
        unit_gradients().middleCols<3>(3 * q).lazyProduct(inverse_jacobians.middleCols<3>(3 * q));
  return result;
}

GaussPoints SolidElement::gauss_points() const {
  static const std::vector<double> unit_weights =
      dealii::QGauss<3>(element_degree + 1).get_weights();
  GaussPoints result;
  // Eigen's blocked product is meant for large matrices and slower here.
  const Eigen::Matrix<double, 3, 3 * element_points> jacobians =
      nodes.transpose().lazyProduct(unit_gradients());  // ∂X/∂ξ
  const Eigen::Matrix<double, 3, element_points> points =
      nodes.transpose().lazyProduct(unit_values());
  for (Eigen::Index q = 0; q < element_points; ++q) {
    const Matrix3 jacobian = jacobians.middleCols<3>(3 * q);
    result.weights[q] = jacobian.determinant() * unit_weights[static_cast<std::size_t>(q)];
    result.inverse_jacobians.middleCols<3>(3 * q) = jacobian.inverse();
    result.pressure_values.col(q) = pressure_basis(points.col(q));
  }
  return result;
}

PressureVector SolidElement::pressure_basis(const Vector3& X) const {
  PressureVector psi;
  psi << 1, (X - centre) / size;
  return psi;
}

SolidSpace::SolidSpace(const dealii::Triangulation<3>& triangulation,
                       const dealii::Mapping<3>& mapping, std::span<const Hyperelastic> materials)
    : mapping_(mapping),
      scalar_element_(element_degree),
      element_(scalar_element_, 3),
      dof_handler_(triangulation) {
  start_mpi();
  number_unknowns();
  const std::vector<unsigned int> inverse = scalar_element_.get_poly_space_numbering_inverse();
  lexicographic_.resize(inverse.size());
  for (unsigned int lex = 0; lex < inverse.size(); ++lex) lexicographic_[inverse[lex]] = lex;

  dealii::FEValues<3> nodes(mapping_, scalar_element_, unit_nodes(),
                            dealii::update_quadrature_points);
  for (const bool own : {true, false}) {
    for (const auto& cell : dof_handler_.active_cell_iterators())
      if (!cell->is_artificial() && cell->is_locally_owned() == own)
        elements_.push_back(make_element(cell, nodes, materials));
    if (own) own_ = elements_.size();
  }
}

void SolidSpace::number_unknowns() {
  dof_handler_.distribute_dofs(element_);
  // From the base to the tip: neighbours are then near one another in memory.
  if (dealii::Utilities::MPI::n_mpi_processes(communicator()) == 1)
    dealii::DoFRenumbering::downstream(dof_handler_, dealii::Tensor<1, 3>({0, 0, 1}));
  dealii::IndexSet relevant;
  dealii::DoFTools::extract_locally_relevant_dofs(dof_handler_, relevant);
  partitioner_ = std::make_shared<const dealii::Utilities::MPI::Partitioner>(
      dof_handler_.locally_owned_dofs(), relevant, communicator());
}

SolidElement SolidSpace::make_element(const dealii::DoFHandler<3>::active_cell_iterator& cell,
                                      dealii::FEValues<3>& nodes,
                                      std::span<const Hyperelastic> materials) const {
  SolidElement element;
  element.cell = cell;
  nodes.reinit(element.cell);
  std::vector<global_dof_index> dofs(element_dofs);
  cell->get_dof_indices(dofs);
  for (unsigned int i = 0; i < element_dofs; ++i) {
    const auto [component, node] = element_.system_to_component_index(i);
    element.dofs[component * element_nodes + lexicographic_[node]] =
        partitioner_->global_to_local(dofs[i]);
  }
  for (unsigned int a = 0; a < element_nodes; ++a)
    for (unsigned int J = 0; J < 3; ++J) element.nodes(a, J) = nodes.quadrature_point(a)[J];
  const dealii::Point<3> centre = cell->center();
  element.centre = Vector3(centre[0], centre[1], centre[2]);
  element.size = cell->diameter();
  const auto id = cell->material_id();
  if (id >= materials.size())
    throw InputError("the mesh has cells of material " + std::to_string(id) + ", but only " +
                     std::to_string(materials.size()) + " materials are given");
  element.material = materials[id];
  const GaussPoints points = element.gauss_points();
  if (!(points.weights.minCoeff() > 0))
    throw InputError("the mesh has a cell whose Jacobian is not positive");
  const PressureMatrix compliance = points.pressure_values * points.weights.asDiagonal() *
                                    points.pressure_values.transpose() /
                                    element.material.bulk_modulus;
  element.inverse_compliance = compliance.inverse();
  return element;
}

SolidState SolidSpace::undeformed() const {
  return {vector(), std::vector<PressureVector>(elements_.size(), PressureVector::Zero())};
}

Eigen::Matrix<double, element_nodes, 3> nodal_displacements(const SolidElement& element,
                                                            const Vector& displacement) {
  Eigen::Matrix<double, element_nodes, 3> u;
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t a = 0; a < element_nodes; ++a)
      u(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(c)) =
          displacement.local_element(element.dofs[c * element_nodes + a]);
  return u;
}

dealii::AffineConstraints<double> increment_constraints(
    const SolidSpace& space, std::span<const DirichletCondition> conditions) {
  // The owners tell which of the others' unknowns are constrained: the cells beside a rank's own
  // end in faces that look like the body's surface.
  Vector is_constrained = space.vector();
  for (const DirichletCondition& condition : conditions)
    for (const auto& [dof, value] : boundary_values(space, condition))
      if (is_constrained.in_local_range(dof)) is_constrained[dof] = 1;
  is_constrained.update_ghost_values();
  dealii::IndexSet relevant = space.partitioner().locally_owned_range();
  relevant.add_indices(space.partitioner().ghost_indices());
  dealii::AffineConstraints<double> constraints(relevant);
  for (const auto dof : relevant)
    if (is_constrained[dof] != 0) constraints.add_line(dof);
  constraints.close();
  return constraints;
}

void prescribe(const SolidSpace& space, std::span<const DirichletCondition> conditions,
               SolidState& state, double factor) {
  for (const DirichletCondition& condition : conditions)
    for (const auto& [dof, value] : boundary_values(space, condition))
      if (state.displacement.in_local_range(dof)) state.displacement[dof] = factor * value;
  state.displacement.update_ghost_values();
}

}  // namespace ciliaval::fem::solid::discretisation
