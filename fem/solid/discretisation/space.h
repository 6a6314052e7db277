// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/fe/mapping.h>
#include <deal.II/grid/tria.h>
#include <deal.II/lac/affine_constraints.h>

#include <Eigen/Core>
#include <array>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "fem/solid/discretisation/vector.h"
#include "fem/solid/material/hyperelastic.h"
#include "problem/types.h"

namespace ciliaval::fem::solid::discretisation {

/// The element: displacement in Q2, pressure discontinuous and linear in X on each cell (Q2–P1,
/// which satisfies the inf–sup condition) and condensed.
inline constexpr int element_degree = 2;
inline constexpr int element_nodes = 27;  ///< nodes, lexicographic: first local coordinate fastest
inline constexpr int element_dofs = 81;   ///< displacement degrees of freedom, 27·component + node
inline constexpr int element_points = 27;  ///< Gauss points
inline constexpr int element_pressures = 4;

using PressureVector = Eigen::Matrix<double, element_pressures, 1>;
using PressureMatrix = Eigen::Matrix<double, element_pressures, element_pressures>;

using ShapeGradients = Eigen::Matrix<double, element_nodes, 3 * element_points>;
/// ∂N_a/∂ξ_j at Gauss point q: row a, column 3q + j.
const ShapeGradients& unit_gradients();

using ShapeValues = Eigen::Matrix<double, element_nodes, element_points>;
/// N_a at Gauss point q: row a, column q.
const ShapeValues& unit_values();

/// Data of a cell at its Gauss points, in the reference configuration.
struct GaussPoints {
  Eigen::Matrix<double, 3, 3 * element_points>
      inverse_jacobians;                             ///< ∂ξ_j/∂X_J: column 3q + J, 1/m
  Eigen::Matrix<double, element_points, 1> weights;  ///< det(∂X/∂ξ) w_q, m³
  Eigen::Matrix<double, element_pressures, element_points> pressure_values;  ///< ψ_m

  /// ∂N_a/∂X_J at Gauss point q: row a, column 3q + J, 1/m.
  ShapeGradients gradients() const;
};

/// The data of one cell for assembly, computed once in the reference configuration.
struct SolidElement {
  dealii::Triangulation<3>::active_cell_iterator cell;
  std::array<dealii::types::global_dof_index, element_dofs>
      dofs;  ///< the unknowns by this rank's numbers: Vector::local_element()
  material::Hyperelastic material;
  Eigen::Matrix<double, element_nodes, 3> nodes;  ///< X of the nodes, m: row a
  Vector3 centre;                                 ///< origin of the pressure's linear basis, m
  double size = 1;                                ///< its unit of length, m
  PressureMatrix inverse_compliance;              ///< (∫ ψψᵀ/K dV)⁻¹, Pa/m³

  /// Computed from the nodes: kept, they would be three quarters of the element.
  GaussPoints gauss_points() const;
  /// ψ(X) = (1, (X − centre)/size).
  PressureVector pressure_basis(const Vector3& X) const;
};

/// Displacement and pressure of the body, or of a rank's part of it.
struct SolidState {
  Vector displacement;                   ///< nodal values, m
  std::vector<PressureVector> pressure;  ///< coefficients of ψ, one vector for each of the rank's
                                         ///< elements, Pa
};

/// Finite-element space of a hexahedral mesh. The triangulation and the mapping must outlive it.
/// On a triangulation in parts each rank has its own cells and those beside them, and the unknowns
/// of both; on any other one, all.
class SolidSpace {
 public:
  /// The cells with material id i have `materials[i]`. Throws InputError if one is missing.
  SolidSpace(const dealii::Triangulation<3>& triangulation, const dealii::Mapping<3>& mapping,
             std::span<const material::Hyperelastic> materials);

  const dealii::DoFHandler<3>& dof_handler() const { return dof_handler_; }
  const dealii::Mapping<3>& mapping() const { return mapping_; }
  const dealii::FE_Q<3>& scalar_element() const { return scalar_element_; }
  /// The rank's own cells, then those beside them.
  const std::vector<SolidElement>& elements() const { return elements_; }
  std::span<const SolidElement> own_elements() const { return std::span(elements_).first(own_); }
  /// The ranks that share the mesh: this one alone if it is whole.
  MPI_Comm communicator() const { return dof_handler_.get_communicator(); }
  /// Partition of the unknowns: a rank's own ones and, behind them, those that others own.
  const dealii::Utilities::MPI::Partitioner& partitioner() const { return *partitioner_; }
  /// Zeros.
  Vector vector() const { return Vector(partitioner_); }
  /// Lexicographic number of node a of deal.II's FE_Q<3>(2).
  const std::vector<unsigned int>& lexicographic() const { return lexicographic_; }
  /// On all ranks together.
  dealii::types::global_dof_index unknowns() const { return dof_handler_.n_dofs(); }

  /// u = 0, p = 0.
  SolidState undeformed() const;

 private:
  void number_unknowns();
  SolidElement make_element(const dealii::DoFHandler<3>::active_cell_iterator& cell,
                            dealii::FEValues<3>& nodes,
                            std::span<const material::Hyperelastic> materials) const;

  const dealii::Mapping<3>& mapping_;
  dealii::FE_Q<3> scalar_element_;
  dealii::FESystem<3> element_;
  dealii::DoFHandler<3> dof_handler_;
  std::vector<unsigned int> lexicographic_;
  std::shared_ptr<const dealii::Utilities::MPI::Partitioner> partitioner_;
  std::vector<SolidElement> elements_;
  std::size_t own_ = 0;
};

/// Nodal displacements of an element: row a, column component, m. The vector needs the values that
/// other ranks own.
Eigen::Matrix<double, element_nodes, 3> nodal_displacements(const SolidElement& element,
                                                            const Vector& displacement);

/// Displacement prescribed on a part of the boundary.
struct DirichletCondition {
  dealii::types::boundary_id boundary = 0;
  std::array<bool, 3> components{true, true, true};         ///< the prescribed ones
  std::function<Vector3(const Vector3& X)> displacement{};  ///< empty: zero
};

/// Homogeneous constraints of the increments, of all unknowns of the rank. Collective.
dealii::AffineConstraints<double> increment_constraints(
    const SolidSpace& space, std::span<const DirichletCondition> conditions);

/// Writes the prescribed values, times `factor`, into the state's displacement. Collective.
void prescribe(const SolidSpace& space, std::span<const DirichletCondition> conditions,
               SolidState& state, double factor = 1);

}  // namespace ciliaval::fem::solid::discretisation
