// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <vector>

/// The end problem of a rod: the linear elasticity of a stack of bonded round bars, and how much
/// stiffer it is than the rods' theory says. docs/theory/joints.md.
namespace ciliaval::tools::end_problem {

/// A bar of the stack, from below upwards; the diameter is 1.
struct Bar {
  double length = 1;         ///< in diameters
  double young_modulus = 1;  ///< in any unit
  double poisson_ratio = 0;
};

/// Compliance beyond that of Saint-Venant's solution in each bar, in units of 1/E and the diameter:
/// a quadratic form in the moment M and the shear force Q at a height z, and in the axial force N.
/// The bars' own compliance is that of a Timoshenko beam with the shear coefficient of the energy
/// (problem/joints/shear_coefficient.h): with Cowper's the end faces' moments would appear beside
/// it.
struct Excess {
  double rotation = 0;      ///< of M by M
  double coupling = 0;      ///< of M by Q
  double displacement = 0;  ///< of Q by Q
  double extension = 0;     ///< of N by N
};

/// Finite elements that resolve the problem: rectangles in the meridional plane, smaller by a
/// factor towards the surface and both sides of each interface.
struct Resolution {
  unsigned int degree = 3;  ///< of the displacements; the pressure's is one less, discontinuous
  unsigned int layers = 4;  ///< sizes towards an edge
  double ratio = 0.25;      ///< of neighbouring sizes
};

enum class Base {
  clamped,  ///< all displacements of the lowest face are zero
  free      ///< it carries Saint-Venant's tractions, as the top does
};

/// The excess of a stack under Saint-Venant's tractions on its top, M and Q referred to the height
/// z (in diameters from the base). The ends should be about two diameters from the interfaces.
/// Displacements are Fourier series in the azimuth, of which extension needs the term 0 and bending
/// the term 1; each is a mixed problem (displacement, pressure) in the meridional plane.
/// Throws InputError if a length, modulus or ratio is out of range.
Excess excess(const std::vector<Bar>& bars, Base base, double z, const Resolution& resolution = {});

}  // namespace ciliaval::tools::end_problem
