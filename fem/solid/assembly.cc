// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/assembly.h"

#include <deal.II/base/work_stream.h>
#include <deal.II/lac/full_matrix.h>

#include <Eigen/LU>
#include <cmath>

#include "problem/error.h"

namespace ciliaval::fem {
namespace {

using ElementVector = Eigen::Matrix<double, element_dofs, 1>;

/// One element's share, as it goes from the parallel worker to the serial copier.
struct ForceShare {
  std::size_t index = 0;
  bool admissible = true;
  ElementVector forces = ElementVector::Zero();
  ElementVector condensed = ElementVector::Zero();
  PressureEquation pressure;
};

struct StiffnessShare {
  std::size_t index = 0;
  dealii::FullMatrix<double> matrix = dealii::FullMatrix<double>(element_dofs, element_dofs);
};

struct NoScratch {};

/// F = 1 + Σ u_a ⊗ ∂N_a/∂X at Gauss point q.
Matrix3 deformation_gradient(const SolidElement& element,
                             const Eigen::Matrix<double, element_nodes, 3>& u, int q) {
  return Matrix3::Identity() + u.transpose() * element.gradients.middleCols<3>(Eigen::Index{3} * q);
}

double pressure_at(const SolidElement& element, const PressureVector& pressure, int q) {
  return element.pressure_values.col(q).dot(pressure);
}

ForceShare force_share(const SolidElement& element, const SolidState& state, std::size_t index) {
  ForceShare share;
  share.index = index;
  const auto u = nodal_displacements(element, state.displacement);
  const PressureVector& pressure = state.pressure[index];
  PressureVector residual = PressureVector::Zero();
  share.pressure.gradient.setZero();
  for (int q = 0; q < element_points; ++q) {
    const auto gradients = element.gradients.middleCols<3>(Eigen::Index{3} * q);
    const Matrix3 F = deformation_gradient(element, u, q);
    const double J = F.determinant();
    if (!(J > 0)) {
      share.admissible = false;
      return share;
    }
    const double weight = element.weights[q];
    const double p = pressure_at(element, pressure, q);
    const Matrix3 P = weight * first_piola_stress(element.material, F, p);
    const Matrix3 cofactor = weight * J * F.inverse().transpose();
    const auto psi = element.pressure_values.col(q);
    residual += weight * psi * (J - 1 - p / element.material.bulk_modulus);
    for (int c = 0; c < 3; ++c) {
      const auto first = Eigen::Index{c} * element_nodes;
      share.forces.segment<element_nodes>(first) += gradients * P.row(c).transpose();
      share.pressure.gradient.middleCols<element_nodes>(first) +=
          psi * (gradients * cofactor.row(c).transpose()).transpose();
    }
  }
  share.pressure.correction = element.inverse_compliance * residual;
  share.condensed = share.forces + share.pressure.gradient.transpose() * share.pressure.correction;
  return share;
}

void element_stiffness(const SolidElement& element, const SolidState& state, std::size_t index,
                       const PressureEquation& equation, dealii::FullMatrix<double>& matrix) {
  const auto u = nodal_displacements(element, state.displacement);
  // flux[i], row 3q + J: ∂P_iJ/∂u at Gauss point q, times the weight.
  std::array<Eigen::MatrixXd, 3> flux;
  flux.fill(Eigen::MatrixXd::Zero(3 * element_points, element_dofs));
  for (int q = 0; q < element_points; ++q) {
    const Matrix3 F = deformation_gradient(element, u, q);
    const double p = pressure_at(element, state.pressure[index], q);
    const StressTangent A = element.weights[q] * stress_tangent(element.material, F, p);
    const auto gradients = element.gradients.middleCols<3>(Eigen::Index{3} * q);
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k)
        flux[static_cast<std::size_t>(i)].block<3, element_nodes>(Eigen::Index{3} * q,
                                                                  Eigen::Index{k} * element_nodes) =
            A.block<3, 3>(Eigen::Index{3} * i, Eigen::Index{3} * k) * gradients.transpose();
  }
  Eigen::Map<Eigen::Matrix<double, element_dofs, element_dofs, Eigen::RowMajor>> stiffness(
      &matrix(0, 0));
  for (int i = 0; i < 3; ++i)
    stiffness.middleRows<element_nodes>(Eigen::Index{i} * element_nodes).noalias() =
        element.gradients * flux[static_cast<std::size_t>(i)];
  const Eigen::MatrixXd gradient = equation.gradient;
  const Eigen::MatrixXd pressure = element.inverse_compliance * gradient;
  stiffness.noalias() += gradient.transpose() * pressure;
}

}  // namespace

