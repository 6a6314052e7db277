// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include "fem/solid/discretisation/space.h"
#include "fem/solid/loads/external_forces.h"
#include "fem/solid/loads/height_loads.h"
#include "problem/load.h"

namespace ciliaval::fem::solid::loads {

/// Mean displacement along e of the material at the height h, by the kernel of the contact force,
///
///   ū = N/D,   N = ∫ dA ∫ k(z − h) z_ζ (u·e) dζ,   D = ∫ dA ∫ k(z − h) z_ζ dζ,
///
/// m. Where the lines span the kernel, D is the section's area and ū the mean over the horizontal
/// section at z = h and over the kernel. It differs from the centreline's deflection there, which
/// the rods prescribe, by 0.065 w² κ/cos³θ along a line of curvature κ and slope θ
/// (docs/theory/solid.md). `kernel` is contact_density() of any force. Where `gradient` is not
/// null, ∂ū/∂u is added to it:
///
///   ∂N/∂u_b = ∫ dA ∫ {k z_ζ N_b e + [k′ z_ζ N_b + k ∂N_b/∂ζ] (u·e) e_z} dζ,   ∂D/∂u_b likewise.
///
/// Throws SolverError if nothing is inside the kernel.
double mean_displacement(const discretisation::SolidSpace& space,
                         const discretisation::ExtrudedQuadrature& quadrature,
                         const HeightDensity& kernel, const Vector3& direction,
                         const discretisation::Vector& displacement,
                         discretisation::Vector* gradient);

/// A probe as a force of unknown amplitude: the contact force, with ū = δ for its condition. The
/// space and the quadrature must outlive it. `force` is the initial guess, N.
UnknownForce probe_force(const discretisation::SolidSpace& space,
                         const discretisation::ExtrudedQuadrature& quadrature,
                         const ProbeLoad& load, double kernel_width, double force);

}  // namespace ciliaval::fem::solid::loads
