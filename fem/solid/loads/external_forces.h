// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <functional>

#include "fem/solid/discretisation/extruded_quadrature.h"
#include "fem/solid/discretisation/space.h"
#include "fem/solid/discretisation/tangent_matrix.h"
#include "fem/solid/loads/height_loads.h"
#include "problem/cilium.h"
#include "problem/load.h"

namespace ciliaval::fem::solid::loads {

/// External forces f(u): adds this rank's shares of them to `forces`, whose compress(add) is left
/// to the caller, and, where `tangent` is not null, −∂f/∂u to it.
using ExternalForces =
    std::function<void(const discretisation::Vector& displacement, discretisation::Vector& forces,
                       discretisation::TangentMatrix* tangent)>;

/// All ranks' forces together. Collective. Throws SolverError on all ranks where one of them does.
discretisation::Vector forces_at(const discretisation::Vector& displacement,
                                 const discretisation::SolidSpace& space,
                                 const ExternalForces& external);

/// A force f(u, F) with one more unknown, its amplitude F, and the condition g(u, F) = 0 that
/// determines it.
struct UnknownForce {
  std::function<ExternalForces(double amplitude)> forces;
  /// g; adds ∂g/∂u to `gradient` where that is not null.
  std::function<double(const discretisation::Vector& u, double amplitude,
                       discretisation::Vector* gradient)>
      condition;
  double amplitude = 0;     ///< F: the guess, and the result
  ExternalForces others{};  ///< what acts besides; empty: nothing
  /// ∂f/∂F; empty: f(u, 1), of a force that is linear in F.
  std::function<ExternalForces(double amplitude)> rate{};
  double condition_rate = 0;  ///< ∂g/∂F
};

/// The load as spread over the solid, of a section load the direction e alone, and the environment.
SpreadLoad spread_load(const Cilium& cilium, const Load& load, double area, double kernel_width);

/// The nodal forces of the load alone.
ExternalForces load_forces(const discretisation::SolidSpace& space,
                           const discretisation::ExtrudedQuadrature& quadrature, const Load& load,
                           double kernel_width);

/// The nodal forces of load and environment as a function of the displacement
/// (docs/theory/solid.md).
ExternalForces external_forces(const discretisation::SolidSpace& space,
                               const discretisation::ExtrudedQuadrature& quadrature,
                               const Cilium& cilium, const Load& load, double kernel_width);

/// A probe as the contact that it is, with its force, N; any other load as it is.
Load acting(const Load& load, double applied_force);

}  // namespace ciliaval::fem::solid::loads
