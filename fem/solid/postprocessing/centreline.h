// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <optional>

#include "fem/solid/discretisation/space.h"
#include "fem/solid/loads/height_loads.h"
#include "problem/centreline.h"

namespace ciliaval::fem::solid::postprocessing {

/// Centreline of an extruded solid: one piece or more for each layer of cells, four Gauss–Lobatto
/// stations on each. At a station,
///
///   r = 1/A ∫ x dA,
///   Λ: d₁, d₂ = the two columns of B (BᵀB)^(−1/2), B = [∫ (x − r) X dA, ∫ (x − r) Y dA], d₃ = d₁ ×
///   d₂
///      (the rotation that fits the section best, orthogonal Procrustes),
///   κ = 2 vec(q′ q̄), q the quaternion of Λ, by its interpolation on the layer,
///   n, m = force and moment about r that the part above exerts on the part below.
///
/// At the upper plane of a layer n and m are the internal nodal forces of its own cells, less their
/// share of the spread load; below it the load between is added, integrated along Z. So n and m
/// balance the load to the solver's tolerance on every mesh, where stresses would not. r is the
/// element's own quadratic, exact and continuous from layer to layer. Where a contact kernel lies
/// in a layer, the layer is divided: one piece below it, pieces of at most half its height inside,
/// one above. A half body is completed by its image in y = 0. `load` is the load of the state; the
/// default is none, or a section load. Throws SolverError if det F ≤ 0 in the state.
Centreline centreline(const discretisation::SolidSpace& space,
                      const discretisation::ExtrudedQuadrature& quadrature,
                      const discretisation::SolidState& state, const loads::SpreadLoad& load = {});

/// r of the section Z = L.
Vector3 tip_position(const discretisation::SolidSpace& space,
                     const discretisation::ExtrudedQuadrature& quadrature,
                     const discretisation::SolidState& state);

/// A dead force on the plane Z = arclength of the whole body, spread evenly over it.
struct PlaneForce {
  double arclength = 0;             ///< m
  Vector3 force = Vector3::Zero();  ///< N
};

/// The same centreline from the displacement alone (another program's solution): n and m are by
/// statics the loads above the section, on the deformed body. `state.pressure` is not used.
Centreline centreline_by_statics(const discretisation::SolidSpace& space,
                                 const discretisation::ExtrudedQuadrature& quadrature,
                                 const discretisation::SolidState& state,
                                 const loads::SpreadLoad& load,
                                 const std::optional<PlaneForce>& plane = std::nullopt);

/// The rotation that fits the columns b₁, b₂ of a section best (see centreline()). Throws
/// SolverError if they are parallel or not finite.
Quaternion section_rotation(const Eigen::Matrix<double, 3, 2>& B);

}  // namespace ciliaval::fem::solid::postprocessing
