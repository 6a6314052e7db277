// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include "fem/solid/discretisation/extruded_quadrature.h"
#include "fem/solid/discretisation/space.h"
#include "problem/centreline.h"
#include "problem/cilium.h"

namespace ciliaval::fem::solid::equilibrium {

/// Initial guesses of Newton's method for a state of the extruded solid.

/// The state of one mesh as a state of another of the same cilium: displacements interpolated at
/// the nodes, pressures projected in each element. Where the sections differ at the mantle, the
/// coarse cells' polynomials are continued. Both meshes are in parts, or the first is whole.
/// Collective. Throws InputError if a node lies outside `from`'s
/// layers or far outside its section.
discretisation::SolidState interpolated(const discretisation::SolidSpace& from,
                                        const discretisation::ExtrudedQuadrature& quadrature,
                                        const discretisation::SolidState& state,
                                        const discretisation::SolidSpace& to);

/// A rod's state as a state of the solid. Sections stay plane but contract as in the bending of a
/// bar (Love, Mathematical Theory of Elasticity, art. 88): with κ_a, a = 1, 2, the material
/// curvatures about d_a and ε = κ₁Y − κ₂X + |r′| − 1 the axial strain,
///
///   x = r + (X + a₁) d₁ + (Y + a₂) d₂,
///   a₁ = ν [κ₂ (X² − Y²)/2 − κ₁ XY],   a₂ = ν [κ₂ XY + κ₁ (X² − Y²)/2]   (less ν (|r′| − 1) (X,
///   Y)), p = E ε/3,
///
/// as uniaxial stress along the axis deforms a section. The contraction fades out
/// within half a radius of the clamped base. The base itself stays where it is.
discretisation::SolidState rod_guess(const Centreline& rod, const Cilium& cilium,
                                     const discretisation::SolidSpace& to);

}  // namespace ciliaval::fem::solid::equilibrium
