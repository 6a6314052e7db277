// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <deal.II/lac/full_matrix.h>

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "fem/solid/discretisation/space.h"
#include "fem/solid/discretisation/tangent_matrix.h"

namespace ciliaval::fem::solid::discretisation {

/// The pressure equation of one element at a state: with R_p = ∫ ψ (J − 1 − p/K) dV,
/// G = ∂R_p/∂u = ∫ ψ ⊗ (J F⁻ᵀ : ∇N) dV and C = ∫ ψψᵀ/K dV, a Newton step Δu of the displacement
/// belongs to Δp = C⁻¹ (R_p + G Δu).
struct PressureEquation {
  Eigen::Matrix<double, element_pressures, element_dofs> gradient =
      Eigen::Matrix<double, element_pressures, element_dofs>::Zero();  ///< G
  PressureVector correction = PressureVector::Zero();                  ///< C⁻¹ R_p, Pa
};

/// Internal forces of a state. The rows of constrained degrees of freedom hold the reactions.
struct InternalForces {
  Vector forces;     ///< ∫ P : ∇N dV, N
  Vector condensed;  ///< forces + Gᵀ C⁻¹ R_p: with p eliminated, N
  std::vector<PressureEquation> pressure;
};

/// The element's share ∫ P : ∇N_a dV in the internal forces of node a: row a, N.
Eigen::Matrix<double, element_nodes, 3> element_forces(const SolidElement& element,
                                                       const SolidState& state, std::size_t index);

/// Internal forces of the state; empty if det F ≤ 0 or not a number at a Gauss point. Collective.
std::optional<InternalForces> internal_forces(const SolidSpace& space, const SolidState& state);

/// The element's condensed stiffness K_uu + Gᵀ C⁻¹ G, symmetric, N/m, in the order of
/// SolidElement::dofs. The matrix must be element_dofs × element_dofs; it is overwritten.
///   K_uu = ∫ ∇N : ∂P/∂F|_p : ∇N dV
void element_stiffness(const SolidElement& element, const SolidState& state, std::size_t index,
                       const PressureEquation& equation, dealii::FullMatrix<double>& matrix);

/// Adds element_stiffness() of the given cells (indices of space.elements()) to the matrix, of all
/// the rank's if none are given. As in internal_forces(), threads compute the cells and one adds
/// them in their order, so that the result does not depend on the number of threads.
void add_stiffness(const SolidSpace& space, const SolidState& state, const InternalForces& internal,
                   TangentMatrix& matrix, std::span<const std::size_t> cells = {});

/// u += Δu, p += C⁻¹ (R_p + G Δu), with the pressure equations of the state before. Collective.
void advance(const SolidSpace& space, const InternalForces& internal, const Vector& increment,
             SolidState& state);

/// ∫ Ψ(F, p) dV of the whole mesh, J, collective: where the pressure equation holds, the elastic
/// energy.
double elastic_energy(const SolidSpace& space, const SolidState& state);

/// Sets the pressure p = K π(J − 1) of a displacement, π the projection onto the element's linear
/// functions.
void project_pressure(const SolidSpace& space, SolidState& state);

}  // namespace ciliaval::fem::solid::discretisation
