// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <deal.II/lac/vector.h>

#include "fem/solid/fibres.h"
#include "fem/solid/equilibrium/newton.h"
#include "fem/solid/discretisation/space.h"
#include "problem/load.h"

namespace ciliaval::fem {

/// Mean displacement along e of what is at the height h, by the kernel of the contact force,
///
///   ū = N/D,   N = ∫ dA ∫ k(z − h) z_ζ (u·e) dζ,   D = ∫ dA ∫ k(z − h) z_ζ dζ,
///
/// m. On fibres that span the kernel ∫ k dz = 1, so that D is the section's area and ū the mean
/// over the horizontal section at z = h and over the kernel. It differs from the centreline's
/// deflection there, which the rods prescribe, by the second order of the kernel's width and the
/// radius in the curvature: 0.065 w² κ/cos³θ along a fibre of curvature κ and slope θ
/// (docs/solid.md). `kernel` is contact_density() of any force. Where `gradient` is not null, ∂ū/∂u
/// is added to it:
///
///   ∂N/∂u_b = ∫ dA ∫ {k z_ζ N_b e + [k′ z_ζ N_b + k ∂N_b/∂ζ] (u·e) e_z} dζ,   ∂D/∂u_b likewise.
///
/// Throws SolverError if nothing is inside the kernel.
double mean_displacement(const SolidSpace& space, const Fibres& fibres, const HeightDensity& kernel,
                         const Vector3& direction, const dealii::Vector<double>& displacement,
                         dealii::Vector<double>* gradient);

/// A probe as a force of unknown amplitude: the contact force, with ū = δ for its condition. The
/// space and the fibres must outlive it. `force` is the first guess, N.
UnknownForce probe_force(const SolidSpace& space, const Fibres& fibres, const ProbeLoad& load,
                         double kernel_width, double force);

}  // namespace ciliaval::fem