Eigen::Matrix<double, element_nodes, 3> element_forces(const SolidElement& element,
                                                       const SolidState& state, std::size_t index) {
  const ForceShare share = force_share(element, state, index);
  if (!share.admissible) throw SolverError("det F of the solid is not positive");
  return share.forces.reshaped<Eigen::ColMajor>(element_nodes, 3);
}

std::optional<InternalForces> internal_forces(const SolidSpace& space, const SolidState& state) {
  const auto& elements = space.elements();
  InternalForces result{dealii::Vector<double>(space.unknowns()),
                        dealii::Vector<double>(space.unknowns()),
                        std::vector<PressureEquation>(elements.size())};
  bool admissible = true;
  using Iterator = std::vector<SolidElement>::const_iterator;
  const auto worker = [&](const Iterator& element, NoScratch&, ForceShare& share) {
    share = force_share(*element, state, static_cast<std::size_t>(element - elements.begin()));
  };
  const auto copier = [&](const ForceShare& share) {
    admissible = admissible && share.admissible;
    const auto& dofs = elements[share.index].dofs;
    for (std::size_t i = 0; i < element_dofs; ++i) {
      result.forces[dofs[i]] += share.forces[static_cast<Eigen::Index>(i)];
      result.condensed[dofs[i]] += share.condensed[static_cast<Eigen::Index>(i)];
    }
    result.pressure[share.index] = share.pressure;
  };
  dealii::WorkStream::run(elements.begin(), elements.end(), worker, copier, NoScratch(),
                          ForceShare());
  if (!admissible || !std::isfinite(result.condensed.l2_norm())) return std::nullopt;
  return result;
}

void add_stiffness(const SolidSpace& space, const SolidState& state, const InternalForces& internal,
                   const dealii::AffineConstraints<double>& constraints,
                   dealii::SparseMatrix<double>& matrix) {
  const auto& elements = space.elements();
  using Iterator = std::vector<SolidElement>::const_iterator;
  const auto worker = [&](const Iterator& element, NoScratch&, StiffnessShare& share) {
    share.index = static_cast<std::size_t>(element - elements.begin());
    element_stiffness(*element, state, share.index, internal.pressure[share.index], share.matrix);
  };
  const auto copier = [&](const StiffnessShare& share) {
    const auto& dofs = elements[share.index].dofs;
    constraints.distribute_local_to_global(
        share.matrix, std::vector<dealii::types::global_dof_index>(dofs.begin(), dofs.end()),
        matrix);
  };
  dealii::WorkStream::run(elements.begin(), elements.end(), worker, copier, NoScratch(),
                          StiffnessShare());
}

void advance(const SolidSpace& space, const InternalForces& internal,
             const dealii::Vector<double>& increment, SolidState& state) {
  const auto& elements = space.elements();
  for (std::size_t e = 0; e < elements.size(); ++e) {
    const ElementVector du =
        nodal_displacements(elements[e], increment).reshaped<Eigen::ColMajor>();
    const PressureEquation& equation = internal.pressure[e];
    state.pressure[e] +=
        equation.correction + elements[e].inverse_compliance * (equation.gradient * du);
  }
  state.displacement += increment;
}

void project_pressure(const SolidSpace& space, SolidState& state) {
  const auto& elements = space.elements();
  for (std::size_t e = 0; e < elements.size(); ++e) {
    const auto u = nodal_displacements(elements[e], state.displacement);
    PressureVector moment = PressureVector::Zero();
    for (int q = 0; q < element_points; ++q)
      moment += elements[e].weights[q] * elements[e].pressure_values.col(q) *
                (deformation_gradient(elements[e], u, q).determinant() - 1);
    state.pressure[e] = elements[e].inverse_compliance * moment;
  }
}

}  // namespace ciliaval::fem
