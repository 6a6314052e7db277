// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/discretisation/assembly.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/work_stream.h>

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <numeric>

#include "problem/error.h"
#include "problem/support/interruption.h"

namespace ciliaval::fem::solid::discretisation {
using namespace material;
namespace {

using ElementVector = Eigen::Matrix<double, element_dofs, 1>;
using NodalVectors = Eigen::Matrix<double, element_nodes, 3>;

/// One element's share, from the parallel worker to the serial copier.
struct ForceShare {
  std::size_t index = 0;
  bool admissible = true;
  ElementVector forces = ElementVector::Zero();
  ElementVector condensed = ElementVector::Zero();
};

struct StiffnessShare {
  dealii::FullMatrix<double> matrix = dealii::FullMatrix<double>(element_dofs, element_dofs);
  std::size_t index = 0;
};

struct NoScratch {};

/// F = 1 + Σ u_a ⊗ ∂N_a/∂X at all Gauss points: columns 3q + J.
Eigen::Matrix<double, 3, 3 * element_points> deformation_gradients(const SolidElement& element,
                                                                   const GaussPoints& points,
                                                                   const Vector& displacement) {
  const NodalVectors u = nodal_displacements(element, displacement);
  Eigen::Matrix<double, 3, 3 * element_points> F;
  // Eigen's blocked product is meant for large matrices and slower here.
  F = u.transpose().lazyProduct(unit_gradients());
  for (Eigen::Index q = 0; q < element_points; ++q) {
    const Matrix3 by_unit = F.middleCols<3>(3 * q);
    F.middleCols<3>(3 * q).noalias() =
        by_unit.lazyProduct(points.inverse_jacobians.middleCols<3>(3 * q));
    F.middleCols<3>(3 * q) += Matrix3::Identity();
  }
  return F;
}

/// Fluxes by ξ from fluxes by X, row 3q + J.
template <int columns>
Eigen::Matrix<double, 3 * element_points, columns> to_unit_cell(
    const GaussPoints& points, Eigen::Matrix<double, 3 * element_points, columns> fluxes) {
  for (Eigen::Index q = 0; q < element_points; ++q) {
    const Eigen::Matrix<double, 3, columns> by_X = fluxes.template middleRows<3>(3 * q);
    fluxes.template middleRows<3>(3 * q).noalias() =
        points.inverse_jacobians.middleCols<3>(3 * q).lazyProduct(by_X);
  }
  return fluxes;
}

/// J F⁻ᵀ.
Matrix3 cofactor(const Matrix3& F) {
  Matrix3 result;
  result.row(0) = F.row(1).cross(F.row(2));
  result.row(1) = F.row(2).cross(F.row(0));
  result.row(2) = F.row(0).cross(F.row(1));
  return result;
}

/// Internal forces and pressure equation of an element. One product with the shape functions'
/// gradients serves both: column c of `fluxes` holds w P_cJ at row 3q + J, and column 3 + 4c + m
/// holds w ψ_m J F⁻ᵀ_cJ.
void force_share(const SolidElement& element, const SolidState& state, std::size_t index,
                 ForceShare& share, PressureEquation& equation) {
  const GaussPoints points = element.gauss_points();
  const auto F_all = deformation_gradients(element, points, state.displacement);
  const PressureVector& pressure = state.pressure[index];
  PressureVector residual = PressureVector::Zero();
  Eigen::Matrix<double, 3 * element_points, 3 + 3 * element_pressures> fluxes;
  share.index = index;
  share.admissible = false;
  for (Eigen::Index q = 0; q < element_points; ++q) {
    const Matrix3 F = F_all.middleCols<3>(3 * q);
    const Matrix3 cof = cofactor(F);
    const double J = F.row(0).dot(cof.row(0));
    if (!(J > 0)) return;
    const double weight = points.weights[q];
    const PressureVector psi = points.pressure_values.col(q);
    const double p = psi.dot(pressure);
    residual += weight * (J - 1 - p / element.material.bulk_modulus) * psi;
    fluxes.block<3, 3>(3 * q, 0) = weight * first_piola_stress(element.material, F, p).transpose();
    for (Eigen::Index c = 0; c < 3; ++c)
      fluxes.block<3, element_pressures>(3 * q, 3 + element_pressures * c) =
          (weight * cof.row(c)).transpose() * psi.transpose();
  }
  share.admissible = true;
  Eigen::Matrix<double, element_nodes, 3 + 3 * element_pressures> sums;
  sums.noalias() = unit_gradients() * to_unit_cell(points, fluxes);
  share.forces = sums.leftCols<3>().reshaped();
  for (Eigen::Index c = 0; c < 3; ++c)
    equation.gradient.middleCols<element_nodes>(c * element_nodes) =
        sums.middleCols<element_pressures>(3 + element_pressures * c).transpose();
  equation.correction = element.inverse_compliance * residual;
  share.condensed = share.forces;
  share.condensed.noalias() += equation.gradient.transpose() * equation.correction;
}

}  // namespace

void element_stiffness(const SolidElement& element, const SolidState& state, std::size_t index,
                       const PressureEquation& equation, dealii::FullMatrix<double>& matrix) {
  using Block = Eigen::Matrix<double, element_nodes, element_nodes>;
  const GaussPoints points = element.gauss_points();
  const auto F = deformation_gradients(element, points, state.displacement);
  const ShapeGradients gradients = points.gradients();
  std::array<StressTangent, element_points> tangents;
  for (Eigen::Index q = 0; q < element_points; ++q) {
    const double p = points.pressure_values.col(q).dot(state.pressure[index]);
    tangents[static_cast<std::size_t>(q)] =
        points.weights[q] * stress_tangent(element.material, F.middleCols<3>(3 * q), p);
  }
  const Eigen::Matrix<double, element_pressures, element_dofs> pressure =
      element.inverse_compliance * equation.gradient;
  Eigen::Map<Eigen::Matrix<double, element_dofs, element_dofs, Eigen::RowMajor>> stiffness(
      &matrix(0, 0));
  // flux, row b and column 3q + J: ∂P_iJ/∂u_kb at Gauss point q, times the weight. Only the blocks
  // of rows i and columns k ≥ i are computed, and of i = k only the lower half.
  Eigen::Matrix<double, element_nodes, 3 * element_points> flux;
  Block block;
  for (Eigen::Index i = 0; i < 3; ++i) {
    const auto first_row = element_nodes * i;
    for (Eigen::Index k = i; k < 3; ++k) {
      const auto first_column = element_nodes * k;
      for (Eigen::Index q = 0; q < element_points; ++q)
        flux.middleCols<3>(3 * q).noalias() =
            gradients.middleCols<3>(3 * q) *
            tangents[static_cast<std::size_t>(q)].block<3, 3>(3 * i, 3 * k).transpose();
      block.noalias() = equation.gradient.middleCols<element_nodes>(first_row).transpose() *
                        pressure.middleCols<element_nodes>(first_column);
      if (i == k) {
        block.triangularView<Eigen::Lower>() += gradients * flux.transpose();
        block.triangularView<Eigen::StrictlyUpper>() = block.transpose();
      } else {
        block.noalias() += gradients * flux.transpose();
        stiffness.block<element_nodes, element_nodes>(first_column, first_row) = block.transpose();
      }
      stiffness.block<element_nodes, element_nodes>(first_row, first_column) = block;
    }
  }
}

Eigen::Matrix<double, element_nodes, 3> element_forces(const SolidElement& element,
                                                       const SolidState& state, std::size_t index) {
  const GaussPoints points = element.gauss_points();
  const auto F_all = deformation_gradients(element, points, state.displacement);
  Eigen::Matrix<double, 3 * element_points, 3> fluxes;
  for (Eigen::Index q = 0; q < element_points; ++q) {
    const Matrix3 F = F_all.middleCols<3>(3 * q);
    if (!(F.determinant() > 0)) throw SolverError("det F of the solid is not positive");
    const double p = points.pressure_values.col(q).dot(state.pressure[index]);
    fluxes.middleRows<3>(3 * q) =
        points.weights[q] * first_piola_stress(element.material, F, p).transpose();
  }
  return unit_gradients().lazyProduct(to_unit_cell(points, fluxes));
}

std::optional<InternalForces> internal_forces(const SolidSpace& space, const SolidState& state) {
  support::check_interruption();
  const auto& elements = space.elements();
  InternalForces result{space.vector(), space.vector(),
                        std::vector<PressureEquation>(elements.size())};
  state.displacement.update_ghost_values();
  const std::size_t own = space.own_elements().size();
  bool admissible = true;
  using Iterator = std::vector<SolidElement>::const_iterator;
  const auto worker = [&](const Iterator& element, NoScratch&, ForceShare& share) {
    const auto index = static_cast<std::size_t>(element - elements.begin());
    force_share(*element, state, index, share, result.pressure[index]);
  };
  const auto copier = [&](const ForceShare& share) {
    admissible = admissible && share.admissible;
    if (share.index >= own) return;
    const auto& dofs = elements[share.index].dofs;
    for (std::size_t i = 0; i < element_dofs; ++i) {
      result.forces.local_element(dofs[i]) += share.forces[static_cast<Eigen::Index>(i)];
      result.condensed.local_element(dofs[i]) += share.condensed[static_cast<Eigen::Index>(i)];
    }
  };
  dealii::WorkStream::run(elements.begin(), elements.end(), worker, copier, NoScratch(),
                          ForceShare());
  result.forces.compress(dealii::VectorOperation::add);
  result.condensed.compress(dealii::VectorOperation::add);
  if (dealii::Utilities::MPI::min(admissible ? 1 : 0, space.communicator()) == 0 ||
      !std::isfinite(result.condensed.l2_norm()))
    return std::nullopt;
  return result;
}

void add_stiffness(const SolidSpace& space, const SolidState& state, const InternalForces& internal,
                   TangentMatrix& matrix, std::span<const std::size_t> cells) {
  support::check_interruption();
  const auto& elements = space.elements();
  std::vector<std::size_t> indices(cells.begin(), cells.end());
  if (indices.empty()) {
    indices.resize(elements.size());
    std::iota(indices.begin(), indices.end(), std::size_t{0});
  }
  using Iterator = std::vector<std::size_t>::const_iterator;
  const auto worker = [&](const Iterator& cell, NoScratch&, StiffnessShare& share) {
    const SolidElement& element = elements[*cell];
    element_stiffness(element, state, *cell, internal.pressure[*cell], share.matrix);
    share.index = *cell;
  };
  const auto copier = [&](const StiffnessShare& share) {
    matrix.add(share.matrix, elements[share.index].dofs);
  };
  dealii::WorkStream::run(indices.cbegin(), indices.cend(), worker, copier, NoScratch(),
                          StiffnessShare());
}

void advance(const SolidSpace& space, const InternalForces& internal, const Vector& increment,
             SolidState& state) {
  increment.update_ghost_values();
  const auto& elements = space.elements();
  for (std::size_t e = 0; e < elements.size(); ++e) {
    const ElementVector du =
        nodal_displacements(elements[e], increment).reshaped<Eigen::ColMajor>();
    const PressureEquation& equation = internal.pressure[e];
    state.pressure[e] +=
        equation.correction + elements[e].inverse_compliance * (equation.gradient * du);
  }
  state.displacement += increment;
  state.displacement.update_ghost_values();
}

double elastic_energy(const SolidSpace& space, const SolidState& state) {
  const auto& elements = space.elements();
  state.displacement.update_ghost_values();
  double energy = 0;
  for (std::size_t e = 0; e < space.own_elements().size(); ++e) {
    const GaussPoints points = elements[e].gauss_points();
    const auto F = deformation_gradients(elements[e], points, state.displacement);
    for (Eigen::Index q = 0; q < element_points; ++q)
      energy +=
          points.weights[q] * strain_energy(elements[e].material, F.middleCols<3>(3 * q),
                                            points.pressure_values.col(q).dot(state.pressure[e]));
  }
  return dealii::Utilities::MPI::sum(energy, space.communicator());
}

void project_pressure(const SolidSpace& space, SolidState& state) {
  state.displacement.update_ghost_values();
  const auto& elements = space.elements();
  for (std::size_t e = 0; e < elements.size(); ++e) {
    const GaussPoints points = elements[e].gauss_points();
    const auto F = deformation_gradients(elements[e], points, state.displacement);
    PressureVector moment = PressureVector::Zero();
    for (int q = 0; q < element_points; ++q)
      moment += points.weights[q] * points.pressure_values.col(q) *
                (F.middleCols<3>(Eigen::Index{3} * q).determinant() - 1);
    state.pressure[e] = elements[e].inverse_compliance * moment;
  }
}

}  // namespace ciliaval::fem::solid::discretisation
